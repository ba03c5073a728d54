#pragma once
/// Which feature each vertex follows when features are blended apart.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

/// Shares that sum to one at every vertex. Where wires reach: f^k / sum f^k over the feature's wires. Pieces without wires move as
/// one and take the mean of the shares of the skin closest to them; skin that no wire reaches belongs to the rest.
class FeatureShares {
 public:
  FeatureShares(const Character& character, const std::vector<std::string>& features);
  /// #V shares of a feature, or of the rest (the number of features).
  const Eigen::VectorXf& of(int part, int feature) const { return shares_[part][feature]; }

 private:
  std::vector<std::vector<Eigen::VectorXf>> shares_;
};

}  // namespace mien::detail
