#pragma once
/// A character's shapes and sliders under other names.

#include <string>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/naming/action.h"

namespace mien {

/// Pairs of (old name, new name).
using NamePairs = std::vector<std::pair<std::string, std::string>>;

/// What the convention would call each slider of the character: sliders that do one whole action, or the same one on both
/// sides where the convention has one name for both. Others are left out, as is a name that two sliders would share.
NamePairs names_for(const Character& character, Convention convention);

/// The character with these sliders, and the shapes of the same names, called otherwise. Nothing else changes.
///   throws  invalid_input: an old name that is neither a slider nor a shape, a new name that two would have
///   cost    linear
Character rename(const Character& character, const NamePairs& names);

/// The character with these nodes called otherwise. Nothing else changes.
///   throws  invalid_input: an old name that no node has, a new name that another node has
///   cost    nodes x pairs
Character rename_joints(const Character& character, const NamePairs& names);

}  // namespace mien
