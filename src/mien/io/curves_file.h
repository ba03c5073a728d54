#pragma once
/// The curves file: {"curves": {NAME: {"points": [POINT, ...], "controls": 10, "range": 2.5, "feature": "mouth"}}}.

#include <filesystem>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// POINT as in landmark files; "controls", "range", "feature", "turns" and "distance" (geodesic or euclidean) may be left out.
///   returns  by name, ascending
///   throws   Error naming the file and the curve: not JSON, no curves, an unknown member, a part, vertex or face that
///            `character` does not have, fewer than four points or control points, a range that is not above 0, a position
///            further from the surface than a hundredth of the character's box
std::vector<WireSketch> read_curves(const std::filesystem::path& path, const Character& character);

void write_curves(const std::vector<WireSketch>& curves, const Character& character,
                  const std::filesystem::path& path);

}  // namespace mien
