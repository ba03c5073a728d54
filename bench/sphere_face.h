#pragma once
/// Procedural surfaces the size of real faces, for benchmarks that need no file.

#include <cmath>
#include <numbers>

#include "mien/geometry/mesh.h"

namespace mien::bench {

/// A sphere of radius about 0.1 with ridges, so that no triangle is like another: about `vertices` of them,
/// as a closed grid of triangles. `phase` turns the ridges: two phases are two faces of one size.
struct Surface {
  PointsD positions;
  Triangles triangles;
};
inline Surface sphere_face(int vertices, double phase) {
  const int rows = static_cast<int>(std::sqrt(vertices / 2.0)), columns = 2 * rows;
  Surface surface;
  surface.positions.resize(rows * columns, 3);
  surface.triangles.resize(2 * (rows - 1) * columns, 3);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double theta = std::numbers::pi * (r + 0.5) / rows, phi = 2 * std::numbers::pi * c / columns;
      const double radius = 0.1 * (1 + 0.05 * std::sin(5 * theta + phase) * std::cos(4 * phi - phase));
      surface.positions.row(r * columns + c) =
          radius * Eigen::RowVector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      std::sin(theta) * std::sin(phi));
    }
  for (int r = 0, t = 0; r + 1 < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int a = r * columns + c, b = r * columns + (c + 1) % columns;
      surface.triangles.row(t++) << a, b, a + columns;
      surface.triangles.row(t++) << b, b + columns, a + columns;
    }
  return surface;
}

}  // namespace mien::bench
