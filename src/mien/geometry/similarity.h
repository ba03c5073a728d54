#pragma once
/// Rotation, uniform scale and translation between point sets.

#include <Eigen/Core>

#include "mien/geometry/mesh.h"

namespace mien {

/// x -> scale R x + translation; R a proper rotation, scale > 0.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return scale * (rotation * x) + translation; }
  PointsD operator()(const PointsD& points) const;
  /// Displacements: rotated and scaled, not moved.
  PointsD of_vectors(const PointsD& vectors) const { return scale * vectors * rotation.transpose(); }
  Similarity inverse() const;
};

/// The similarity that brings `from` closest to `to` in least squares (Umeyama 1991), both #P x 3.
///   throws  invalid_input: fewer than 3 points, all on one line, sizes that differ
Similarity fit_similarity(const PointsD& from, const PointsD& to);

/// The same with a weight (positive) a pair.
Similarity fit_similarity(const PointsD& from, const PointsD& to, const Eigen::VectorXd& weights);

/// The rotation closest to `m` in the Frobenius norm (the orthogonal factor of its polar decomposition).
Eigen::Matrix3d closest_rotation(const Eigen::Matrix3d& m);

}  // namespace mien
