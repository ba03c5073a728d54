#pragma once
/// Where the mouth and the eyes are.

#include <optional>
#include <string_view>
#include <vector>

#include "mien/character/character.h"

namespace mien {

enum class Region { mouth, eyes };

/// "mouth" or "eyes".
///   throws  invalid_input: another name
Region region_of_name(std::string_view name);

/// A box around the region in rest, with some room, for RenderOptions::zoom. Found by the names of landmarks,
/// else of shapes (what lip or blink shapes move most), else of parts (teeth, eyes); nothing when no name
/// says it.
///   posed  one #V x 3 a part, model space (`evaluate`)
std::optional<Box> find_region(const Character& character, const std::vector<Points>& posed, Region region);

}  // namespace mien
