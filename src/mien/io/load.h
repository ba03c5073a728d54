#pragma once
/// Any supported file into a Character, a Character into any supported file; the format follows the extension.

#include <filesystem>

#include "mien/character/character.h"

namespace mien {

struct LoadOptions {
  bool validate = true;  ///< false: a file that parses is returned with whatever `validate` would find in it
};

/// Reads .glb, .gltf or .obj and validates what was read.
///   throws  Error naming the file, the place in it and what would be right
Character load(const std::filesystem::path& path, const LoadOptions& options = {});

struct SaveOptions {
  bool compress =
      false;  ///< glTF: EXT_meshopt_compression, positions and deltas within 1e-5 of the part's box
};

/// Writes .glb, .gltf or .obj. The file appears whole or not at all.
void save(const Character& character, const std::filesystem::path& path, const SaveOptions& options = {});

}  // namespace mien
