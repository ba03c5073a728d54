#include "mien/geometry/laplacian.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "mien/geometry/openness.h"

namespace mien::test {
namespace {

TEST(cotangent_laplacian, is_symmetric_and_ignores_constants) {
  const Surface s = cube();
  const SparseMatrix laplacian = cotangent_laplacian(s.positions, s.triangles);
  EXPECT_TRUE(Eigen::MatrixXd(laplacian).isApprox(Eigen::MatrixXd(laplacian.transpose())));
  EXPECT_LT((laplacian * Eigen::VectorXd::Ones(8)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(cotangent_laplacian, gives_the_dirichlet_energy_of_a_slope) {
  const Surface s = grid(5);
  const SparseMatrix laplacian = cotangent_laplacian(s.positions, s.triangles, 0);
  const Eigen::VectorXd slope = s.positions * Eigen::Vector3d(2, 0, 0);
  EXPECT_NEAR(slope.dot(laplacian * slope), 4 * 25, 1e-9) << "|gradient|^2 times area";
}

TEST(cotangent_laplacian, degenerate_triangles_leave_it_finite) {
  PointsD positions = PointsD::Zero(4, 3);
  positions(1, 0) = 1;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 1, 1, 3;
  EXPECT_TRUE(Eigen::MatrixXd(cotangent_laplacian(positions, triangles)).allFinite());
}

TEST(vertex_areas, sum_to_the_area) {
  const Surface s = cube();
  EXPECT_NEAR(vertex_areas(s.positions, s.triangles).sum(), 6, 1e-12);
}

TEST(connected_components, are_numbered_by_their_lowest_vertex) {
  Triangles triangles(2, 3);
  triangles << 5, 1, 4, 0, 3, 6;
  EXPECT_EQ(connected_components(7, triangles), (std::vector<int>{0, 1, 2, 0, 1, 1, 0}));
}

TEST(boundary_vertices, of_open_and_closed_surfaces) {
  const Surface closed = cube(), open = grid(2);
  for (const char border : boundary_vertices(8, closed.triangles)) EXPECT_FALSE(border);
  const std::vector<char> border = boundary_vertices(9, open.triangles);
  for (int v = 0; v < 9; ++v) EXPECT_EQ(border[v], v != 4) << v;
}

TEST(openness, is_one_on_convex_surfaces_and_small_in_a_box) {
  const Surface s = cube();
  EXPECT_EQ(openness(s.positions, s.triangles).minCoeff(), 1);
  Triangles inward = s.triangles;
  inward.col(0).swap(inward.col(1));
  EXPECT_EQ(openness(s.positions, inward).maxCoeff(), 0) << "the inside of a closed box sees no air";
}

}  // namespace
}  // namespace mien::test
