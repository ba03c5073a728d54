#pragma once
/// Mirrored dragging: what one side is told, the other side is told too.

#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"

namespace mien {

struct MirrorPlane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitX();  ///< model space
};

/// The plane across the middle of the face's box, upright: x is left and right.
MirrorPlane middle_plane(const Character& character);

/// `pins`, then for each its mirror image: the surface point of the neutral (parts as in rest) closest to its place's mirror
/// image, the goal and axes mirrored. A pin on the plane, and one on a joint, has none.
///   throws  invalid_input: a normal that is zero, a pin off the surface
std::vector<Pin> mirror_pins(const Character& character, const std::vector<Pin>& pins,
                             const MirrorPlane& plane);

/// A point, or a direction, on the other side.
Eigen::Vector3d mirrored_point(const MirrorPlane& plane, const Eigen::Vector3d& point);
Eigen::Vector3d mirrored_direction(const MirrorPlane& plane, const Eigen::Vector3d& direction);

}  // namespace mien
