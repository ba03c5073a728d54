#pragma once
/// Landmarks and sampled curves as named points in model space.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct LandmarkPoint {
  std::string name;  ///< the landmark's, or `curve.0` ... for a curve's samples
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< model space, neutral
  SurfacePoint at;  ///< on the surface; for a sample between a curve's points, the nearer of the two
};

/// The character's landmarks in order, without its curves.
std::vector<LandmarkPoint> landmark_points(const Character& character);

/// `count` points evenly by length along the polyline through the curve's points, its two ends included; one point
/// is its middle.
///   throws  invalid_input: fewer than two points, count below 1
std::vector<LandmarkPoint> sample_curve(const Character& character, const LandmarkCurve& curve, int count);

}  // namespace mien
