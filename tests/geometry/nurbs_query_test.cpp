#include "mien/geometry/nurbs_query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "error_of.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

const double root = std::sqrt(0.5);
const NurbsCurve quarter{2, {0, 0, 0, 1, 1, 1}, {1, root, 1}};
const NurbsSurface cylinder{2, 1, 3, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {1, root, 1, 1, root, 1}};

PointsD arc() {
  PointsD controls(3, 3);
  controls << 1, 0, 0, 1, 1, 0, 0, 1, 0;
  return controls;
}

PointsD wall() {
  PointsD controls(6, 3);
  controls << 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 2, 1, 1, 2, 0, 1, 2;
  return controls;
}

TEST(nurbs_query, invalid_inputs) {
  EXPECT_THAT(error_of([] { NurbsCurveQuery(quarter, PointsD::Zero(4, 3)); }),
              HasSubstr("spline curve: has 6 knots, 7 are needed"));
  EXPECT_THAT(error_of([] { NurbsSurfaceQuery(cylinder, PointsD::Zero(4, 3)); }),
              HasSubstr("spline surface: is a grid of 6"));
  EXPECT_THAT(error_of([] { clamped_knots(3, 3); }), HasSubstr("3 control points of degree 3"));
  EXPECT_THAT(error_of([] { fit_controls(quarter, PointsD::Random(2, 3)); }),
              HasSubstr("points to fit: number 2; 3 or more"));
  EXPECT_THAT(error_of([] { fit_controls(quarter, PointsD::Ones(4, 3)); }),
              HasSubstr("points to fit: are all in one place"));
  EXPECT_THAT(error_of([] { fit_controls(quarter, PointsD::Constant(4, 3, NAN)); }),
              HasSubstr("points to fit: are not finite"));
  EXPECT_THAT(error_of([] { fit_controls(cylinder, wall()); }), HasSubstr("spline surface: is rational"));
}

TEST(nurbs_query, the_closest_point_of_a_circle_lies_on_the_ray) {
  const NurbsCurveQuery query(quarter, arc());
  // Eight chords; those beside the middle are the longest and lie deepest below the circle.
  const double sagitta = 1 - ((query.at(0.5) + query.at(0.625)) / 2).norm();
  EXPECT_LT(sagitta, 0.01);
  for (double angle = 0.05; angle < 1.55; angle += 0.1)
    for (const double radius : {0.5, 1.0, 3.0}) {
      const Eigen::Vector3d ray(std::cos(angle), std::sin(angle), 0);
      const auto hit = query.closest(radius * ray + Eigen::Vector3d(0, 0, 0.3));
      EXPECT_LT((query.at(hit.u) - ray).norm(), 1e-6);
      EXPECT_NEAR(hit.distance, std::hypot(radius - 1, 0.3), 1e-12);
      EXPECT_NEAR(query.rough_distance(radius * ray), std::abs(radius - 1), sagitta + 1e-12);
    }
  EXPECT_EQ(query.closest({2, -1, 0}).u, 0);
  EXPECT_EQ(query.closest({-1, 2, 0}).u, 1);
}

TEST(nurbs_query, a_polygon_is_met_at_its_corners) {
  const NurbsCurve polygon{1, {0, 0, 1, 2, 2}, {}};
  PointsD controls(3, 3);
  controls << 0, 0, 0, 1, 0, 0, 1, 2, 0;
  const NurbsCurveQuery query(polygon, controls);
  EXPECT_NEAR(query.closest({0.3, -1, 0}).u, 0.3, 1e-6);
  EXPECT_EQ(query.closest({2, -1, 0}).u, 1);
  EXPECT_NEAR(query.closest({2, 0.5, 0}).u, 1.25, 1e-6);
}

TEST(nurbs_query, the_closest_point_of_a_cylinder_lies_on_the_ray) {
  const NurbsSurfaceQuery query(cylinder, wall());
  for (double angle = 0.05; angle < 1.55; angle += 0.15)
    for (const double height : {0.0, 0.7, 2.0}) {
      const Eigen::Vector3d ray(std::cos(angle), std::sin(angle), 0), up(0, 0, height);
      const auto hit = query.closest(1.8 * ray + up);
      EXPECT_LT((query.at(hit.u, hit.v) - ray - up).norm(), 1e-5);
      EXPECT_NEAR(hit.distance, 0.8, 1e-9);
      EXPECT_NEAR(hit.v, height / 2, 1e-5);
    }
  EXPECT_EQ(query.closest({3, -1, 5}).v, 1);
}

TEST(nurbs_query, a_curve_is_fitted_through_its_own_points) {
  const NurbsCurve cubic{3, clamped_knots(6, 3), {}};
  PointsD line(6, 3);
  for (int i = 0; i < 6; ++i) line.row(i) << 3 * i, 1 - i, 0.5;
  const PointsD points = tessellate(cubic, fit_controls(cubic, line), 6);
  EXPECT_LT((points.row(0) - line.row(0)).norm(), 1e-12);
  EXPECT_LT((points.row(5) - line.row(5)).norm(), 1e-12);
  EXPECT_LT((points.row(2).x() - 15 * 0.4), 1e-12);
}

TEST(nurbs_query, a_surface_passes_through_its_grid) {
  const NurbsSurface surface{3, 2, 6, 4, clamped_knots(6, 3), clamped_knots(4, 2), {}};
  PointsD grid(24, 3);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 6; ++i) grid.row(i + 6 * j) << i, j, std::sin(i + 2.0 * j);
  const PointsD controls = fit_controls(surface, grid);
  const auto mean = [](const std::vector<double>& knots, int i, int degree) {
    double sum = 0;
    for (int k = 1; k <= degree; ++k) sum += knots[static_cast<std::size_t>(i + k)];
    return sum / degree;
  };
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 6; ++i) {
      const Eigen::RowVector3d point =
          nurbs_basis(surface, mean(surface.knots_u, i, 3), mean(surface.knots_v, j, 2)).transpose() *
          controls;
      EXPECT_LT((point - grid.row(i + 6 * j)).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace mien
