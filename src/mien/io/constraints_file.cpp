#include "mien/io/constraints_file.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include "mien/core/error.h"
#include "mien/io/detail/constraint_json.h"
#include "mien/io/detail/json_file.h"

namespace mien {
namespace {

using detail::JsonObject;

int node_named(const JsonObject& source, const char* key, const Character& character) {
  const std::string name = source.text(key);
  const int node = find_node(character, name);
  if (node < 0)
    throw io_error(source.place_of(key), fmt::format("names {}", name.substr(0, 100)),
                   "name a node of the character or of \"nodes\"");
  return node;
}

Node read_node(const JsonObject& source, const Character& character) {
  source.expect_only({"name", "parent", "at"});
  Node node;
  node.name = source.text("name");
  if (find_node(character, node.name) >= 0)
    throw io_error(source.place_of("name"),
                   fmt::format("is {}, which is there already", node.name.substr(0, 100)), "give a new name");
  if (source.has("parent")) node.parent = node_named(source, "parent", character);
  const std::vector<double> at = source.numbers("at", 3);
  if (at.empty()) throw io_error(source.place(), "has no \"at\"", "give [x, y, z], where it is at rest");
  Eigen::Vector4d place(at[0], at[1], at[2], 1);
  if (node.parent >= 0) {
    const Eigen::FullPivLU<Eigen::Matrix4d> parent(model_matrices(character)[node.parent]);
    if (!parent.isInvertible())
      throw io_error(source.place_of("parent"), "is flat at rest", "a node whose scales are not 0");
    place = parent.solve(place);
  }
  node.rest.translation = place.head<3>();
  return node;
}

}  // namespace

ConstraintSet read_constraint_set(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const JsonObject& root) {
    root.expect_only({"nodes", "constraints"});
    if (!root.has("constraints"))
      throw io_error("file", "has no \"constraints\"",
                     R"(give {"constraints": [{"name": NAME, "kind": KIND, "node": NAME}]})");
    ConstraintSet set;
    Character known;
    known.nodes = character.nodes;
    for (const JsonObject& source : root.objects("nodes")) {
      set.nodes.push_back(read_node(source, known));
      known.nodes.push_back(set.nodes.back());
    }
    const detail::NodeReader by_name = [&](const JsonObject& source, const char* key) {
      return node_named(source, key, known);
    };
    for (const JsonObject& source : root.objects("constraints"))
      set.constraints.push_back(detail::read_constraint(source, by_name));
    return set;
  });
}

}  // namespace mien
