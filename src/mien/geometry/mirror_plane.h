#pragma once
/// A plane, and what lies on its other side.

#include <Eigen/Core>

namespace mien {

/// Points x with normal . x = offset. The normal may have any length above 0; `side` is a distance for a unit one.
struct MirrorPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double offset = 0;
  double side(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
  Eigen::Vector3d mirrored(const Eigen::Vector3d& x) const {
    return x - 2 * side(x) / normal.squaredNorm() * normal;
  }
  Eigen::Vector3d mirrored_vector(const Eigen::Vector3d& d) const {
    return d - 2 * normal.dot(d) / normal.squaredNorm() * normal;
  }
};

}  // namespace mien
