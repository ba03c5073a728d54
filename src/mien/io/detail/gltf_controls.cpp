#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"

// The control interface in the MIEN_character extension: sliders and mirrors by name, nodes by number.

namespace mien::detail {
namespace {

constexpr std::array<const char*, 3> kind_names{"slider", "pad", "joint"};  // in Control::Kind's order

Json control_json(const Character& character, const Control& control) {
  Json json = {{"name", control.name},
               {"region", control.region},
               {"kind", kind_names[static_cast<std::size_t>(control.kind)]},
               {"position", {control.position.x(), control.position.y()}},
               {"size", {control.size.x(), control.size.y()}}};
  if (!control.label.empty()) json["label"] = control.label;
  for (const int slider : control.sliders)
    json["sliders"].push_back(slider < 0 ? Json() : Json(character.sliders[slider].name));
  if (control.node >= 0) json["node"] = control.node;
  if (control.moves) json["moves"] = true;
  if (control.mirror >= 0) json["mirror"] = character.controls[control.mirror].name;
  return json;
}

Eigen::Vector2d pair_of(const JsonObject& source, const char* key) {
  const std::vector<double> numbers = source.numbers(key, 2);
  if (numbers.empty()) throw io_error(source.place(), fmt::format("has no \"{}\"", key), "give two numbers");
  return {numbers[0], numbers[1]};
}

int slider_of(const Json& entry, const std::string& place, const Character& character) {
  if (entry.is_null()) return -1;
  const int slider = entry.is_string() ? find_slider(character, entry.get<std::string>()) : -1;
  if (slider < 0) throw io_error(place, "names no slider", "give the name of one, or null in a pad");
  return slider;
}

Control read_control(const JsonObject& source, const Character& character) {
  Control control;
  control.name = source.text("name");
  control.label = source.text_or("label", "");
  control.region = source.text_or("region", "");
  const std::string kind = source.text("kind");
  const auto known = std::find(kind_names.begin(), kind_names.end(), kind);
  if (known == kind_names.end())
    throw io_error(source.place_of("kind"), fmt::format("is \"{}\"", kind.substr(0, 40)),
                   "give slider, pad or joint");
  control.kind = static_cast<Control::Kind>(known - kind_names.begin());
  if (source.has("sliders")) {
    const Json& sliders = source.json()["sliders"];
    if (!sliders.is_array())
      throw io_error(source.place_of("sliders"), "is no array", "give the sliders' names");
    for (const Json& entry : sliders)
      control.sliders.push_back(slider_of(entry, source.place_of("sliders"), character));
  }
  control.node = source.index_or_none("node", character.nodes.size());
  control.moves = source.truth_or("moves", false);
  control.position = pair_of(source, "position");
  control.size = pair_of(source, "size");
  return control;
}

}  // namespace

void write_controls(const Character& character, Json& vendor) {
  for (const Control& control : character.controls)
    vendor["controls"].push_back(control_json(character, control));
}

void read_controls(const JsonObject& vendor, Character& character) {
  const std::vector<JsonObject> sources = vendor.objects("controls");
  for (const JsonObject& source : sources) character.controls.push_back(read_control(source, character));
  for (std::size_t c = 0; c < sources.size(); ++c) {
    if (!sources[c].has("mirror")) continue;
    const std::string name = sources[c].text("mirror");
    const auto found = std::find_if(character.controls.begin(), character.controls.end(),
                                    [&](const Control& control) { return control.name == name; });
    if (found == character.controls.end())
      throw io_error(sources[c].place_of("mirror"), fmt::format("names {}", name.substr(0, 100)),
                     "name one of the controls");
    character.controls[c].mirror = static_cast<int>(found - character.controls.begin());
  }
}

}  // namespace mien::detail
