#pragma once
/// How a surface lies in the image plane: its UVs, cut into charts at the seams.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// One UV triple a triangle.
struct UvLayout {
  Triangles triangles;                              ///< #T x 3, vertices of the surface
  std::vector<std::array<Eigen::Vector2d, 3>> uvs;  ///< #T, one a corner
  std::vector<char> has_uv;                         ///< #T
};

/// #T: the triangle across edge (k, k + 1) in the same chart; -1 at a seam, at a border and where a triangle has no UVs.
/// Cost: n log n in the edges.
std::vector<std::array<int, 3>> chart_neighbours(const UvLayout& layout);

}  // namespace mien
