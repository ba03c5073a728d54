#pragma once
/// Which point of a surface lies under each pixel of its UV layout.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mien/texture/pixels.h"

namespace mien {

/// A triangle in UVs, v up.
struct LayoutTriangle {
  std::array<Eigen::Vector2d, 3> uv;
};

/// Pixels, upper row first.
struct TexelGrid {
  int size = 0;
  std::vector<int> triangle;  ///< size^2: the lowest triangle that covers the pixel's middle, -1: none
  std::vector<Eigen::Vector3f> barycentric;  ///< size^2
  std::size_t covered = 0, overlapping = 0;
};

/// Charts that lie outside [0, 1] are moved by whole numbers, as repeating images have it.
///   cost  linear in covered pixels
TexelGrid rasterize(const std::vector<LayoutTriangle>& triangles, int size);

/// Lets the colours of covered pixels grow by `steps` pixels, each new one the mean of its known neighbours.
void grow_colors(Pixels& pixels, std::vector<char> known, int steps);

}  // namespace mien
