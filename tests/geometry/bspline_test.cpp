#include "mien/geometry/bspline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"

namespace mien {
namespace {

PointsD helix(int count) {
  PointsD points(count, 3);
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / (count - 1);
    points.row(i) << std::cos(2 * t), std::sin(2 * t), t;
  }
  return points;
}

TEST(BSplineInvalid, SaysWhatACubicNeeds) {
  const auto text = [](auto run) {
    try {
      run();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(text([] { clamped_knots(3); }), "curve: has 3 control points; a cubic needs four or more");
  EXPECT_EQ(text([] { fit_bspline(PointsD::Zero(1, 3)); }), "curve: has 1 points; two or more");
  EXPECT_EQ(text([] { fit_bspline(PointsD::Zero(5, 3)); }), "curve: has no length; points that differ");
  BSpline curve{helix(5), clamped_knots(6)};
  EXPECT_EQ(text([&] { require_valid(curve); }), "curve: has 10 knots; 9, four more than control points");
}

TEST(BSpline, BasisSumsToOneAndDifferentiates) {
  for (const auto& knots :
       {clamped_knots(7), uniform_knots(7), std::vector<double>{0, 0, 0, 0, 0.1, 0.1, 0.7, 1, 1, 1, 1}})
    for (double u = 0.003; u < 1; u += 0.0371) {
      const SplineBasis basis = basis_at(knots, u), slope = basis_derivatives_at(knots, u);
      double sum = 0, slopes = 0;
      for (int k = 0; k < 4; ++k) {
        sum += basis.values[k];
        slopes += slope.values[k];
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      EXPECT_NEAR(slopes, 0, 1e-10);
      const BSpline curve{helix(7), knots};
      const double h = 1e-6;
      EXPECT_NEAR((point_at(curve, u + h) - point_at(curve, u - h) - 2 * h * derivative_at(curve, u)).norm(),
                  0, 1e-10);
    }
}

TEST(BSpline, FitFollowsItsPointsAndClampedEndsMeet) {
  const PointsD points = helix(40);
  const BSpline curve = fit_bspline(points);
  const CurveQuery query(curve);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    EXPECT_LT(query.closest(points.row(i).transpose()).distance, 2e-3);
  EXPECT_NEAR((point_at(curve, 0) - curve.controls.row(0).transpose()).norm(), 0, 1e-12);
  EXPECT_NEAR((point_at(curve, 1) - curve.controls.row(9).transpose()).norm(), 0, 1e-12);
}

TEST(BSpline, ClosestPointIsPerpendicular) {
  const BSpline curve = fit_bspline(helix(40));
  const CurveQuery query(curve);
  const Eigen::Vector3d p(0.5, 0.9, 0.3);
  const CurveQuery::Hit hit = query.closest(p);
  EXPECT_NEAR((p - hit.position).normalized().dot(derivative_at(curve, hit.parameter).normalized()), 0, 1e-3);
}

}  // namespace
}  // namespace mien
