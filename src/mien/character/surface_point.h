#pragma once
/// A point on the surface of a part.

#include <Eigen/Core>
#include <array>

namespace mien {

/// A point that stays on a part's surface while the face moves: a convex combination of a face's corners, or
/// one vertex.
struct SurfacePoint {
  int part = 0;
  int face = -1;  ///< index into Mesh::faces, -1: `vertex` is used
  int vertex = -1;
  /// Weights of the face's first corners as its fan triangle `corners` has them; they sum to one.
  Eigen::Vector3d barycentric = Eigen::Vector3d(1, 0, 0);
  /// Which corners of the face the weights belong to (0, 1, 2 for a triangle).
  std::array<int, 3> corners{0, 1, 2};
};

}  // namespace mien
