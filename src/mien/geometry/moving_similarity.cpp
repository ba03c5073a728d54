#include "mien/geometry/moving_similarity.h"

#include <cmath>
#include <utility>

namespace mien {
namespace {

/// Distance from a point at which all points together count as much as it does, in softnesses.
constexpr double far = 60;

}  // namespace

MovingSimilarity::MovingSimilarity(PointsD from, PointsD to, double softness, Eigen::VectorXd weights)
    : from_(std::move(from)), to_(std::move(to)), softness_(softness), weights_(weights.array()) {
  if (weights_.size() == 0) weights_.setOnes(from_.rows());
  fit_similarity(from_, to_);  // refuses what cannot be fitted, once
}

Similarity MovingSimilarity::at(const Eigen::Vector3d& x) const {
  const Eigen::ArrayXd squared = (from_.rowwise() - x.transpose()).rowwise().squaredNorm();
  const double all = std::pow(far * softness_, -4);
  return fit_similarity(from_, to_,
                        (weights_ * ((squared + softness_ * softness_).square().inverse() + all)).matrix());
}

}  // namespace mien
