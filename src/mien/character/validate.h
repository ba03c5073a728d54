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
/// that do not ascend, delta vertices that do not ascend, parts that are not shown before parts that are. At
/// most one problem of a kind for each array, the first.
///   cost  linear
std::vector<Problem> validate(const Character& character);

/// The part of it about constraints: nodes out of range, sources where there are none or none where there must be, shares and
/// influences out of range, ranges upside down, axes that are not unit or lie along each other, and nodes that follow
/// themselves through their sources and parents, with the names of the circle.
///   cost  constraints x nodes
std::vector<Problem> constraint_problems(const Character& character);

/// The part of it about controls: sliders and nodes out of range or of the wrong number for the control's kind, mirrors that do
/// not name each other, places that are not finite.
std::vector<Problem> control_problems(const Character& character);

///   throws  invalid_input: the first problem
void require_valid(const Character& character);

}  // namespace mien
