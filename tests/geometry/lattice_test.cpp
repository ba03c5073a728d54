#include "mien/geometry/lattice.h"

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
using ::testing::IsEmpty;

const Box box{{-1, 2, 5}, {3, 4, 6}};

Eigen::Vector3d at(const Lattice& lattice, const PointsD& controls, const Eigen::Vector3d& c) {
  return (lattice_basis(lattice, c).transpose() * controls).transpose();
}

TEST(lattice, faults_are_put_in_words) {
  const Lattice lattice{{4, 3, 2}, {3, 2, 1}};
  EXPECT_THAT(fault_of(lattice, 24), IsEmpty());
  EXPECT_THAT(fault_of(lattice, 23), HasSubstr("is a grid of 24 control points, there are 23"));
  EXPECT_THAT(fault_of({{4, 1, 2}, {3, 1, 1}}, 8), HasSubstr("1 control points along t, 2 or more"));
  EXPECT_THAT(fault_of({{4, 3, 2}, {3, 2, 2}}, 24), HasSubstr("degree 2 along u, from 1 to 1"));
  EXPECT_THAT(fault_of({{4, 3, 2}, {0, 2, 1}}, 24), HasSubstr("degree 0 along s, from 1 to 3"));
  EXPECT_THAT(fault_of({{100000, 100000, 2}, {1, 1, 1}}, 24), HasSubstr("more than 1000000"));
  EXPECT_THAT(error_of([&] {
                lattice_controls(lattice, {{0, 0, 0}, {1, 0, 1}});
              }),
              HasSubstr("lattice: fills a box without volume"));
  EXPECT_THAT(error_of([&] {
                lattice_coordinates(lattice, PointsD::Zero(5, 3), {0, 0, 0});
              }),
              HasSubstr("is a grid of 24 control points, there are 5"));
}

TEST(lattice, shares_sum_to_one_and_corners_are_met) {
  const Lattice lattice{{4, 5, 3}, {3, 2, 1}};
  for (double s = -0.2; s < 1.2; s += 0.23)
    for (double t = 0; t <= 1; t += 0.25) {
      const Eigen::VectorXd shares = lattice_basis(lattice, {s, t, 0.4});
      EXPECT_NEAR(shares.sum(), 1, 1e-14);
      EXPECT_GE(shares.minCoeff(), 0);
    }
  EXPECT_DOUBLE_EQ(lattice_basis(lattice, {0, 0, 0})[0], 1);
  EXPECT_DOUBLE_EQ(lattice_basis(lattice, {1, 0, 0})[3], 1);
  EXPECT_DOUBLE_EQ(lattice_basis(lattice, {0, 1, 0})[16], 1);
  EXPECT_DOUBLE_EQ(lattice_basis(lattice, {1, 1, 1})[59], 1);
}

TEST(lattice, of_full_degree_has_the_bernstein_basis) {
  const Lattice lattice{{4, 3, 2}, {3, 2, 1}};
  const Eigen::Vector3d c(0.3, 0.6, 0.9);
  const auto bernstein = [](int n, int i, double u) {
    double binomial = 1;
    for (int k = 1; k <= i; ++k) binomial = binomial * (n - k + 1) / k;
    return binomial * std::pow(u, i) * std::pow(1 - u, n - i);
  };
  const Eigen::VectorXd shares = lattice_basis(lattice, c);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(shares[i + 4 * (j + 3 * k)],
                    bernstein(3, i, c[0]) * bernstein(2, j, c[1]) * bernstein(1, k, c[2]), 1e-15);
}

TEST(lattice, reproduces_affine_maps) {
  const Lattice lattice{{6, 4, 3}, {3, 1, 2}};
  const PointsD controls = lattice_controls(lattice, box);
  Eigen::Matrix3d linear;
  linear << 1, 0.3, -0.2, 0.1, 2, 0.4, 0, -0.5, 0.7;
  const Eigen::RowVector3d shift(3, -1, 2);
  const PointsD moved = (controls * linear.transpose()).rowwise() + shift;
  for (double s = 0; s <= 1; s += 0.125)
    for (double u = 0; u <= 1; u += 0.2) {
      const Eigen::Vector3d c(s, 1 - s, u);
      const Eigen::Vector3d point = box.low + (box.high - box.low).cwiseProduct(c);
      EXPECT_LT((at(lattice, controls, c) - point).norm(), 1e-14);
      EXPECT_LT((at(lattice, moved, c) - (linear * point + shift.transpose())).norm(), 1e-13);
      const auto found = lattice_coordinates(lattice, controls, point);
      ASSERT_TRUE(found);
      EXPECT_LT((*found - c).norm(), 1e-11);
    }
}

TEST(lattice, finds_points_of_bent_lattices) {
  for (const Lattice& lattice :
       {Lattice{{4, 4, 4}, {3, 3, 3}}, Lattice{{5, 4, 3}, {2, 3, 1}}, Lattice{{2, 2, 2}, {1, 1, 1}}}) {
    PointsD controls = lattice_controls(lattice, box);
    for (Eigen::Index r = 0; r < controls.rows(); ++r) {
      const Eigen::RowVector3d p = controls.row(r);
      // A bend about the y axis, a twist and a bulge, far from the origin.
      const double angle = 0.35 * (p.x() - 1), wide = 4 + p.z() - 5;
      controls.row(r) << 1000 + wide * std::sin(angle), p.y() + 0.2 * std::sin(2 * p.x()) * (p.z() - 5),
          wide * std::cos(angle) - 0.05 * p.y() * p.y();
    }
    for (double s = 0; s <= 1; s += 0.125)
      for (double t = 0; t <= 1; t += 0.25)
        for (double u = 0; u <= 1; u += 0.25) {
          const Eigen::Vector3d c(s, t, u);
          const auto found = lattice_coordinates(lattice, controls, at(lattice, controls, c));
          ASSERT_TRUE(found) << c.transpose();
          EXPECT_LT((*found - c).norm(), 1e-9) << c.transpose();
        }
  }
}

TEST(lattice, has_no_coordinates_outside) {
  const Lattice lattice{{4, 4, 4}, {3, 3, 3}};
  PointsD controls = lattice_controls(lattice, box);
  EXPECT_FALSE(lattice_coordinates(lattice, controls, {3.001, 3, 5.5}));
  EXPECT_FALSE(lattice_coordinates(lattice, controls, {0, 3, 4.99}));
  EXPECT_FALSE(lattice_coordinates(lattice, controls, {1e9, 0, 0}));
  // Bulged: within the hull of the control points, yet outside.
  controls.row(1 + 4 * (1 + 4 * 3)).z() += 1;
  EXPECT_FALSE(lattice_coordinates(lattice, controls, {-0.9, 2.1, 6.5}));
  // Flat: no point has coordinates, and none is a crash.
  controls.col(2).setConstant(5);
  EXPECT_FALSE(lattice_coordinates(lattice, controls, {0, 3, 5.5}));
}

}  // namespace
}  // namespace mien
