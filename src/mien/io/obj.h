#pragma once
/// Wavefront OBJ in file order: n-gons, UVs per corner, groups.

#include <filesystem>

#include "mien/character/character.h"

namespace mien {

/// Reads one Part, named after the file: vertices in the order of the `v` lines, faces in the order of the
/// `f` lines.
///   uvs      one set: coordinates are the `vt` lines, corners their numbers; without corners when every
///   corner uses
///            the vt of its vertex's number
///   normals  kept when every vertex has one normal throughout, dropped otherwise
///   colors   from `v x y z r g b`
///   groups   a run of faces under one g (or o) and usemtl; names may repeat
/// Lines, points, smoothing groups and free-form surfaces are left out.
///   throws   io: naming the line
///   cost     linear, about 400 MB/s
Character read_obj(const std::filesystem::path& path);

/// Writes all parts, moved to model space, as one OBJ; shapes, skins and clips have no place in it.
///   throws  invalid_input: what `validate` finds; io: cannot be written
void write_obj(const Character& character, const std::filesystem::path& path);

}  // namespace mien
