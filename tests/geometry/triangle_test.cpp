#include "mien/geometry/triangle.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;

TEST(closest_point_on_triangle, inside_edge_and_corner) {
  const Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const TrianglePoint inside = closest_point_on_triangle({0.25, 0.5, 3}, a, b, c);
  EXPECT_EQ(inside.position, Vector3d(0.25, 0.5, 0));
  EXPECT_EQ(inside.barycentric, Vector3d(0.25, 0.25, 0.5));
  const TrianglePoint edge = closest_point_on_triangle({1, 1, -2}, a, b, c);
  EXPECT_TRUE(edge.position.isApprox(Vector3d(0.5, 0.5, 0)));
  const TrianglePoint corner = closest_point_on_triangle({5, -1, 0}, a, b, c);
  EXPECT_EQ(corner.position, b);
  EXPECT_EQ(corner.barycentric, Vector3d(0, 1, 0));
}

TEST(closest_point_on_triangle, degenerate_triangles_are_edges_and_points) {
  const Vector3d a(0, 0, 0), b(2, 0, 0), middle(1, 0, 0);
  EXPECT_EQ(closest_point_on_triangle({1.5, 1, 0}, a, b, middle).position, Vector3d(1.5, 0, 0));
  EXPECT_EQ(closest_point_on_triangle({1.5, 1, 0}, b, b, b).position, b);
}

TEST(closest_point_on_triangle, no_sample_of_the_triangle_is_closer) {
  const PointsD corners = random_points(60, 1), points = random_points(20, 2);
  for (int i = 0; i < 20; ++i) {
    const Vector3d a = corners.row(3 * i), b = corners.row(3 * i + 1), c = corners.row(3 * i + 2);
    const Vector3d p = 2 * points.row(i);
    const TrianglePoint found = closest_point_on_triangle(p, a, b, c);
    EXPECT_NEAR(found.barycentric.sum(), 1, 1e-12);
    EXPECT_GE(found.barycentric.minCoeff(), -1e-15);
    EXPECT_TRUE(found.position.isApprox(found.barycentric[0] * a + found.barycentric[1] * b +
                                        found.barycentric[2] * c));
    for (int u = 0; u <= 20; ++u)
      for (int v = 0; u + v <= 20; ++v) {
        const Vector3d sample = a + u / 20.0 * (b - a) + v / 20.0 * (c - a);
        EXPECT_LE((found.position - p).norm(), (sample - p).norm() + 1e-12);
      }
  }
}

TEST(barycentric_on_plane, weights_give_the_foot_back) {
  const Vector3d a(0, 0, 1), b(2, 0, 1), c(0, 2, 1);
  EXPECT_TRUE(barycentric_on_plane({3, -1, 7}, a, b, c).isApprox(Vector3d(0, 1.5, -0.5)));
  EXPECT_EQ(barycentric_on_plane({3, -1, 7}, a, a, c), Vector3d(1, 0, 0));
}

}  // namespace
}  // namespace mien::test
