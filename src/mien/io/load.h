#pragma once
/// Any supported file into a Character, a Character into any supported file; the format follows the
/// extension.

#include <filesystem>

#include "mien/character/character.h"

namespace mien {

/// Reads .glb, .gltf or .obj and validates what was read.
///   throws  Error naming the file, the place in it and what would be right
Character load(const std::filesystem::path& path);

struct SaveOptions {
  bool compress = false;  ///< glTF: EXT_meshopt_compression with quantised attributes
};

/// Writes .glb, .gltf or .obj. The file appears whole or not at all.
void save(const Character& character, const std::filesystem::path& path, const SaveOptions& options = {});

}  // namespace mien
