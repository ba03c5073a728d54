#include "mien/transfer/propagate.h"

#include "mien/core/error.h"

namespace mien {
namespace {

/// A skin ignores the node of its part: a target without one cannot get one while nodes place its parts.
void check_placement(const Character& source_after, const Character& target) {
  if (source_after.skins.empty() || !target.skins.empty()) return;
  const auto model = model_matrices(target);
  for (const Part& part : target.parts)
    if (part.node >= 0 && !model[static_cast<std::size_t>(part.node)].isIdentity(0))
      throw invalid_input("target",
                          "its part " + part.name + " is placed by a node and the source has joints now",
                          "transfer the changed source to the bare target");
}

}  // namespace

PropagateResult propagate(const Character& source_before, const Character& source_after,
                          const Character& target, const TransferOptions& options) {
  check_placement(source_after, target);
  const auto transferred = [&](const Character& source) {
    return transfer(source, without_rig(target, !source.skins.empty()), options);
  };
  const Character before = transferred(source_before).character;
  TransferResult after = transferred(source_after);
  MergeOptions merging;
  merging.unit = after.report.unit;
  MergedRig merged = merge_rigs(before, after.character, target, merging);
  return {std::move(merged.character), std::move(merged.report), std::move(after.report.warnings)};
}

}  // namespace mien
