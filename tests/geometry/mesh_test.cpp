#include "mien/geometry/mesh.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace mien::test {
namespace {

TEST(triangulate, n_gons_become_fans_from_their_first_corner) {
  Faces faces;
  faces.push_back({4, 5, 6});
  faces.push_back({0, 1, 2, 3});
  faces.push_back({7, 8});
  faces.push_back({0, 1, 2, 3, 4});
  Triangles expected(6, 3);
  expected << 4, 5, 6, 0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3, 0, 3, 4;
  EXPECT_EQ(triangulate(faces), expected);
  EXPECT_EQ(face_of_triangle(faces), (std::vector<int>{0, 1, 1, 3, 3, 3}));
  EXPECT_EQ(faces.corner_count(), 14u);
}

TEST(triangulate, no_faces_give_no_triangles) {
  EXPECT_EQ(triangulate(Faces{}).rows(), 0);
  EXPECT_TRUE(face_of_triangle(Faces{}).empty());
}

TEST(vertex_normals, of_a_flat_grid_point_up) {
  const Surface flat = grid(3);
  const PointsD normals = vertex_normals(flat.positions, flat.triangles);
  for (Eigen::Index v = 0; v < normals.rows(); ++v) EXPECT_EQ(normals.row(v), Eigen::RowVector3d(0, 0, 1));
  EXPECT_EQ(vertex_normals(Points(flat.positions.cast<float>()), flat.triangles), normals.cast<float>());
}

TEST(vertex_normals, vertices_without_area_have_none) {
  Points positions = Points::Zero(4, 3);
  positions(1, 0) = 1;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  EXPECT_TRUE(vertex_normals(positions, triangles).isZero(0));
}

TEST(bounding_box, of_points_and_of_none) {
  Points positions(2, 3);
  positions << 1, 5, -2, 3, 1, -2;
  const Box box = bounding_box(positions);
  EXPECT_EQ(box.low, Eigen::Vector3d(1, 1, -2));
  EXPECT_EQ(box.high, Eigen::Vector3d(3, 5, -2));
  EXPECT_EQ(box.centre(), Eigen::Vector3d(2, 3, -2));
  EXPECT_EQ(bounding_box(Points(0, 3)).diagonal(), 0);
}

}  // namespace
}  // namespace mien::test
