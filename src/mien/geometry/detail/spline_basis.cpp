#include "mien/geometry/detail/spline_basis.h"

#include <algorithm>
#include <cmath>

namespace mien::detail {
namespace {

constexpr int most_degree = 16;

}  // namespace

std::string fault_of_knots(const std::string& points, const std::string& along, int degree, int count,
                           const std::vector<double>& knots) {
  if (degree < 1 || degree > most_degree)
    return "has degree " + std::to_string(degree) + along + ", from 1 to " + std::to_string(most_degree);
  if (count <= degree)
    return "has " + std::to_string(count) + " " + points + along + ", more than its degree " +
           std::to_string(degree);
  if (knots.size() != static_cast<std::size_t>(count) + static_cast<std::size_t>(degree) + 1)
    return "has " + std::to_string(knots.size()) + " knots" + along + ", " +
           std::to_string(count + degree + 1) + " are needed";
  for (std::size_t k = 0; k < knots.size(); ++k)
    if (!std::isfinite(knots[k]) || (k > 0 && knots[k] < knots[k - 1]))
      return "has knots" + along + " that descend or are not finite";
  if (!(knots[static_cast<std::size_t>(degree)] < knots[static_cast<std::size_t>(count)]))
    return "has knots" + along + " without a domain";
  return {};
}

std::string fault_of_weights(const std::string& points, std::size_t count,
                             const std::vector<double>& weights) {
  if (!weights.empty() && weights.size() != count)
    return "has " + std::to_string(weights.size()) + " weights, there are " + std::to_string(count) + " " +
           points;
  for (const double weight : weights)
    if (!std::isfinite(weight) || !(weight > 0)) return "has a weight that is not above 0";
  return {};
}

std::vector<double> clamped_knots(int count, int degree) {
  std::vector<double> knots;
  for (int k = 0; k <= count + degree; ++k)
    knots.push_back(std::clamp(static_cast<double>(k - degree) / (count - degree), 0.0, 1.0));
  return knots;
}

Eigen::VectorXd spline_basis(int degree, int count, const std::vector<double>& knots, double u) {
  const auto knot = [&](int k) { return knots[static_cast<std::size_t>(k)]; };
  u = std::clamp(u, knot(degree), knot(count));
  int span =
      static_cast<int>(std::upper_bound(knots.begin() + degree, knots.begin() + count, u) - knots.begin()) -
      1;
  span = std::clamp(span, degree, count - 1);
  while (span > degree && knot(span) == knot(span + 1)) --span;
  std::vector<double> values(static_cast<std::size_t>(degree) + 1, 0.0);
  values[0] = 1;
  for (int d = 1; d <= degree; ++d) {
    double carried = 0;
    for (int r = 0; r < d; ++r) {
      const double left = u - knot(span + 1 - d + r), right = knot(span + 1 + r) - u;
      const double share = values[static_cast<std::size_t>(r)] / (right + left);
      values[static_cast<std::size_t>(r)] = carried + right * share;
      carried = left * share;
    }
    values[static_cast<std::size_t>(d)] = carried;
  }
  Eigen::VectorXd basis = Eigen::VectorXd::Zero(count);
  for (int d = 0; d <= degree; ++d) basis[span - degree + d] = values[static_cast<std::size_t>(d)];
  return basis;
}

Eigen::VectorXd spline_basis_slope(int degree, int count, const std::vector<double>& knots, double u) {
  // The basis of one degree less lives on the same knots without the outermost ones.
  const std::vector<double> inner(knots.begin() + 1, knots.end() - 1);
  const Eigen::VectorXd lower = spline_basis(degree - 1, count - 1, inner, u);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
  for (int i = 0; i + 1 < count; ++i) {
    const double length =
        knots[static_cast<std::size_t>(i + degree + 1)] - knots[static_cast<std::size_t>(i) + 1];
    if (!(length > 0)) continue;
    slope[i] -= degree * lower[i] / length;
    slope[i + 1] += degree * lower[i] / length;
  }
  return slope;
}

Eigen::VectorXd rational(Eigen::VectorXd basis, const std::vector<double>& weights) {
  if (!weights.empty())
    basis = basis.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(weights.data(), basis.size()));
  return basis / basis.sum();
}

}  // namespace mien::detail
