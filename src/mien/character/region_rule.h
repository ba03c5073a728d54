#pragma once
/// A modeller's rule for a region of the face. Data only.

#include <limits>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// "Only these sliders may move this region, and by at most so much."
struct RegionRule {
  std::string name;
  std::vector<SurfacePoint> region;
  std::vector<int> sliders;  ///< those that may, indices into Character::sliders
  double at_most =
      std::numeric_limits<double>::infinity();  ///< how far a point may move from rest, the character's unit
};

}  // namespace mien
