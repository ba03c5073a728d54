#include "mien/geometry/surface_query.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "mien/geometry/triangle.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;

constexpr double endless = std::numeric_limits<double>::infinity();

TEST(surface_query, invalid_input_is_named) {
  Surface s = cube();
  EXPECT_EQ(failure_of([&] { SurfaceQuery(s.positions, Triangles(0, 3)); }),
            "surface query: has no triangles; a mesh with faces");
  s.triangles(3, 1) = 8;
  EXPECT_EQ(failure_of([&] { SurfaceQuery(s.positions, s.triangles); }),
            "surface query: a triangle names a vertex out of range; vertices from 0 to 7");
  s = cube();
  s.positions(2, 2) = std::nan("");
  EXPECT_EQ(failure_of([&] { SurfaceQuery(s.positions, s.triangles); }),
            "surface query: a position is not finite");
}

TEST(surface_query, closest_point_of_a_cube) {
  const Surface s = cube();
  const SurfaceQuery query(s.positions, s.triangles);
  const auto face = query.closest({0.3, 0.6, 4});
  EXPECT_TRUE(face.position.isApprox(Vector3d(0.3, 0.6, 1)));
  EXPECT_DOUBLE_EQ(face.distance, 3);
  const auto corner = query.closest({2, 2, 2});
  EXPECT_EQ(corner.position, Vector3d(1, 1, 1));
  EXPECT_EQ(query.closest({0.5, 0.5, 1.5}, 0.4).triangle, -1) << "nothing within the limit";
}

TEST(surface_query, a_point_on_a_vertex_is_that_vertex) {
  const Surface s = cube();
  const SurfaceQuery query(s.positions, s.triangles);
  for (Eigen::Index v = 0; v < 8; ++v) {
    const auto hit = query.closest(s.positions.row(v));
    EXPECT_EQ(hit.distance, 0);
    EXPECT_EQ(hit.barycentric.maxCoeff(), 1);
  }
}

TEST(surface_query, ties_go_to_the_lowest_triangle) {
  Surface s = grid(4);
  const SurfaceQuery query(s.positions, s.triangles);
  for (Eigen::Index v = 0; v < s.positions.rows(); ++v) {
    int lowest = -1;
    for (Eigen::Index t = s.triangles.rows() - 1; t >= 0; --t)
      if ((s.triangles.row(t).array() == v).any()) lowest = static_cast<int>(t);
    EXPECT_EQ(query.closest(s.positions.row(v) + Eigen::RowVector3d(0, 0, 0.5)).triangle, lowest) << v;
  }
}

TEST(surface_query, agrees_with_asking_every_triangle) {
  const Surface s = cube();
  const SurfaceQuery query(s.positions, s.triangles);
  const PointsD points = random_points(200, 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    double best = endless;
    for (Eigen::Index t = 0; t < s.triangles.rows(); ++t) {
      const auto found =
          closest_point_on_triangle(points.row(i), s.positions.row(s.triangles(t, 0)),
                                    s.positions.row(s.triangles(t, 1)), s.positions.row(s.triangles(t, 2)));
      best = std::min(best, (found.position - points.row(i).transpose()).norm());
    }
    EXPECT_NEAR(query.closest(points.row(i)).distance, best, 1e-7);
  }
}

TEST(surface_query, rejected_triangles_are_passed_over) {
  const Surface s = cube();
  const SurfaceQuery query(s.positions, s.triangles);
  const auto below = [](int, const Vector3d& position) { return position.z() < 0.5; };
  EXPECT_EQ(query.closest({0.4, 0.3, 2}, endless, below).position.z(), 0);
  EXPECT_EQ(query.closest({0.4, 0.3, 2}, endless, [](int, const Vector3d&) { return false; }).triangle, -1);
}

TEST(surface_query, an_attribute_tells_close_places_apart) {
  // Beside the cube's upper edge the top is closer; who looks to the side finds the side.
  const Surface s = cube();
  const PointsD normals = s.positions.array() - 0.5;
  const SurfaceQuery query(s.positions, s.triangles);
  const Vector3d point(0.9, 0.5, 1.05);
  EXPECT_TRUE(query.closest(point).position.isApprox(Vector3d(0.9, 0.5, 1), 1e-9));
  const auto alike = query.most_alike(point, 10 * Vector3d(0.5, 0, -0.2), query.with(10 * normals));
  EXPECT_NEAR(alike.position.x(), 1, 1e-9);
  EXPECT_NEAR(alike.distance, (alike.position - point).norm(), 1e-12);
  const auto plain = query.most_alike(point, Vector3d::Zero(), query.with(PointsD::Zero(normals.rows(), 3)));
  EXPECT_TRUE(plain.position.isApprox(query.closest(point).position, 1e-9));
}

TEST(surface_query, a_guess_and_a_fast_build_change_no_answer) {
  Surface s = grid(12);
  s.positions.col(2) = (s.positions.col(0).array() * 0.9).sin() + (s.positions.col(1).array() * 0.7).cos();
  s.positions = (s.positions / 6).rowwise() - Eigen::RowVector3d(1, 1, 0);
  const PointsD normals = 0.3 * vertex_normals(s.positions, s.triangles);
  const SurfaceQuery good(s.positions, s.triangles);
  const SurfaceQuery fast(s.positions, s.triangles, SurfaceQuery::Build::fast);
  const PointsD points = random_points(200, 1);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3d point = points.row(i).transpose(), normal = 0.3 * points.row((i + 1) % 200).transpose();
    EXPECT_EQ(fast.closest(point).triangle, good.closest(point).triangle);
    const auto alike = good.most_alike(point, normal, good.with(normals));
    for (const int guess : {alike.triangle, 0, static_cast<int>(s.triangles.rows()) - 1}) {
      const auto guessed = fast.most_alike(point, normal, fast.with(normals), guess);
      EXPECT_EQ(guessed.triangle, alike.triangle);
      EXPECT_EQ(guessed.position, alike.position);
      EXPECT_EQ(guessed.distance, alike.distance);
    }
  }
}

TEST(surface_query, rays) {
  const Surface s = cube();
  const SurfaceQuery query(s.positions, s.triangles);
  const auto hit = query.first_along({0.3, 0.6, 3}, {0, 0, -1}, 0, 10);
  EXPECT_NEAR(hit.distance, 2, 1e-6);
  EXPECT_TRUE(hit.position.isApprox(Vector3d(0.3, 0.6, 1), 1e-6));
  EXPECT_EQ(query.first_along({0.3, 0.6, 3}, {0, 0, 1}, 0, 10).triangle, -1);
  EXPECT_TRUE(query.occluded({0.3, 0.6, 3}, {0, 0, -1}, 0, 10));
  EXPECT_FALSE(query.occluded({0.3, 0.6, 3}, {0, 0, -1}, 0, 1.9));
  EXPECT_FALSE(query.occluded({2, 0.6, 3}, {0, 0, -1}, 0, 10));
  PointsD directions(33, 3);
  for (int r = 0; r < 33; ++r) directions.row(r) = Vector3d(0.2 * (r % 11) - 1, 0.1, -1).normalized();
  int free = 0;
  for (int r = 0; r < 33; ++r) free += !query.occluded({0.3, 0.6, 3}, directions.row(r), 0, 10);
  EXPECT_GT(free, 0);
  EXPECT_LT(free, 33);
  EXPECT_EQ(query.count_free({0.3, 0.6, 3}, directions, 10), free);
}

TEST(surface_query, does_not_depend_on_the_unit) {
  const Surface s = cube();
  const PointsD points = random_points(50, 4);
  const SurfaceQuery query(s.positions, s.triangles);
  for (const double unit : {0.01, 100.0}) {
    const SurfaceQuery scaled(PointsD(unit * s.positions), s.triangles);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      EXPECT_NEAR(scaled.closest(unit * points.row(i)).distance, unit * query.closest(points.row(i)).distance,
                  1e-6 * unit);
  }
}

}  // namespace
}  // namespace mien::test
