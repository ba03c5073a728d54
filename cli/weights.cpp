#include "weights.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <vector>

#include "mien/core/error.h"

namespace mien::cli {
namespace {

/// How many letters to insert, delete or replace to turn one word into the other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
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

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || !std::filesystem::is_regular_file(path))
    throw io_error(path.string(), "cannot be read", "a JSON file");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

ShapeWeights parse(const std::string& text, const Character& character) {
  const nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
  const std::string form = "{\"weights\": {NAME: NUMBER, ...}}";
  if (document.is_discarded()) throw io_error("weights", "is not JSON", form);
  if (!document.is_object() || !document.contains("weights") || !document["weights"].is_object())
    throw io_error("weights", "has no object \"weights\"", form);
  ShapeWeights weights(character.shapes.size());
  for (const auto& [name, value] : document["weights"].items()) {
    const int shape = shape_index(character, name);
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      throw io_error("weight of " + name, "is not a number", "a finite number");
    weights.values[shape] = value.get<double>();
  }
  return weights;
}

}  // namespace

int shape_index(const Character& character, const std::string& name) {
  const int shape = find_shape(character, name);
  if (shape >= 0) return shape;
  if (character.shapes.empty())
    throw invalid_input("shape " + name, "does not exist", "the character has no shapes");
  std::size_t best = 0, least = std::string::npos;
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    if (const std::size_t far = edit_distance(name.substr(0, 100), character.shapes[s].name); far < least) {
      least = far;
      best = s;
    }
  throw invalid_input("shape " + name, "does not exist",
                      "one of the " + std::to_string(character.shapes.size()) + " shapes, perhaps " +
                          character.shapes[best].name);
}

ShapeWeights read_weights(const std::filesystem::path& path, const Character& character) {
  try {
    return parse(read_text(path), character);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien::cli
