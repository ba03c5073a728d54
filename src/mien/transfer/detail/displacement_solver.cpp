#include "mien/transfer/detail/displacement_solver.h"

#include <omp.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

constexpr double bending_unit = 1e-6;
constexpr double tolerance = 3e-3;
constexpr int most_steps = 30;

/// The turn to use CHOLMOD. Debian's serial OpenBLAS under it has buffers that callers share, so that registrations
/// side by side must take turns. And CHOLMOD asks OpenMP for four threads whatever the machine has; they spin more than
/// they work, and sums must not depend on them: within this scope OpenMP stays on the calling thread.
class CholmodTurn {
 public:
  CholmodTurn() { omp_set_max_active_levels(0); }
  ~CholmodTurn() { omp_set_max_active_levels(levels_); }
  CholmodTurn(const CholmodTurn&) = delete;
  CholmodTurn& operator=(const CholmodTurn&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex shared;
    return shared;
  }
  std::lock_guard<std::mutex> lock_{mutex()};
  int levels_ = omp_get_max_active_levels();
};

/// Adds `value` to an entry that the matrix already has.
void add_to_entry(SparseMatrix& matrix, int row, int column, double value) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, row);
  matrix.valuePtr()[found - matrix.innerIndexPtr()] += value;
}

double mean_weight(const Wish& wish) {
  return wish.across + (wish.along - wish.across) / 3;
}

/// W r of a wish.
Eigen::RowVector3d pull(const Wish& wish, const Eigen::RowVector3d& r) {
  return wish.across * r + (wish.along - wish.across) * r.dot(wish.axis) * wish.axis.transpose();
}

Eigen::RowVector3d gather(const Wish& wish, const PointsD& field) {
  return wish.weights[0] * field.row(wish.vertices[0]) + wish.weights[1] * field.row(wish.vertices[1]) +
         wish.weights[2] * field.row(wish.vertices[2]);
}

void scatter(const Wish& wish, const Eigen::RowVector3d& value, PointsD& field) {
  for (int k = 0; k < 3; ++k) field.row(wish.vertices[k]) += wish.weights[k] * value;
}

double inner(const PointsD& a, const PointsD& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

struct DisplacementSolver::Factor {
  Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> cholesky;
};

DisplacementSolver::DisplacementSolver(const PointsD& rest, const Triangles& triangles)
    : rest_(rest), factor_(std::make_unique<Factor>()) {
  masses_ = vertex_areas(rest, triangles);
  // A vertex without area (a stray or degenerate one) would get infinite stiffness.
  const double mean = masses_.sum() / std::max<double>(1, static_cast<double>(masses_.size()));
  masses_ = masses_.cwiseMax(0.05 * mean);
  masses_ /= masses_.sum();
  const SparseMatrix laplacian = cotangent_laplacian(rest, triangles);
  bending_ = laplacian * masses_.cwiseInverse().asDiagonal() * laplacian;
  bending_.makeCompressed();
  const CholmodTurn turn;
  factor_->cholesky.analyzePattern(bending_);
}

DisplacementSolver::~DisplacementSolver() = default;

PointsD DisplacementSolver::solve(double stiffness, const std::vector<Wish>& wishes,
                                  const PointsD& start) const {
  const double bend = stiffness * bending_unit;
  SparseMatrix scalar = bending_ * bend;
  // Vertices that nothing pulls are held by a thousandth of a mean wish, so that the matrix stays definite.
  double total = 0;
  for (const Wish& wish : wishes) total += mean_weight(wish);
  const double hold = 1e-6 * std::max(total, 1e-6);
  for (Eigen::Index v = 0; v < masses_.size(); ++v)
    add_to_entry(scalar, static_cast<int>(v), static_cast<int>(v), hold * masses_[v]);
  for (const Wish& wish : wishes)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double value = mean_weight(wish) * wish.weights[i] * wish.weights[j];
        if (value != 0) add_to_entry(scalar, wish.vertices[i], wish.vertices[j], value);
      }
  {
    const CholmodTurn turn;
    factor_->cholesky.factorize(scalar);
  }
  if (factor_->cholesky.info() != Eigen::Success)
    throw invalid_input("registration", "the surface's stiffness matrix is singular",
                        "a mesh without degenerate or duplicate triangles");

  const auto apply = [&](const PointsD& u) {
    PointsD result = bend * (bending_ * u);
    for (Eigen::Index v = 0; v < masses_.size(); ++v) result.row(v) += hold * masses_[v] * u.row(v);
    for (const Wish& wish : wishes) scatter(wish, pull(wish, gather(wish, u)), result);
    return result;
  };
  const auto precondition = [&](const PointsD& r) {
    const CholmodTurn turn;
    return PointsD(factor_->cholesky.solve(Eigen::MatrixXd(r)));
  };

  PointsD right = PointsD::Zero(rest_.rows(), 3);
  for (const Wish& wish : wishes)
    scatter(wish, pull(wish, wish.goal.transpose() - gather(wish, rest_)), right);
  PointsD u = start, residual = right - apply(u), z = precondition(residual), direction = z;
  const double limit = tolerance * tolerance * std::max(inner(right, precondition(right)), 1e-300);
  double energy = inner(residual, z);
  for (int step = 0; step < most_steps && energy > limit; ++step) {
    const PointsD image = apply(direction);
    const double length = energy / inner(direction, image);
    u += length * direction;
    residual -= length * image;
    z = precondition(residual);
    const double next = inner(residual, z);
    direction = z + (next / energy) * direction;
    energy = next;
  }
  return u;
}

}  // namespace mien::detail
