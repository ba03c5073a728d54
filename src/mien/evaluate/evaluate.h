#pragma once
/// Pose in, surface out: shapes, wires and influence objects, then skinning.

#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// Where every part's vertices are in `pose`, in model space, in file order.
///   returns  one #V x 3 a part
///   throws   invalid_input: sizes of the pose that differ from the character's, numbers in it that are not
///   finite, a part
///            that names a skin, joint or node out of range
///   cost     linear in moved vertices x active shapes, plus #V x influences
/// Neutral + sum of shape weight x delta + what wires and influence objects add (influence.h), then skinned by `joint matrix x inverse
/// bind` as the part's skin says; a part without a skin is carried by its node.
std::vector<Points> evaluate(const Character& character, const Pose& pose);

/// The character's pose at `seconds` of `clip`; what the clip does not animate is at rest. Times outside the
/// clip hold the first or last key. STEP, LINEAR (rotations by slerp) and CUBICSPLINE as glTF 2.0 defines
/// them. Slider channels give shape weights through sliders and correctives; a channel of a shape weight comes
/// in their place, and one for one part alone goes to Pose::part_shape_weights.
///   throws   invalid_input: a channel without keys, with too few or too many values, or for a node, shape or
///            slider out of range; `seconds` that is not finite
Pose sample_clip(const Character& character, const Clip& clip, double seconds);

/// The same as an animator sets it: the sliders' values and the local transforms. A channel of a shape weight
/// sets the slider that has this shape as its only stop; other such channels have no slider to set and are
/// left out.
///   throws   as sample_clip
RigPose sample_rig(const Character& character, const Clip& clip, double seconds);

}  // namespace mien
