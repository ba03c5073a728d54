#pragma once
/// The weights file: {"weights": {"jawOpen": 0.4, ...}}, and where wires move besides the shapes "wires": {"lipUpper": {"controls": [[x,
/// y, z], ...], "scale": s - 1, "turns": [[x, y, z], ...]}}, as WireMove says.

#include <filesystem>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// Slider values by name; sliders that the file does not name are 0.
///   throws  Error naming the file: not JSON, another form, a slider that `character` does not have (with the name
///           most like it), a number that is not finite
SliderValues read_weights(const std::filesystem::path& path, const Character& character);

/// What the file's "wires" do, ascending by wire; none without them.
///   throws  as read_weights; a wire that `character` does not have, rows of another number than its control points or turns
std::vector<WireMove> read_wire_moves(const std::filesystem::path& path, const Character& character);

/// Writes the values that are not zero, and the moves of wires, several of a wire added up.
///   throws  invalid_input: not one value a slider, one that is not finite; moves that do not fit their wire; io: cannot be written
void write_weights(const SliderValues& sliders, const Character& character, const std::filesystem::path& path,
                   const std::vector<WireMove>& wires = {});

/// Index of a shape, slider or wire that must exist.
///   throws  invalid_input: names the one most like it
int shape_index(const Character& character, std::string_view name);
int slider_index(const Character& character, std::string_view name);
int wire_index(const Character& character, std::string_view name);

}  // namespace mien
