#include <Eigen/LU>
#include <cmath>

#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/pose/solve_pins.h"

namespace mien {

SliderPrior learn_prior(const Character& character, const std::vector<Clip>& clips, double fps) {
  if (clips.empty()) throw invalid_input("clips", "are none", "one or more to learn from");
  if (!(fps > 0) || !std::isfinite(fps)) throw invalid_input("frames a second", "are not above 0", "30, say");
  const auto count = static_cast<Eigen::Index>(character.sliders.size());
  std::vector<Eigen::VectorXd> frames;
  for (const Clip& clip : clips)
    for (int f = 0; f / fps <= clip.duration(); ++f)
      frames.push_back(sample_rig(character, clip, f / fps).sliders.values);
  SliderPrior prior{Eigen::VectorXd::Zero(count), {}};
  for (const Eigen::VectorXd& frame : frames) prior.mean += frame / static_cast<double>(frames.size());
  constexpr double unseen = 0.05;
  Eigen::MatrixXd covariance = unseen * unseen * Eigen::MatrixXd::Identity(count, count);
  for (const Eigen::VectorXd& frame : frames)
    covariance +=
        (frame - prior.mean) * (frame - prior.mean).transpose() / static_cast<double>(frames.size());
  const double typical = count > 0 ? covariance.trace() / static_cast<double>(count) : 1;
  prior.precision = typical * covariance.inverse();
  prior.precision = (prior.precision + prior.precision.transpose()).eval() / 2;
  return prior;
}

}  // namespace mien
