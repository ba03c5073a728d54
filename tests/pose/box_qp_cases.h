#pragma once
// Random quadratic programs, hard ones among them, and how far an answer is from solving one.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "mien/pose/detail/box_qp.h"

namespace mien::test {

struct BoxQpCase {
  Eigen::MatrixXd b;
  Eigen::VectorXd goal, stiffness, pull, sparse, low, high;
  detail::BoxQp::Sliders sliders() const {
    return {span(stiffness), span(pull), span(sparse), span(low), span(high)};
  }
  static std::span<const double> span(const Eigen::VectorXd& v) {
    return {v.data(), static_cast<std::size_t>(v.size())};
  }
};

/// Few to many sliders, some columns zero, doubled or nearly so, some sliders locked, some starts outside the
/// limits; rho from 1 to 1e-5; goals in reach and far out of it.
inline BoxQpCase random_box_qp(std::mt19937& random, int most_sliders, bool sparse) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  const int sliders = 1 + static_cast<int>(uniform(random) * most_sliders);
  const int rows = 1 + static_cast<int>(uniform(random) * uniform(random) * 40);
  const double unit = std::pow(10.0, -3 + 6 * uniform(random));
  BoxQpCase c;
  c.b = Eigen::MatrixXd::Zero(rows, sliders);
  for (int j = 0; j < sliders; ++j) {
    const double kind = uniform(random);
    if (kind < 0.15) continue;
    if (kind < 0.35 && j > 0) {
      c.b.col(j) = c.b.col(static_cast<int>(uniform(random) * j));
      if (kind < 0.25) c.b.col(j) *= 1 + 1e-9 * normal(random);
      continue;
    }
    const double size = unit * std::pow(10.0, -3 * uniform(random));
    for (int r = 0; r < rows; ++r) c.b(r, j) = size * normal(random);
  }
  const double square = std::max(c.b.squaredNorm(), unit * unit);
  const double alpha = square / 3 * std::pow(10.0, -5 * uniform(random));
  const double mu = uniform(random) < 0.3 ? 0.01 * alpha : 0;
  Eigen::VectorXd start(sliders), wanted(sliders);
  c.stiffness.resize(sliders);
  c.low.resize(sliders);
  c.high.resize(sliders);
  for (int j = 0; j < sliders; ++j) {
    start[j] = uniform(random) < 0.5 ? 0 : uniform(random) * (uniform(random) < 0.1 ? 1.5 : 1);
    wanted[j] = uniform(random) < 0.5 ? start[j] : 2 * normal(random);
    c.stiffness[j] = alpha * (uniform(random) < 0.2 ? std::exp(std::abs(2 * normal(random))) : 1) + mu;
    const double kind = uniform(random);
    c.low[j] = kind < 0.1 ? 0 : kind < 0.2 ? -HUGE_VAL : -0.1 * (kind < 0.4) - start[j];
    c.high[j] = kind < 0.1 ? 0 : 1 - start[j];
  }
  c.pull = -mu * start;
  c.goal = c.b * (wanted - start);
  for (int r = 0; r < rows; ++r) c.goal[r] += unit * 0.1 * normal(random);
  const double most = (c.b.transpose() * c.goal).cwiseAbs().maxCoeff();
  c.sparse = Eigen::VectorXd::Constant(sliders, sparse ? most * 0.5 * uniform(random) : 0.0);
  return c;
}

/// The largest |x - P(x)| over the largest |x| or dead zone (or 1), P taking each slider to where the others want it: zero at the
/// solution alone.
inline double optimality_gap(const BoxQpCase& c, const Eigen::VectorXd& x) {
  const Eigen::VectorXd v = c.pull + c.b.transpose() * (c.goal - c.b * x);
  double worst = 0, size = 1;
  for (int j = 0; j < x.size(); ++j) {
    const double beyond = v[j] - std::clamp(v[j], -c.sparse[j], c.sparse[j]);
    size = std::max({size, std::abs(x[j]), c.sparse[j] / c.stiffness[j]});
    worst = std::max(worst, std::abs(x[j] - std::clamp(beyond / c.stiffness[j], c.low[j], c.high[j])));
  }
  return worst / size;
}

inline Eigen::VectorXd change_of(const detail::BoxQp& solver) {
  const std::span<const double> x = solver.change();
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

}  // namespace mien::test
