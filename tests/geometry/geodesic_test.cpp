#include "mien/geometry/geodesic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mien/core/error.h"

namespace mien {
namespace {

/// A unit square of n x n quads in the plane.
struct Grid {
  explicit Grid(int n) : positions((n + 1) * (n + 1), 3), triangles(2 * n * n, 3) {
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x)
        positions.row(y * (n + 1) + x) << static_cast<double>(x) / n, static_cast<double>(y) / n, 0;
    int t = 0;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int a = y * (n + 1) + x, b = a + 1, c = a + n + 2, d = a + n + 1;
        triangles.row(t++) << a, b, c;
        triangles.row(t++) << a, c, d;
      }
  }
  PointsD positions;
  Triangles triangles;
};

TEST(Geodesics, FromALineTheyAreExactAndCarryTheirPlace) {
  const int n = 20;
  const Grid grid(n);
  const Geodesics geodesics(grid.positions, grid.triangles);
  std::vector<GeodesicSeed> seeds;
  for (int y = 0; y <= n; ++y) seeds.push_back({y * (n + 1), 0, static_cast<double>(y) / n});
  const GeodesicField field = geodesics.distances(seeds);
  for (Eigen::Index v = 0; v < grid.positions.rows(); ++v) {
    EXPECT_NEAR(field.distance[v], grid.positions(v, 0), 1e-6);
    EXPECT_NEAR(field.place[v], grid.positions(v, 1), 1e-6);
  }
}

TEST(Geodesics, FromAPointTheyAreCloseAndStopAtTheLimit) {
  const int n = 40;
  const Grid grid(n);
  const Geodesics geodesics(grid.positions, grid.triangles);
  const std::vector<GeodesicSeed> seeds{{0, 0, 0}};
  const GeodesicField field = geodesics.distances(seeds, 0.8);
  for (Eigen::Index v = 1; v < grid.positions.rows(); ++v) {
    const double truth = grid.positions.row(v).norm();
    if (truth < 0.75) {
      EXPECT_NEAR(field.distance[v], truth, 0.06 * truth + 0.5 / n);
    }
    if (truth > 0.85) {
      EXPECT_EQ(field.distance[v], std::numeric_limits<double>::infinity());
    }
  }
}

TEST(Geodesics, PiecesAreInfinitelyFarApart) {
  PointsD positions(6, 3);
  positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.01, 1, 0, 0.01, 0, 1, 0.01;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 3, 4, 5;
  const Geodesics geodesics(positions, triangles);
  const std::vector<GeodesicSeed> seeds{{0, 0, 0}};
  EXPECT_TRUE(std::isinf(geodesics.distances(seeds).distance[3]));
  EXPECT_TRUE(geodesics.edge_path(0, 4).empty());
  EXPECT_EQ(geodesics.edge_path(1, 2).size(), 2u);
  EXPECT_THROW(geodesics.edge_path(0, 6), Error);
}

}  // namespace
}  // namespace mien
