#pragma once
/// Expressions changed through their wires.

#include <span>
#include <string_view>

#include "mien/character/character.h"

namespace mien {

/// The character with one of its shapes changed by moves: its parts move as the wires carry them, and its wires know it.
///   moves   added to what the wires do in the shape
///   throws  invalid_input: a shape out of range; moves as WireField::add
///   method  Pyun, Shin and Shin 2001, Fig. 3
Character edit_wires(const Character& character, int shape, std::span<const WireMove> moves);

/// The moves of a shape times `factor`, less the moves themselves, of the wires of one feature (all wires: empty). Above 1
/// exaggerates, below 1 attenuates that part of the face; give the result to `edit_wires`.
///   throws  invalid_input: a shape out of range or without wires, a feature that no wire has, a factor that is not finite
std::vector<WireMove> exaggerate_wires(const Character& character, int shape, double factor,
                                       std::string_view feature = {});

/// The features of the character's wires, by first appearance.
std::vector<std::string> wire_features(const Character& character);

}  // namespace mien
