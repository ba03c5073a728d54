#pragma once
/// The weights file: {"weights": {"jawOpen": 0.4, ...}}; shapes that it does not name weigh 0.

#include <filesystem>
#include <string>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien::cli {

///   throws  Error naming the file: not JSON, another form, a shape that `character` does not have, a number
///   not finite
ShapeWeights read_weights(const std::filesystem::path& path, const Character& character);

/// Index of a shape that must exist.
///   throws  invalid_input: the nearest names are suggested
int shape_index(const Character& character, const std::string& name);

}  // namespace mien::cli
