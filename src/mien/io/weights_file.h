#pragma once
/// The weights file: {"weights": {"jawOpen": 0.4, ...}}.

#include <filesystem>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// Shape weights by name; shapes that the file does not name weigh 0.
///   throws  Error naming the file: not JSON, another form, a shape that `character` does not have (with the name
///           most like it), a number that is not finite
ShapeWeights read_weights(const std::filesystem::path& path, const Character& character);

/// Writes the weights that are not zero.
///   throws  invalid_input: not one weight a shape, one that is not finite; io: cannot be written
void write_weights(const ShapeWeights& weights, const Character& character,
                   const std::filesystem::path& path);

/// Index of a shape that must exist.
///   throws  invalid_input: names the shape most like it
int shape_index(const Character& character, std::string_view name);

}  // namespace mien
