#pragma once
/// What is wrong with a character.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/error.h"

namespace mien {

struct Problem {
  std::string place;   ///< "part Skin: vertex 17"
  std::string text;    ///< what is wrong there
  std::string remedy;  ///< what would be right
  Error error() const { return invalid_input(place, text, remedy); }
};

/// Everything that breaks what character.h promises: numbers that are not finite, indices out of range,
/// arrays of unequal length, skin weights that do not sum to one, nodes that are their own ancestor, keys
/// that do not ascend, rotations that are not unit, shapes, sliders or expressions of one name, stops
/// that do not ascend, delta vertices that do not ascend. At
/// most one problem of a kind for each array, the first.
///   cost  linear
std::vector<Problem> validate(const Character& character);

///   throws  invalid_input: the first problem
void require_valid(const Character& character);

}  // namespace mien
