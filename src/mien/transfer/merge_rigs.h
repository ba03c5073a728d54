#pragma once
/// A rig that came from a source, was worked on, and whose source changed: three versions into one (thesis 4.4, changes of the source
/// rig go to all targets).

#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct MergeOptions {
  /// Positions and displacements that differ by less, of the face's size, are the same: what a compressed file loses.
  double tolerance = 3e-5;
  double unit = 1;  ///< the face's size
};

/// What became of the work on the target. Lines such as "shape smile".
struct MergeReport {
  std::vector<std::string> kept;       ///< changed on the target alone
  std::vector<std::string> updated;    ///< changed in the source alone, or new there
  std::vector<std::string> removed;    ///< gone from the source, or from the target by hand
  std::vector<std::string> conflicts;  ///< changed on both sides, with what was done about it
};

struct MergedRig {
  Character character;
  MergeReport report;
};

/// Three-way merge, element by element and by name: where `edited` is what `before` was, `after` counts; where `after` is
/// what `before` was, `edited`. Both changed: displacements, joints' places, control points and painted skin weights add what was done to
/// `before` to `after`; a slider's range, rest and stops are looked at one by one; of everything else `edited` counts. Meshes, UVs,
/// materials and landmarks are those of `edited`.
///   before, after  the same target with the source's rig before and after it changed
///   edited         the target as it is now; parts as in the other two
///   throws         invalid_input: parts that differ in number or vertices
///   cost           linear
MergedRig merge_rigs(const Character& before, const Character& after, const Character& edited,
                     const MergeOptions& options);

/// The target without its rig, as `transfer` starts from it.
///   skinned  it is to get joints
Character without_rig(const Character& target, bool skinned);

}  // namespace mien
