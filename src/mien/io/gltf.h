#pragma once
/// glTF 2.0, binary (.glb) and text (.gltf). docs/io.md says what is kept and what the MIEN_character
/// extension holds.

#include <filesystem>

#include "mien/character/character.h"
#include "mien/io/load.h"

namespace mien {

/// Reads sparse, normalised and quantised accessors, EXT_meshopt_compression, data: URIs and files beside a
/// .gltf. A mesh's triangle primitives become one Part's face groups; its points and lines are left out.
///   throws  io: naming the place in the file; nothing outside the glTF's folder is ever read
///   cost    linear; memory is bounded by about a hundred times the file, whatever its counts claim
Character read_gltf(const std::filesystem::path& path);

/// Writes with the extension of `path`; a .gltf gets its buffer beside it as NAME.bin.
///   throws  invalid_input: what `validate` finds; io: cannot be written
void write_gltf(const Character& character, const std::filesystem::path& path,
                const SaveOptions& options = {});

}  // namespace mien
