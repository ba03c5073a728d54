#pragma once
/// Animation alone, from one rigged character to another that has the same rig (thesis 4.8).

#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct RetargetedClips {
  std::vector<Clip> clips;  ///< the source's, in the target's numbers and volume
  /// What the two rigs differ in (rig_differences), the source first.
  std::vector<std::string> differences;
  std::vector<std::string> dropped;  ///< one line a channel that moves what the target does not have
};

/// The source's clips on the target. Joints, shapes, sliders, wires and objects go by name; wires and objects also need as many
/// control points. Translations grow as the rigs' lengths do around the joint: the moving similarity through what both rigs have
/// at rest (joints, control points) and their landmarks of the same names. Frames may be turned differently: a joint turns about the
/// same direction of the face as on the source.
///   throws  invalid_input: a source without clips
///   cost    linear in the clips' values and joints x points
RetargetedClips retarget_clips(const Character& source, const Character& target);

}  // namespace mien
