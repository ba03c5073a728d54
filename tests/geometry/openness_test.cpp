#include "mien/geometry/openness.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "mien/geometry/similarity.h"

namespace mien::test {
namespace {

/// The cube with its faces turned inside out: a closed room.
Surface room() {
  Surface s = cube();
  s.triangles.col(1).swap(s.triangles.col(2));
  return s;
}

/// A box of side 2 without its lid, seen from inside; vertex 8 is the middle of its floor.
Surface well(double depth) {
  Surface s;
  s.positions.resize(9, 3);
  s.positions << -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, -1, -1, depth, 1, -1, depth, 1, 1, depth, -1, 1,
      depth, 0, 0, 0;
  s.triangles.resize(12, 3);
  s.triangles << 0, 1, 8, 1, 2, 8, 2, 3, 8, 3, 0, 8, 0, 4, 5, 0, 5, 1, 1, 5, 6, 1, 6, 2, 2, 6, 7, 2, 7, 3, 3,
      7, 4, 3, 4, 0;
  return s;
}

TEST(openness, refuses_a_surface_without_triangles) {
  EXPECT_NE(failure_of([&] { openness(random_points(4, 1), Triangles(0, 3)); }), "");
}

TEST(openness, a_convex_surface_is_open_and_a_closed_room_is_not) {
  const Surface outside = cube(), inside = room();
  EXPECT_EQ(openness(outside.positions, outside.triangles), Eigen::VectorXd::Ones(8));
  EXPECT_EQ(openness(inside.positions, inside.triangles), Eigen::VectorXd::Zero(8));
  const Surface flat = grid(3);
  EXPECT_EQ(openness(flat.positions, flat.triangles), Eigen::VectorXd::Ones(16));
}

TEST(openness, of_a_wells_floor_is_its_view_factor) {
  // Hottel: from the middle of the floor, a square of half side 1 at height h (four corner terms of a rectangle).
  for (const double h : {0.5, 1.0, 2.0}) {
    const Surface s = well(h);
    const double a = 1 / h, root = std::sqrt(1 + a * a);
    const double seen = 4 / (2 * std::numbers::pi) * (2 * a / root * std::atan(a / root));
    EXPECT_NEAR(openness(s.positions, s.triangles, 4096)[8], seen, 0.01) << h;
    EXPECT_NEAR(openness(s.positions, s.triangles)[8], seen, 0.06) << h;
  }
}

TEST(openness, does_not_change_under_a_similarity) {
  const Surface s = well(1.3);
  const Similarity turn{
      60, Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {5, -7, 100}};
  const Eigen::VectorXd before = openness(s.positions, s.triangles),
                        after = openness(turn(s.positions), s.triangles);
  EXPECT_LE((before - after).cwiseAbs().maxCoeff(), 4.0 / 64);  // the rays' turn about the normal differs
}

TEST(openness, a_vertex_without_triangles_gets_a_share_too) {
  Surface s = cube();
  s.positions.conservativeResize(9, 3);
  s.positions.row(8) << 0.5, 0.5, 0.5;
  const Eigen::VectorXd open = openness(s.positions, s.triangles);
  EXPECT_TRUE(open.allFinite());
  EXPECT_GE(open.minCoeff(), 0);
  EXPECT_LE(open.maxCoeff(), 1);
}

}  // namespace
}  // namespace mien::test
