#include "mien/io/control_config_file.h"

#include <fmt/format.h>

#include "mien/core/error.h"
#include "mien/io/detail/constraint_json.h"
#include "mien/io/detail/json_file.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;
using Side = ControlRegion::Side;

constexpr std::array<const char*, 4> directions{"right", "left", "up",
                                                "down"};  // in ControlPad::match's order

ControlRegion read_region(const JsonObject& source) {
  source.expect_only({"name", "match", "side"});
  ControlRegion region{source.text("name"), source.texts("match"), Side::any};
  const std::string side = source.text_or("side", "");
  if (side == "left" || side == "right")
    region.side = side == "left" ? Side::left : Side::right;
  else if (!side.empty())
    throw io_error(source.place_of("side"), fmt::format("is \"{}\"", side.substr(0, 40)),
                   "give left or right, or leave it out");
  return region;
}

ControlLimits read_limits(const JsonObject& source) {
  source.expect_only({"match", "slider", "rotation", "translation"});
  ControlLimits limits;
  limits.match = source.text("match");
  if (source.has("slider")) {
    const std::vector<double> range = source.numbers("slider", 2);
    limits.slider = ValueRange{range.at(0), range.at(1)};
  }
  detail::read_ranges(source, "rotation", limits.rotation);
  detail::read_ranges(source, "translation", limits.translation);
  return limits;
}

ControlPad read_pad(const JsonObject& source) {
  source.expect_only({"name", "label", "region", "right", "left", "up", "down"});
  ControlPad pad;
  pad.name = source.text("name");
  pad.label = source.text_or("label", "");
  pad.region = source.text("region");
  for (std::size_t d = 0; d < 4; ++d) pad.match[d] = source.text_or(directions[d], "");
  return pad;
}

/// An array of arrays of texts.
std::vector<std::vector<std::string>> read_lists(const JsonObject& source, const char* key) {
  const Json& lists = source.json()[key];
  if (!lists.is_array()) throw io_error(source.place_of(key), "is no array", "give arrays of names");
  std::vector<std::vector<std::string>> result;
  for (std::size_t k = 0; k < lists.size(); ++k) {
    const Json list = {{"names", lists[k]}};
    result.push_back(JsonObject(list, fmt::format("{}[{}]", source.place_of(key), k)).texts("names"));
  }
  return result;
}

void read_mirrors(const JsonObject& root, ControlConfig& config) {
  config.mirrors.clear();
  for (const auto& pair : read_lists(root, "mirrors")) {
    if (pair.size() != 2)
      throw io_error(root.place_of("mirrors"), "holds no pairs", "give [[PATTERN, PATTERN], ...]");
    config.mirrors.emplace_back(pair[0], pair[1]);
  }
}

void read_layout(const JsonObject& layout, ControlConfig& config) {
  layout.expect_only({"columns", "width", "rows"});
  if (layout.has("columns")) config.layout.columns = read_lists(layout, "columns");
  config.layout.width = layout.number_or("width", config.layout.width);
  config.layout.rows = layout.number_or("rows", config.layout.rows);
}

ControlConfig read(const JsonObject& root, ControlConfig config) {
  root.expect_only({"names", "regions", "limits", "mirrors", "pads", "moves", "layout", "other"});
  const auto replace = [&](const char* key, auto& list, const auto& read_one) {
    if (!root.has(key)) return;
    list.clear();
    for (const JsonObject& source : root.objects(key)) list.push_back(read_one(source));
  };
  replace("names", config.names, [](const JsonObject& source) {
    source.expect_only({"match", "is"});
    return NameRule{source.text("match"), source.text("is")};
  });
  replace("regions", config.regions, read_region);
  replace("limits", config.limits, read_limits);
  replace("pads", config.pads, read_pad);
  if (root.has("mirrors")) read_mirrors(root, config);
  if (root.has("moves")) config.moves = root.texts("moves");
  if (root.has("layout")) read_layout(root.object("layout"), config);
  config.other = root.text_or("other", config.other);
  return config;
}

Json region_json(const ControlRegion& region) {
  Json json = {{"name", region.name}, {"match", region.match}};
  if (region.side != Side::any) json["side"] = region.side == Side::left ? "left" : "right";
  return json;
}

Json limits_json(const ControlLimits& limits) {
  Json json = {{"match", limits.match}};
  if (limits.slider) json["slider"] = {limits.slider->low, limits.slider->high};
  detail::write_ranges(limits.rotation, "rotation", json);
  detail::write_ranges(limits.translation, "translation", json);
  return json;
}

Json pad_json(const ControlPad& pad) {
  Json json = {{"name", pad.name}, {"region", pad.region}};
  if (!pad.label.empty()) json["label"] = pad.label;
  for (std::size_t d = 0; d < 4; ++d)
    if (!pad.match[d].empty()) json[directions[d]] = pad.match[d];
  return json;
}

}  // namespace

ControlConfig read_control_config(const std::filesystem::path& path, const ControlConfig& usual) {
  return detail::read_json_file(path, [&](const JsonObject& root) { return read(root, usual); });
}

std::string control_config_text(const ControlConfig& config) {
  Json json = {{"names", Json::array()},   {"regions", Json::array()}, {"limits", Json::array()},
               {"mirrors", Json::array()}, {"pads", Json::array()},    {"moves", config.moves},
               {"other", config.other}};
  for (const NameRule& rule : config.names) json["names"].push_back({{"match", rule.match}, {"is", rule.is}});
  for (const ControlRegion& region : config.regions) json["regions"].push_back(region_json(region));
  for (const ControlLimits& limits : config.limits) json["limits"].push_back(limits_json(limits));
  for (const auto& [first, second] : config.mirrors) json["mirrors"].push_back({first, second});
  for (const ControlPad& pad : config.pads) json["pads"].push_back(pad_json(pad));
  json["layout"] = {
      {"columns", config.layout.columns}, {"width", config.layout.width}, {"rows", config.layout.rows}};
  return detail::json_text(json, 2) + "\n";
}

}  // namespace mien
