#pragma once
/// What influence objects are called, and what is wrong with them.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/validate.h"

namespace mien {

/// "curve", "surface", "lattice", "mesh", "cluster", "locator".
const char* name_of(const InfluenceForm& form);

/// Clusters and locators: they move what is bound to them as a frame, without control points of their own.
bool is_frame(const InfluenceForm& form);

/// What is wrong with a form of this many control points, in words; empty: nothing.
std::string fault_of(const InfluenceForm& form, std::size_t control_count);

/// Everything that breaks what influence_object.h promises, of all objects and of what shapes do to them: as `validate`, which asks
/// this too. Empty: nothing.
///   cost  linear
std::vector<Problem> object_problems(const Character& character);

}  // namespace mien
