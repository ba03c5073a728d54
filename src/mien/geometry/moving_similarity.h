#pragma once
/// A map of space that is close to a similarity everywhere: what carries joints, which lie inside the head or beyond the
/// end of its neck, where a spline through surface points is free to do anything.

#include <Eigen/Core>

#include "mien/geometry/mesh.h"
#include "mien/geometry/similarity.h"

namespace mien {

/// Moving least squares: at x the similarity that brings `from` to `to` with weights
///   w_i (1 / (|x - from_i|^2 + softness^2)^2 + 1 / (60 softness)^4)
/// (Schaefer et al. 2006, in space; the second term is ours: what lies far from all points goes with all of them, not with
/// those that happen to be nearest). Commutes with similarities of either side; reproduces them exactly.
class MovingSimilarity {
 public:
  ///   from, to  #P x 3, three or more points not on a line; softness in their units, above 0
  ///   weights   #P, above 0: areas, where points are a surface's vertices; empty: alike
  ///   throws    invalid_input: what fit_similarity refuses
  MovingSimilarity(PointsD from, PointsD to, double softness, Eigen::VectorXd weights = {});

  /// The similarity at x. Cost: O(#P).
  Similarity at(const Eigen::Vector3d& x) const;
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return at(x)(x); }

 private:
  PointsD from_, to_;
  double softness_;
  Eigen::ArrayXd weights_;
};

}  // namespace mien
