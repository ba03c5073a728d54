#pragma once
/// Numbers as colours.

#include <string_view>

#include "mien/picture/picture.h"

namespace mien {

enum class ColorMap {
  heat,       ///< light grey, yellow, red, dark: errors and weights, where 0 is nothing
  viridis,    ///< dark blue to yellow, evenly bright: any quantity
  cool_warm,  ///< blue, light grey, red: signed quantities around 0
};

/// The colour at `u` in [0, 1] (clamped). Not a number gives grey.
Color map_color(ColorMap map, double u);

/// "heat", "viridis" or "cool-warm".
///   throws  invalid_input: another name
ColorMap color_map_of_name(std::string_view name);

}  // namespace mien
