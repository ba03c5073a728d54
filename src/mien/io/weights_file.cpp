#include "mien/io/weights_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"
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

/// The one of `elements` (shapes, sliders) whose name is most like `name`, as an error.
template <typename Elements>
Error no_such(const char* kind, const Elements& elements, std::string_view name) {
  const std::string_view start = name.substr(0, 100);
  const std::string place = fmt::format("{} {}", kind, start);
  if (elements.empty())
    return invalid_input(place, "does not exist", fmt::format("the character has no {}s", kind));
  const auto nearest = std::min_element(elements.begin(), elements.end(), [&](const auto& a, const auto& b) {
    return edit_distance(start, a.name) < edit_distance(start, b.name);
  });
  return invalid_input(
      place, "does not exist",
      fmt::format("name one of the {} {}s, perhaps {}", elements.size(), kind, nearest->name));
}

}  // namespace

int shape_index(const Character& character, std::string_view name) {
  const int shape = find_shape(character, name);
  if (shape < 0) throw no_such("shape", character.shapes, name);
  return shape;
}

int slider_index(const Character& character, std::string_view name) {
  const int slider = find_slider(character, name);
  if (slider < 0) throw no_such("slider", character.sliders, name);
  return slider;
}

SliderValues read_weights(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    if (!root.has("weights"))
      throw io_error("file", "has no \"weights\"", R"(give {"weights": {NAME: NUMBER}})");
    const JsonObject named = root.object("weights");
    SliderValues sliders(character.sliders.size());
    for (const auto& [name, value] : named.json().items())
      sliders.values[slider_index(character, name)] = named.number(name.c_str());
    return sliders;
  });
}

void write_weights(const SliderValues& sliders, const Character& character,
                   const std::filesystem::path& path) {
  if (sliders.values.size() != static_cast<Eigen::Index>(character.sliders.size()))
    throw invalid_input("weights", fmt::format("are {}", sliders.values.size()),
                        fmt::format("the character has {} sliders", character.sliders.size()));
  Json named = Json::object();
  for (std::size_t s = 0; s < character.sliders.size(); ++s) {
    const double value = sliders.values[static_cast<Eigen::Index>(s)];
    if (!std::isfinite(value))
      throw invalid_input("weight of " + character.sliders[s].name, "is not finite", "give a finite number");
    if (value != 0) named[character.sliders[s].name] = value;
  }
  write_file_atomically(path, detail::json_text({{"weights", named}}, 1) + "\n");
}

}  // namespace mien
