#pragma once
/// The constraints file: relations and limits by the names of nodes, and nodes to follow.

#include <filesystem>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct ConstraintSet {
  std::vector<Node> nodes;  ///< to be added after the character's own; constraints number them so
  std::vector<Constraint> constraints;
};

/// {"nodes": [{"name": NAME, "parent": NAME, "at": [x, y, z]}], "constraints": [{"name": NAME, "kind": "aim", "node": NAME,
/// "sources": [{"node": NAME, "share": 1}], "relative": true, "axes": "xyz", "influence": 1, "translation": {"x": [low, high]},
/// "rotation": {...}, "scale": {...}, "aimAxis": [x, y, z], "upAxis": [x, y, z], "up": [x, y, z], "upNode": NAME}]}. `at` is in
/// model space at rest; angles are radians; null in a range is no limit.
///   throws  Error naming the file and the place: another form, names that the character does not have or has already, numbers
///           that are not finite. `validate` of the character with them says the rest
ConstraintSet read_constraint_set(const std::filesystem::path& path, const Character& character);

}  // namespace mien
