#pragma once
/// Landmarks of two characters brought together by name.

#include <string>
#include <vector>

#include "mien/character/landmark_points.h"
#include "mien/geometry/mesh.h"

namespace mien {

struct LandmarkPairs {
  std::vector<std::string> names;             ///< #L, in the source's order; curve samples after landmarks
  std::vector<LandmarkPoint> source, target;  ///< #L
  std::vector<std::string> only_source, only_target;  ///< names left out, in their character's order
  PointsD source_positions() const;                   ///< #L x 3, model space
  PointsD target_positions() const;
};

/// Pairs landmarks and curves that both characters name. A curve that both have is sampled on both sides to the
/// source's count.
///   throws  invalid_input, naming landmarks: fewer than 4 pairs, two landmarks of one side at the same place,
///           all of one side in one plane (the spline's affine part is then not determined)
LandmarkPairs pair_landmarks(const Character& source, const Character& target);

}  // namespace mien
