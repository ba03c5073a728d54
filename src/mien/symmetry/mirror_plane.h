#pragma once
/// The plane that a face mirrors itself in.

#include <Eigen/Core>

#include "mien/character/character.h"

namespace mien {

/// Points x with normal . x = offset. The normal points to the character's own left.
struct MirrorPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double offset = 0;
  double side(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
  Eigen::Vector3d mirrored(const Eigen::Vector3d& x) const { return x - 2 * side(x) * normal; }
  Eigen::Vector3d mirrored_vector(const Eigen::Vector3d& d) const { return d - 2 * normal.dot(d) * normal; }
};

struct FoundPlane {
  MirrorPlane plane;
  /// Mean distance of the mirrored surface to the surface, over the box's diagonal: 0 for a perfect mirror image; a sculpted
  /// head has 0.001 to 0.01.
  double asymmetry = 0;
};

/// The mirror plane of all parts in model space at rest: the best of the planes across the box's axes and the axes of inertia, fitted by closest
/// points of the mirrored surface. Which side is left is told by names with sides (landmarks, shapes, joints); where there
/// are none, +x is left, as in glTF.
///   throws  invalid_input: no faces
///   cost    70 passes of closest points over at most 4,000 vertices
FoundPlane find_mirror_plane(const Character& character);

}  // namespace mien
