#include "mien/pose/detail/dense_box_qp.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

namespace mien::detail {
namespace {

/// The free variables' minimum, the others as in x.
Eigen::VectorXd minimum_over(const std::vector<Eigen::Index>& free, const Eigen::MatrixXd& h,
                             const Eigen::VectorXd& gradient, const Eigen::VectorXd& x) {
  const Eigen::MatrixXd block = h(free, free);
  const Eigen::VectorXd move = block.llt().solve(-gradient(free));
  Eigen::VectorXd target = x;
  for (std::size_t i = 0; i < free.size(); ++i) target[free[i]] += move[static_cast<Eigen::Index>(i)];
  return target;
}

}  // namespace

bool minimise_in_box(const Eigen::MatrixXd& h, const Eigen::VectorXd& q, const Eigen::VectorXd& low,
                     const Eigen::VectorXd& high, Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  x = x.cwiseMax(low).cwiseMin(high);
  std::vector<char> held(static_cast<std::size_t>(n));
  for (Eigen::Index j = 0; j < n; ++j) held[j] = x[j] <= low[j] || x[j] >= high[j];
  const double tolerance = 1e-12 * (q.cwiseAbs().maxCoeff() + h.diagonal().maxCoeff());
  for (Eigen::Index iteration = 0; iteration < 20 * n + 20; ++iteration) {
    const Eigen::VectorXd gradient = h * x - q;
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0; j < n; ++j)
      if (!held[j]) free.push_back(j);
    Eigen::VectorXd target = x;
    if (!free.empty()) target = minimum_over(free, h, gradient, x);
    double share = 1;
    Eigen::Index first = -1;
    for (const Eigen::Index j : free) {
      const double limit = target[j] < low[j] ? low[j] : target[j] > high[j] ? high[j] : target[j];
      if (limit == target[j]) continue;
      const double until = (limit - x[j]) / (target[j] - x[j]);
      if (until < share) {
        share = until;
        first = j;
      }
    }
    x = (x + share * (target - x)).cwiseMax(low).cwiseMin(high);
    if (first >= 0) {
      held[first] = 1;
      x[first] = target[first] < low[first] ? low[first] : high[first];
      continue;
    }
    const Eigen::VectorXd now = h * x - q;
    Eigen::Index freed = -1;
    double most = tolerance;
    for (Eigen::Index j = 0; j < n; ++j) {
      const bool leaves = held[j] && low[j] < high[j] &&
                          ((x[j] <= low[j] && now[j] < -most) || (x[j] >= high[j] && now[j] > most));
      if (!leaves) continue;
      most = std::abs(now[j]);
      freed = j;
    }
    if (freed < 0) return true;
    held[freed] = 0;
  }
  return false;
}

}  // namespace mien::detail
