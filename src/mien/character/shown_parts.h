#pragma once
/// The parts that the scene shows; files also hold meshes that no node shows, which are only carried.

#include <cstddef>

#include "mien/character/character.h"

namespace mien {

/// How many parts are shown. They are the first ones: parts that are not shown come last (`validate`).
std::size_t shown_part_count(const Character& character);

/// The character without the parts that are not shown and without what refers to them: displacements, points, bindings and
/// channels. Numbers of the other parts, and of everything else, stay. A curve of fewer than two points left goes.
///   cost  a copy of the character
Character only_shown(const Character& character);

}  // namespace mien
