#pragma once
/// The weights file: {"weights": {"jawOpen": 0.4, ...}}.

#include <filesystem>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// Slider values by name; sliders that the file does not name are 0.
///   throws  Error naming the file: not JSON, another form, a slider that `character` does not have (with the name
///           most like it), a number that is not finite
SliderValues read_weights(const std::filesystem::path& path, const Character& character);

/// Writes the values that are not zero.
///   throws  invalid_input: not one value a slider, one that is not finite; io: cannot be written
void write_weights(const SliderValues& sliders, const Character& character,
                   const std::filesystem::path& path);

/// Index of a shape, or of a slider, that must exist.
///   throws  invalid_input: names the one most like it
int shape_index(const Character& character, std::string_view name);
int slider_index(const Character& character, std::string_view name);

}  // namespace mien
