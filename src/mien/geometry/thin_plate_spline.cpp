// The system is solved in coordinates centred on the landmarks and scaled to a unit box: K and P then have
// entries of one size, and a head in millimetres at body height is as well conditioned as one in metres at
// the origin.
#include "mien/geometry/thin_plate_spline.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <string>

#include "mien/core/error.h"
#include "mien/core/parallel.h"

namespace mien {
namespace {

/// Relative to the box: closer landmarks are one landmark, a thinner set is a plane.
constexpr double coincident = 1e-9, coplanar = 1e-7;

void check_landmarks(const PointsD& from, const PointsD& to) {
  if (from.rows() != to.rows())
    throw invalid_input(
        "thin-plate spline",
        std::to_string(from.rows()) + " landmarks before and " + std::to_string(to.rows()) + " after",
        "as many on both sides");
  if (from.rows() < 4)
    throw invalid_input("thin-plate spline", "has " + std::to_string(from.rows()) + " landmarks",
                        "4 or more");
  if (!from.allFinite() || !to.allFinite())
    throw invalid_input("thin-plate spline", "a landmark is not finite", "finite coordinates");
}

void check_normalised(const PointsD& centres) {
  for (Eigen::Index i = 0; i < centres.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if ((centres.row(i) - centres.row(j)).norm() < coincident)
        throw invalid_input("thin-plate spline",
                            "landmarks " + std::to_string(j) + " and " + std::to_string(i) + " coincide",
                            "landmarks at different places");
  const PointsD centred = centres.rowwise() - centres.colwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred);
  if (svd.singularValues()[2] < coplanar * svd.singularValues()[0])
    throw invalid_input("thin-plate spline", "all landmarks lie in one plane",
                        "one landmark or more off that plane");
}

/// #L: what is taken from the kernel's diagonal.
Eigen::VectorXd smoothing_of(const ThinPlateSpline::Options& options, Eigen::Index count) {
  if (options.spread.size() == 0) return Eigen::VectorXd::Constant(count, options.smoothing);
  if (options.spread.size() != count || !(options.spread.minCoeff() >= 0) || !options.spread.allFinite())
    throw invalid_input("thin-plate spline",
                        "a spread of " + std::to_string(options.spread.size()) + " numbers",
                        "one of 0 or more for each of the " + std::to_string(count) + " landmarks");
  return options.smoothing * options.spread;
}

Eigen::MatrixXd kernel_matrix(const PointsD& centres) {
  Eigen::MatrixXd kernel(centres.rows(), centres.rows());
  for (Eigen::Index i = 0; i < centres.rows(); ++i)
    kernel.col(i) = (centres.rowwise() - centres.row(i)).rowwise().norm();
  return kernel;
}

Eigen::MatrixXd affine_rows(const PointsD& centres) {
  Eigen::MatrixXd rows(centres.rows(), 4);
  rows << Eigen::VectorXd::Ones(centres.rows()), centres;
  return rows;
}

ThinPlateSpline::PrincipalWarps warps_of(const PointsD& centres) {
  // Restricted to the space P' w = 0 (basis Z) the bending energy is -(Z' K Z)^-1 up to scale; its
  // eigenvectors in that space, mapped back, are the principal warps of L_n^-1.
  const Eigen::Index n = centres.rows();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(affine_rows(centres));
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd z = q.rightCols(n - 4);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(-z.transpose() * kernel_matrix(centres) * z);
  ThinPlateSpline::PrincipalWarps result;
  result.energies = eigen.eigenvalues().cwiseInverse().reverse();
  result.warps = (z * eigen.eigenvectors()).rowwise().reverse();
  return result;
}

}  // namespace

ThinPlateSpline::ThinPlateSpline(const PointsD& from, const PointsD& to, const Options& options) {
  check_landmarks(from, to);
  const double diagonal = bounding_box(from).diagonal();
  shift_ = from.colwise().mean();
  scale_ = diagonal > 0 ? 1 / diagonal : 1;
  centres_ = (from.rowwise() - shift_) * scale_;
  check_normalised(centres_);

  const Eigen::Index n = from.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 4, n + 4);
  system.topLeftCorner(n, n) = kernel_matrix(centres_);
  system.topLeftCorner(n, n).diagonal() -= smoothing_of(options, n);
  system.topRightCorner(n, 4) = affine_rows(centres_);
  system.bottomLeftCorner(4, n) = system.topRightCorner(n, 4).transpose();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + 4, 3);
  right.topRows(n) = to;
  const Eigen::MatrixXd solution = system.partialPivLu().solve(right);
  weights_ = solution.topRows(n);
  affine_ = solution.bottomRows<4>();
  if (options.principal_warps >= 0 && options.principal_warps < n - 4) {
    const Eigen::MatrixXd kept = warps_of(centres_).warps.leftCols(options.principal_warps);
    weights_ = kept * (kept.transpose() * weights_);
  }
}

Eigen::Vector3d ThinPlateSpline::operator()(const Eigen::Vector3d& x) const {
  PointsD one(1, 3);
  one.row(0) = x.transpose();
  return (*this)(one).row(0).transpose();
}

PointsD ThinPlateSpline::operator()(const PointsD& points) const {
  PointsD result(points.rows(), 3);
  constexpr std::size_t block = 256;
  parallel_for(static_cast<std::size_t>(points.rows()), block, [&](std::size_t begin, std::size_t end) {
    const Eigen::Index rows = static_cast<Eigen::Index>(end - begin),
                       first = static_cast<Eigen::Index>(begin);
    // Column by column, so that the distance to one landmark is computed for the whole block in vector
    // registers.
    const Eigen::Matrix<double, Eigen::Dynamic, 3> x =
        (points.middleRows(first, rows).rowwise() - shift_) * scale_;
    Eigen::Matrix<double, Eigen::Dynamic, 3> y = x * affine_.bottomRows<3>();
    y.rowwise() += affine_.row(0);
    Eigen::ArrayXd distance(rows);
    for (Eigen::Index i = 0; i < centres_.rows(); ++i) {
      distance = ((x.col(0).array() - centres_(i, 0)).square() +
                  (x.col(1).array() - centres_(i, 1)).square() + (x.col(2).array() - centres_(i, 2)).square())
                     .sqrt();
      for (int k = 0; k < 3; ++k) y.col(k).array() += weights_(i, k) * distance;
    }
    result.middleRows(first, rows) = y;
  });
  return result;
}

Eigen::Matrix3d ThinPlateSpline::jacobian(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d y = (x - shift_.transpose()) * scale_;
  Eigen::Matrix3d jacobian = affine_.bottomRows<3>().transpose();
  for (Eigen::Index i = 0; i < centres_.rows(); ++i) {
    const Eigen::Vector3d r = y - centres_.row(i).transpose();
    const double length = r.norm();
    if (length > coincident) jacobian += weights_.row(i).transpose() * (r / length).transpose();
  }
  return jacobian * scale_;
}

double ThinPlateSpline::bending_energy() const {
  // Lengths scale by 1 / scale_, coefficients with respect to unnormalised distances by scale_.
  return -(weights_.transpose() * kernel_matrix(centres_) * weights_).trace() * scale_;
}

ThinPlateSpline::PrincipalWarps ThinPlateSpline::principal_warps(const PointsD& landmarks) {
  check_landmarks(landmarks, landmarks);
  const double diagonal = bounding_box(landmarks).diagonal();
  const PointsD centres =
      (landmarks.rowwise() - landmarks.colwise().mean()) * (diagonal > 0 ? 1 / diagonal : 1);
  check_normalised(centres);
  PrincipalWarps result = warps_of(centres);
  result.energies /= diagonal;
  return result;
}

}  // namespace mien
