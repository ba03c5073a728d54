#include "mien/io/detail/constraint_json.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"

// Constraints in the MIEN_character extension: nodes by their numbers, as everywhere in a glTF.

namespace mien::detail {

void write_constraints(const Character& character, Json& vendor) {
  for (const Constraint& constraint : character.constraints)
    vendor["constraints"].push_back(constraint_json(constraint));
}

void read_constraints(const JsonObject& vendor, Character& character) {
  const NodeReader numbered = [&](const JsonObject& source, const char* key) {
    return source.index(key, character.nodes.size());
  };
  for (const JsonObject& source : vendor.objects("constraints"))
    character.constraints.push_back(read_constraint(source, numbered));
}

}  // namespace mien::detail
