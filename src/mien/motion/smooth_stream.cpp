#include <algorithm>
#include <cmath>

#include "mien/motion/retarget_sliders.h"

namespace mien {
namespace {

/// (1 - (t / support)^2)^4 is close to a Gaussian of deviation 1 and ends without a step.
constexpr double support = 3.3;

}  // namespace

Eigen::VectorXd smooth_stream(const Eigen::VectorXd& values, const std::vector<double>& seconds, double reach,
                              double level) {
  if (!(reach > 0)) return values;
  Eigen::VectorXd smooth(values.size());
  Eigen::Index first = 0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double now = seconds[static_cast<std::size_t>(i)];
    while (now - seconds[static_cast<std::size_t>(first)] > support * reach) ++first;
    double sum = 0, total = 0;
    for (Eigen::Index k = first; k < values.size(); ++k) {
      const double apart = (seconds[static_cast<std::size_t>(k)] - now) / (support * reach);
      if (apart >= 1) break;
      const double differs = (values[k] - values[i]) / level;
      const double near = std::max(0.0, 1 - apart * apart);
      const double weight = near * near * near * near * std::exp(-0.5 * differs * differs);
      sum += weight * values[k];
      total += weight;
    }
    smooth[i] = sum / total;
  }
  return smooth;
}

}  // namespace mien
