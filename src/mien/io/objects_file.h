#pragma once
/// The objects file: {"objects": {NAME: {"kind": "curve", "points": [POINT, ...], "controls": 7, "range": 0.02}}}.

#include <filesystem>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/object_sketch.h"

namespace mien {

/// docs/io.md has the members of each kind. Meshes come from an OBJ beside the file.
///   returns  by name, ascending
///   throws   Error naming the file and the object: not JSON, no objects, an unknown kind or member, descriptors that do not fit
///            their control points, knots that descend, a node, part, landmark, vertex or face that `character` does not have, an OBJ
///            that cannot be read
std::vector<ObjectSketch> read_objects(const std::filesystem::path& path, const Character& character);

}  // namespace mien
