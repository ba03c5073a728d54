#pragma once
/// A changed source's rig on a target that was worked on since it got it (thesis 4.4).

#include "mien/transfer/merge_rigs.h"
#include "mien/transfer/transfer.h"

namespace mien {

struct PropagateResult {
  Character character;  ///< the target with the changed source's rig and its own changes
  MergeReport report;
  std::vector<TransferWarning> warnings;  ///< of the transfer of the changed source
};

/// Transfers both sources to the bare target and merges three ways (merge_rigs.h): what `target` is beyond the transfer of
/// `source_before` was made by hand and stays on top of the transfer of `source_after`. A target that nobody changed becomes the
/// transfer of `source_after`; with a source that nobody changed the target stays as it is.
///   source_before, source_after  landmarks inside
///   target   rigged from `source_before`, landmarks inside
///   throws   as transfer; invalid_input: a source that has joints now where the target's parts are placed by nodes
///   cost     two transfers
PropagateResult propagate(const Character& source_before, const Character& source_after,
                          const Character& target, const TransferOptions& options = {});

}  // namespace mien
