#include "mien/geometry/nurbs_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

NurbsSurface bicubic() {
  return {3, 3, 5, 4, {0, 0, 0, 0, 1, 2, 2, 2, 2}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
}

TEST(nurbs_surface, faults_are_put_in_words) {
  EXPECT_THAT(fault_of(bicubic(), 20), IsEmpty());
  EXPECT_THAT(fault_of(bicubic(), 19), HasSubstr("is a grid of 20 control vertices, there are 19"));
  NurbsSurface bad = bicubic();
  bad.degree_u = 0;
  EXPECT_THAT(fault_of(bad, 20), HasSubstr("degree 0 along u"));
  bad = bicubic();
  bad.count_v = 3;
  EXPECT_THAT(fault_of(bad, 15), HasSubstr("3 control vertices along v, more than its degree 3"));
  bad = bicubic();
  bad.knots_u.pop_back();
  EXPECT_THAT(fault_of(bad, 20), HasSubstr("has 8 knots along u, 9 are needed"));
  bad = bicubic();
  bad.knots_v[4] = -1;
  EXPECT_THAT(fault_of(bad, 20), HasSubstr("descend"));
  bad = bicubic();
  bad.knots_v.assign(8, 1.0);
  EXPECT_THAT(fault_of(bad, 20), HasSubstr("without a domain"));
  bad = bicubic();
  bad.weights.assign(20, 1.0);
  bad.weights[7] = 0;
  EXPECT_THAT(fault_of(bad, 20), HasSubstr("weight that is not above 0"));
  EXPECT_THROW(tessellate(bad, PointsD::Zero(20, 3), 4, 4), Error);
  EXPECT_THROW(tessellate(bicubic(), PointsD::Zero(20, 3), 1, 4), Error);
}

TEST(nurbs_surface, shares_sum_to_one_and_corners_are_met) {
  NurbsSurface surface = bicubic();
  for (int k = 0; k < 20; ++k) surface.weights.push_back(0.5 + 0.1 * k);
  for (double u = -0.5; u < 2.6; u += 0.13)
    for (double v = 0; v <= 1; v += 0.25) {
      const Eigen::VectorXd basis = nurbs_basis(surface, u, v);
      EXPECT_NEAR(basis.sum(), 1, 1e-14);
      EXPECT_GE(basis.minCoeff(), 0);
    }
  EXPECT_DOUBLE_EQ(nurbs_basis(surface, 0, 0)[0], 1);
  EXPECT_DOUBLE_EQ(nurbs_basis(surface, 2, 1)[19], 1);
}

TEST(nurbs_surface, of_degree_one_is_bilinear) {
  const NurbsSurface patch{1, 1, 2, 2, {0, 0, 1, 1}, {0, 0, 1, 1}, {}};
  PointsD controls(4, 3);
  controls << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 4;
  const Mesh mesh = tessellate(patch, controls, 3, 5);
  EXPECT_EQ(mesh.vertex_count(), 15u);
  EXPECT_EQ(mesh.faces.size(), 8u);
  EXPECT_EQ(mesh.positions.row(7), Eigen::RowVector3f(0.5f, 0.5f, 1));
}

TEST(nurbs_surface, with_weights_holds_a_cylinder_exactly) {
  const double w = std::sqrt(0.5);
  const NurbsSurface quarter{2, 1, 3, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {1, w, 1, 1, w, 1}};
  PointsD controls(6, 3);
  controls << 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 2, 1, 1, 2, 0, 1, 2;
  for (double u = 0; u <= 1; u += 0.1) {
    const Eigen::RowVector3d point = nurbs_basis(quarter, u, 0.5).transpose() * controls;
    EXPECT_NEAR(point.head<2>().norm(), 1, 1e-14);
    EXPECT_NEAR(point.z(), 1, 1e-14);
  }
}

}  // namespace
}  // namespace mien
