#include "mien/io/weights_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "mien/core/error.h"
#include "mien/io/detail/json.h"
#include "mien/io/file.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;

/// How many letters to insert, delete or replace to turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

int shape_index(const Character& character, std::string_view name) {
  const int shape = find_shape(character, name);
  if (shape >= 0) return shape;
  const std::string place = fmt::format("shape {}", name.substr(0, 100));
  if (character.shapes.empty()) throw invalid_input(place, "does not exist", "the character has no shapes");
  const auto nearest = std::min_element(character.shapes.begin(), character.shapes.end(),
                                        [&, start = name.substr(0, 100)](const Shape& a, const Shape& b) {
                                          return edit_distance(start, a.name) < edit_distance(start, b.name);
                                        });
  throw invalid_input(
      place, "does not exist",
      fmt::format("name one of the {} shapes, perhaps {}", character.shapes.size(), nearest->name));
}

ShapeWeights read_weights(const std::filesystem::path& path, const Character& character) {
  try {
    const std::vector<std::uint8_t> bytes = read_file(path);
    const Json json = detail::parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "JSON");
    const JsonObject root(json, "");
    if (!root.has("weights"))
      throw io_error("file", "has no \"weights\"", R"(give {"weights": {NAME: NUMBER}})");
    const JsonObject named = root.object("weights");
    ShapeWeights weights(character.shapes.size());
    for (const auto& [name, value] : named.json().items()) {
      const int shape = shape_index(character, name);
      weights.values[shape] = named.number(name.c_str());
    }
    return weights;
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

void write_weights(const ShapeWeights& weights, const Character& character,
                   const std::filesystem::path& path) {
  if (weights.values.size() != static_cast<Eigen::Index>(character.shapes.size()))
    throw invalid_input("weights", fmt::format("are {}", weights.values.size()),
                        fmt::format("the character has {} shapes", character.shapes.size()));
  Json named = Json::object();
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    const double weight = weights.values[static_cast<Eigen::Index>(s)];
    if (!std::isfinite(weight))
      throw invalid_input("weight of " + character.shapes[s].name, "is not finite", "give a finite number");
    if (weight != 0) named[character.shapes[s].name] = weight;
  }
  write_file_atomically(path, detail::json_text({{"weights", named}}, 1) + "\n");
}

}  // namespace mien
