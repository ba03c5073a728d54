#include "mien/transfer/detail/polynomial_fit.h"

#include <Eigen/Cholesky>

namespace mien::detail {
namespace {

constexpr int terms = 10;
using Basis = Eigen::Matrix<double, terms, 1>;

Basis basis(const Eigen::Vector3d& x) {
  Basis phi;
  phi << 1, x[0], x[1], x[2], x[0] * x[0], x[0] * x[1], x[0] * x[2], x[1] * x[1], x[1] * x[2], x[2] * x[2];
  return phi;
}

}  // namespace

PointsD fit_polynomial(const PointsD& rest, const std::vector<Wish>& wishes, double ridge) {
  // Unknown c (3 x terms, column by column of phi): sum over wishes of |W^1/2 (C phi - (goal - x))|^2.
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(3 * terms, 3 * terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * terms);
  double total = 0;
  for (const Wish& wish : wishes) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    Basis phi = Basis::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d corner = rest.row(wish.vertices[k]).transpose();
      x += wish.weights[k] * corner;
      phi += wish.weights[k] * basis(corner);
    }
    const Eigen::Matrix3d pull = wish.across * Eigen::Matrix3d::Identity() +
                                 (wish.along - wish.across) * wish.axis * wish.axis.transpose();
    const Eigen::Vector3d goal = pull * (wish.goal - x);
    for (int i = 0; i < terms; ++i) {
      right.segment<3>(3 * i) += phi[i] * goal;
      for (int j = 0; j < terms; ++j) normal.block<3, 3>(3 * i, 3 * j) += phi[i] * phi[j] * pull;
    }
    total += wish.along + wish.across;
  }
  for (int i = 0; i < 3 * terms; ++i) normal(i, i) += (i < 3 ? 1e-9 : ridge) * total;
  const Eigen::VectorXd solution = normal.ldlt().solve(right);
  const Eigen::Map<const Eigen::Matrix<double, 3, terms>> coefficients(solution.data());
  PointsD u(rest.rows(), 3);
  for (Eigen::Index v = 0; v < rest.rows(); ++v)
    u.row(v) = (coefficients * basis(rest.row(v).transpose())).transpose();
  return u;
}

}  // namespace mien::detail
