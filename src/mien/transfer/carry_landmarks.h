#pragma once
/// Landmarks where no finding is needed: on a face whose every place is known to be a place of the other.

#include <optional>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct CarriedLandmarks {
  std::vector<Landmark> landmarks;
  std::vector<LandmarkCurve> curves;
};

/// Landmarks and curves of `source` on `target`, where the two are one surface in one place (twin.h; or nearly: what a few turns
/// and moves bring there), or where the piece that holds the source's landmarks shares its UV layout with a piece of the
/// target (shared_uvs.h) and `by_uvs` allows it; nothing otherwise. No landmarks on the target are needed. What lies where the
/// surfaces differ, or the target's layout has nothing, is left out.
///   throws  what `landmark_points` refuses
///   cost    some closest points a vertex
std::optional<CarriedLandmarks> carry_landmarks(const Character& source, const Character& target,
                                                bool by_uvs = true);

}  // namespace mien
