#pragma once
/// Small surfaces and point sets whose answers are known, for the tests of geometry.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "mien/core/error.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/mesh.h"

namespace mien::test {

struct Surface {
  PointsD positions;
  Triangles triangles;
};

/// The unit cube from (0, 0, 0) to (1, 1, 1), 12 triangles, normals outward.
inline Surface cube() {
  Surface s;
  s.positions.resize(8, 3);
  for (int v = 0; v < 8; ++v) s.positions.row(v) << (v & 1), (v >> 1 & 1), (v >> 2 & 1);
  s.triangles.resize(12, 3);
  s.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1,
      3, 5, 3, 7, 5;
  return s;
}

/// A flat n x n grid of unit squares in the plane z = 0, normals +z.
inline Surface grid(int n) {
  Surface s;
  s.positions.resize((n + 1) * (n + 1), 3);
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) s.positions.row(y * (n + 1) + x) << x, y, 0;
  s.triangles.resize(2 * n * n, 3);
  for (int y = 0, t = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x, b = a + n + 1;
      s.triangles.row(t++) << a, a + 1, b;
      s.triangles.row(t++) << a + 1, b + 1, b;
    }
  return s;
}

/// `count` points in the cube of side 2 around the origin, the same on every run.
inline PointsD random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  PointsD points(count, 3);
  // By hand: the standard distributions differ between libraries.
  for (Eigen::Index i = 0; i < points.size(); ++i)
    points.data()[i] = static_cast<double>(random()) / 2147483648.0 - 1.0;
  return points;
}

/// The text that `call` fails with; a test failure when it does not.
template <typename Call>
std::string failure_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "did not fail";
  return "";
}

}  // namespace mien::test
