#include "mien/geometry/nurbs_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"
#include "mien/geometry/bspline.h"
#include "mien/geometry/detail/spline_basis.h"

namespace mien {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

NurbsCurve cubic() {
  return {3, {0, 0, 0, 0, 1, 2, 2, 2, 2}, {}};
}

TEST(nurbs_curve, faults_are_put_in_words) {
  EXPECT_THAT(fault_of(cubic(), 5), IsEmpty());
  EXPECT_THAT(fault_of(cubic(), 6), HasSubstr("has 9 knots, 10 are needed"));
  NurbsCurve bad = cubic();
  bad.degree = 0;
  EXPECT_THAT(fault_of(bad, 5), HasSubstr("has degree 0, from 1 to 16"));
  EXPECT_THAT(fault_of(cubic(), 3), HasSubstr("has 3 control points, more than its degree 3"));
  bad = cubic();
  bad.knots[4] = -1;
  EXPECT_THAT(fault_of(bad, 5), HasSubstr("knots that descend"));
  bad.knots.assign(9, 1.0);
  EXPECT_THAT(fault_of(bad, 5), HasSubstr("without a domain"));
  bad = cubic();
  bad.weights = {1, 1, 1};
  EXPECT_THAT(fault_of(bad, 5), HasSubstr("has 3 weights, there are 5 control points"));
  bad.weights = {1, 1, -1, 1, 1};
  EXPECT_THAT(fault_of(bad, 5), HasSubstr("weight that is not above 0"));
  EXPECT_THROW(tessellate(bad, PointsD::Zero(5, 3), 4), Error);
  EXPECT_THROW(tessellate(cubic(), PointsD::Zero(5, 3), 1), Error);
}

TEST(nurbs_curve, shares_sum_to_one_and_ends_are_met) {
  NurbsCurve curve = cubic();
  curve.weights = {1, 2, 0.5, 3, 1};
  for (double u = -0.5; u < 2.6; u += 0.07) {
    const Eigen::VectorXd basis = nurbs_basis(curve, u);
    EXPECT_NEAR(basis.sum(), 1, 1e-14);
    EXPECT_GE(basis.minCoeff(), 0);
    EXPECT_LE((basis.array() > 0).count(), 4);
  }
  EXPECT_DOUBLE_EQ(nurbs_basis(curve, 0)[0], 1);
  EXPECT_DOUBLE_EQ(nurbs_basis(curve, 2)[4], 1);
}

TEST(nurbs_curve, of_one_span_is_a_bezier_curve) {
  const NurbsCurve bezier{4, {0, 0, 0, 0, 0, 1, 1, 1, 1, 1}, {}};
  const double binomial[5] = {1, 4, 6, 4, 1};
  for (double u = 0; u <= 1; u += 0.1)
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(nurbs_basis(bezier, u)[i], binomial[i] * std::pow(u, i) * std::pow(1 - u, 4 - i), 1e-15);
}

TEST(nurbs_curve, with_weights_holds_a_circle_exactly) {
  const NurbsCurve quarter{2, {0, 0, 0, 1, 1, 1}, {1, std::sqrt(0.5), 1}};
  PointsD controls(3, 3);
  controls << 1, 0, 7, 1, 1, 7, 0, 1, 7;
  const PointsD points = tessellate(quarter, controls, 12);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    EXPECT_NEAR(points.row(i).head<2>().norm(), 1, 1e-14);
    EXPECT_NEAR(points(i, 2), 7, 1e-14);
  }
}

TEST(nurbs_curve, without_weights_is_the_cubic_that_wires_use) {
  const NurbsCurve curve = cubic();
  for (double u = 0; u <= 2; u += 0.125) {
    const SplineBasis basis = basis_at(curve.knots, u);
    const Eigen::VectorXd shares = nurbs_basis(curve, u);
    for (int a = 0; a < 4; ++a) EXPECT_NEAR(shares[basis.first + a], basis.values[a], 1e-15);
  }
}

TEST(nurbs_curve, slopes_of_the_basis_are_its_differences) {
  const std::vector<double> knots{0, 0, 0, 0, 0.3, 0.3, 1.1, 2, 2, 2, 2};
  for (const double u : {0.05, 0.25, 0.4, 0.9, 1.2, 1.95}) {
    const double h = 1e-6;
    const Eigen::VectorXd slope = detail::spline_basis_slope(3, 7, knots, u),
                          difference = (detail::spline_basis(3, 7, knots, u + h) -
                                        detail::spline_basis(3, 7, knots, u - h)) /
                                       (2 * h);
    EXPECT_LT((slope - difference).cwiseAbs().maxCoeff(), 1e-7) << u;
    EXPECT_NEAR(slope.sum(), 0, 1e-13);
  }
}

}  // namespace
}  // namespace mien
