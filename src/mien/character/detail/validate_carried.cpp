#include "mien/character/detail/validate_carried.h"

#include <cmath>
#include <limits>
#include <unordered_set>

namespace mien::detail {
namespace {

/// The numbers that a stored type holds; none when glTF knows no such type for an attribute.
struct TypeRange {
  float low = 0, high = -1;
  bool whole = true;
};

TypeRange range_of_type(int component_type) {
  switch (component_type) {
    case 5120:
      return {-128, 127};
    case 5121:
      return {0, 255};
    case 5122:
      return {-32768, 32767};
    case 5123:
      return {0, 65535};
    case 5126:
      return {std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max(), false};
    default:
      return {};
  }
}

/// What is wrong with one attribute; an empty text when nothing is.
Problem problem_of(const VertexAttribute& attribute, std::size_t vertices, const std::string& place) {
  const TypeRange range = range_of_type(attribute.component_type);
  if (!attribute.name.starts_with('_')) return {place, "has no underscore before its name", "call it _NAME"};
  if (range.low > range.high)
    return {place, "is stored as type " + std::to_string(attribute.component_type),
            "give 5120, 5121, 5122, 5123 or 5126"};
  if (attribute.width < 1 || attribute.width > 4)
    return {place, "has " + std::to_string(attribute.width) + " numbers a vertex", "give 1 to 4"};
  const std::size_t wanted = vertices * static_cast<std::size_t>(attribute.width);
  if (attribute.values.size() != wanted)
    return {place, "has " + std::to_string(attribute.values.size()) + " values",
            std::to_string(wanted) + " are needed"};
  for (const float value : attribute.values)
    if (!std::isfinite(value) || value < range.low || value > range.high ||
        (range.whole && value != std::floor(value)))
      return {place, "holds " + std::to_string(value), "give numbers that its type can store"};
  return {place, "", ""};
}

Problem problem_of(const LooseElements& loose, std::size_t vertices, std::size_t materials,
                   const std::string& place) {
  if (loose.vertices.empty()) return {place, "name no vertices", "leave them out"};
  if (loose.lines && loose.vertices.size() % 2 != 0)
    return {place, "name " + std::to_string(loose.vertices.size()) + " vertices", "each line has two"};
  if (loose.material < -1 || loose.material >= static_cast<int>(materials))
    return {place, "name material " + std::to_string(loose.material),
            "there are " + std::to_string(materials)};
  for (const int vertex : loose.vertices)
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices)
      return {place, "name vertex " + std::to_string(vertex), "there are " + std::to_string(vertices)};
  return {place, "", ""};
}

}  // namespace

void check_carried(const Mesh& mesh, std::size_t materials, const std::string& place,
                   std::vector<Problem>& problems) {
  const auto add = [&](Problem problem) {
    if (!problem.text.empty()) problems.push_back(std::move(problem));
  };
  std::unordered_set<std::string> names;
  for (const VertexAttribute& attribute : mesh.attributes) {
    const std::string here = place + ": attribute " + attribute.name;
    if (!names.insert(attribute.name).second) add({here, "is there twice", "names are unique"});
    add(problem_of(attribute, mesh.vertex_count(), here));
  }
  for (const LooseElements& loose : mesh.loose)
    add(problem_of(loose, mesh.vertex_count(), materials, place + (loose.lines ? ": lines" : ": points")));
}

}  // namespace mien::detail
