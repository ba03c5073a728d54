#pragma once
/// Skin weights between a file's sets of four and the character's lists.

#include <cstdint>
#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

/// One vertex's influences, strongest first, one entry a joint, no zeros; the weights sum to one within
/// rounding. No influence at all becomes joint 0 with weight 1.
struct Influence {
  int joint;
  float weight;
};
void tidy_influences(std::vector<Influence>& influences);

/// Appends a vertex.
void append_influences(SkinWeights& skin, const std::vector<Influence>& influences);

}  // namespace mien::detail
