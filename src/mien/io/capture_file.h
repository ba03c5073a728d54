#pragma once
/// Captures: slider streams and markers as CSV, skeletons as BVH.

#include <filesystem>

#include "mien/character/character.h"
#include "mien/character/take.h"

namespace mien {

enum class CaptureKind { sliders, markers, skeleton };

/// What a capture file holds: .bvh is a skeleton; a CSV whose header has `NAME.x, NAME.y, NAME.z` (or `_`, ` `
/// or `:` in place of the point) holds markers; any other CSV sliders.
///   throws  io: another extension, cannot be read
CaptureKind capture_kind(const std::filesystem::path& path);

/// Live Link Face (`Timecode, BlendShapeCount, EyeBlinkLeft, ...`), or any CSV with one column a slider and, first,
/// `time` or `seconds`, `frame`, or `timecode`. Without such a column frames follow one another at `rate`.
///   rate    frames a second of `frame` columns and of none
///   throws  io naming line and column: no header, a row of another length, a cell that is no number, times that
///           do not ascend, two columns of one name, no rows
///   cost    linear in the file
SliderTake read_slider_csv(const std::filesystem::path& path, double rate = 30);

/// Columns `NAME.x, NAME.y, NAME.z` after an optional time column as above. An empty or NaN cell is a gap.
///   throws  as read_slider_csv; a marker without one of its three columns
MarkerTake read_marker_csv(const std::filesystem::path& path, double rate = 30);

/// A BVH file's joints as nodes, in the file's unit and order, with its motion as the one clip: rotations as
/// linear keys, translations where the file has position channels.
///   throws  io naming the line: not of this form, absurd counts, a number that is not finite
Character read_bvh(const std::filesystem::path& path);

}  // namespace mien
