#include "mien/geometry/thin_plate_spline.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;
using Options = ThinPlateSpline::Options;

std::string failure(const PointsD& from, const PointsD& to) {
  return failure_of([&] { ThinPlateSpline(from, to); });
}

TEST(thin_plate_spline, invalid_landmarks_are_named) {
  const PointsD good = random_points(6, 1);
  EXPECT_EQ(failure(good, good.topRows(5)),
            "thin-plate spline: 6 landmarks before and 5 after; as many on both sides");
  EXPECT_EQ(failure(good.topRows(3), good.topRows(3)), "thin-plate spline: has 3 landmarks; 4 or more");
  PointsD broken = good;
  broken(2, 1) = std::nan("");
  EXPECT_EQ(failure(broken, good), "thin-plate spline: a landmark is not finite; finite coordinates");
  EXPECT_EQ(failure(good, broken), "thin-plate spline: a landmark is not finite; finite coordinates");
  PointsD twice = good;
  twice.row(4) = twice.row(1);
  EXPECT_EQ(failure(twice, good),
            "thin-plate spline: landmarks 1 and 4 coincide; landmarks at different places");
  PointsD flat = good;
  flat.col(2).setConstant(7);
  EXPECT_EQ(failure(flat, good),
            "thin-plate spline: all landmarks lie in one plane; one landmark or more off that plane");
  PointsD line = good;
  for (int i = 0; i < 6; ++i) line.row(i) << i, 2 * i, 3 * i;
  EXPECT_NE(failure(line, good).find("in one plane"), std::string::npos);
}

TEST(thin_plate_spline, equal_landmarks_give_the_identity) {
  const PointsD landmarks = random_points(12, 2), points = random_points(40, 3);
  const ThinPlateSpline spline(landmarks, landmarks);
  EXPECT_TRUE(spline(points).isApprox(points, 1e-10));
  EXPECT_NEAR(spline.bending_energy(), 0, 1e-10);
}

TEST(thin_plate_spline, affine_maps_are_reproduced) {
  const PointsD landmarks = random_points(12, 2), points = 3 * random_points(40, 3);
  Eigen::Matrix3d matrix;
  matrix << 1, 2, 0, -1, 3, 0.5, 0.2, 0, 2;
  const auto map = [&](const PointsD& x) {
    return PointsD((x * matrix.transpose()).rowwise() + Eigen::RowVector3d(5, 6, 7));
  };
  const ThinPlateSpline spline(landmarks, map(landmarks));
  EXPECT_TRUE(spline(points).isApprox(map(points), 1e-10));
  EXPECT_TRUE(spline.jacobian(Vector3d(0.1, 0.2, 0.3)).isApprox(matrix, 1e-9));
  EXPECT_NEAR(spline.bending_energy(), 0, 1e-9);
}

TEST(thin_plate_spline, is_exact_at_its_landmarks) {
  const PointsD from = random_points(30, 4), to = random_points(30, 5);
  EXPECT_TRUE(ThinPlateSpline(from, to)(from).isApprox(to, 1e-9));
}

// Four corners of a regular tetrahedron and its centre, which alone moves: by symmetry the affine part of the
// map is a translation, and the coefficients follow from one equation.
TEST(thin_plate_spline, closed_form_of_a_moved_centre) {
  PointsD from(5, 3);
  from << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1, 0, 0, 0;
  PointsD to = from;
  to(4, 0) += 1;
  // Displacement u(x) = c + w (|x| - sum_i |x - l_i| / 4): u(0) = 1, u(l_i) = 0.
  const double r = std::sqrt(3.0), edge = std::sqrt(8.0);
  const double at_centre = -r, at_corner = r - 3 * edge / 4;
  const double w = 1 / (at_centre - at_corner), c = -w * at_corner;
  const ThinPlateSpline spline(from, to);
  for (const Vector3d& x : {Vector3d(0.3, -0.2, 0.9), Vector3d(2, 1, 0), Vector3d(0, 0, -0.5)}) {
    double kernel = x.norm();
    for (int i = 0; i < 4; ++i) kernel -= (x - from.row(i).transpose()).norm() / 4;
    const Vector3d expected = x + Vector3d(c + w * kernel, 0, 0);
    EXPECT_TRUE(spline(x).isApprox(expected, 1e-12)) << spline(x).transpose();
  }
  EXPECT_NEAR(spline.bending_energy(), -w, 1e-12) << "-w' K w with u(l) = K w + affine, and w' u = w";
}

TEST(thin_plate_spline, smoothing_bends_less_and_stays_near) {
  const PointsD from = random_points(30, 4), to = from + 0.1 * random_points(30, 5);
  double energy = ThinPlateSpline(from, to).bending_energy();
  double error = 0;
  for (const double smoothing : {1e-3, 1e-2, 1e-1, 1.0}) {
    const ThinPlateSpline spline(from, to, Options{.smoothing = smoothing});
    EXPECT_LT(spline.bending_energy(), energy);
    EXPECT_GE(spline.bending_energy(), 0);
    EXPECT_GT((spline(from) - to).norm(), error);
    energy = spline.bending_energy();
    error = (spline(from) - to).norm();
  }
}

TEST(thin_plate_spline, a_wide_spread_leaves_a_landmark_out) {
  PointsD from = random_points(30, 4), to = from + 0.1 * random_points(30, 5);
  from.row(0) = from.colwise().mean();  // not on the box, which smoothing is relative to
  Options alike{.smoothing = 1e-2};
  const ThinPlateSpline plain(from, to, alike);
  alike.spread = Eigen::VectorXd::Ones(30);
  const PointsD points = random_points(20, 6);
  EXPECT_EQ(ThinPlateSpline(from, to, alike)(points), plain(points));

  Options wide = alike;
  wide.spread[0] = 1e12;
  const ThinPlateSpline without(from.bottomRows(29), to.bottomRows(29), Options{.smoothing = 1e-2});
  EXPECT_TRUE(ThinPlateSpline(from, to, wide)(points).isApprox(without(points), 1e-8));
  Options narrow = alike;
  narrow.spread[0] = 0;
  EXPECT_TRUE(ThinPlateSpline(from, to, narrow)(PointsD(from.topRows(1))).isApprox(to.topRows(1), 1e-9));

  narrow.spread[3] = -1;
  EXPECT_EQ(failure_of([&] { ThinPlateSpline(from, to, narrow); }),
            "thin-plate spline: a spread of 30 numbers; one of 0 or more for each of the 30 landmarks");
  narrow.spread.conservativeResize(29);
  EXPECT_EQ(failure_of([&] { ThinPlateSpline(from, to, narrow); }),
            "thin-plate spline: a spread of 29 numbers; one of 0 or more for each of the 30 landmarks");
}

TEST(thin_plate_spline, principal_warps_are_orthonormal_eigenvectors) {
  const PointsD landmarks = random_points(10, 6);
  const auto [energies, warps] = ThinPlateSpline::principal_warps(landmarks);
  ASSERT_EQ(energies.size(), 6);
  EXPECT_TRUE((warps.transpose() * warps).isIdentity(1e-10));
  EXPECT_LT(warps.colwise().sum().norm(), 1e-10) << "no translation";
  EXPECT_LT((landmarks.transpose() * warps).norm(), 1e-9) << "nothing linear";
  EXPECT_GT(energies[0], 0);
  for (int i = 1; i < 6; ++i) EXPECT_GE(energies[i], energies[i - 1]);
}

TEST(thin_plate_spline, all_principal_warps_are_the_whole_map_and_none_is_its_affine_part) {
  const PointsD from = random_points(10, 6), to = random_points(10, 7), points = random_points(20, 8);
  const ThinPlateSpline whole(from, to);
  EXPECT_TRUE(ThinPlateSpline(from, to, Options{.principal_warps = 6})(points).isApprox(whole(points)));
  const ThinPlateSpline affine(from, to, Options{.principal_warps = 0});
  EXPECT_TRUE(affine.jacobian({1, 2, 3}).isApprox(affine.jacobian({-1, 0, 3})));
  EXPECT_NEAR(affine.bending_energy(), 0, 1e-12);
  double energy = 0;
  for (int kept = 1; kept <= 6; ++kept) {
    const double more = ThinPlateSpline(from, to, Options{.principal_warps = kept}).bending_energy();
    EXPECT_GE(more, energy);
    energy = more;
  }
}

TEST(thin_plate_spline, jacobian_is_the_derivative) {
  const ThinPlateSpline spline(random_points(12, 9), random_points(12, 10));
  const Vector3d x(0.21, -0.34, 0.11);
  Eigen::Matrix3d differences;
  const double h = 1e-5;
  for (int k = 0; k < 3; ++k) {
    const Vector3d step = h * Vector3d::Unit(k), ahead = x + step, behind = x - step;
    differences.col(k) = (spline(ahead) - spline(behind)) / (2 * h);
  }
  EXPECT_TRUE(spline.jacobian(x).isApprox(differences, 1e-6));
}

TEST(thin_plate_spline, does_not_depend_on_the_unit_or_the_place) {
  const PointsD from = random_points(20, 11), to = random_points(20, 12), points = random_points(20, 13);
  const PointsD expected = ThinPlateSpline(from, to)(points);
  for (const double unit : {0.01, 100.0}) {
    const auto moved = [&](const PointsD& x) {
      return PointsD((unit * x).rowwise() + unit * Eigen::RowVector3d(30, 0, 170));
    };
    EXPECT_TRUE(ThinPlateSpline(moved(from), moved(to))(moved(points)).isApprox(moved(expected), 1e-9));
  }
}

}  // namespace
}  // namespace mien::test
