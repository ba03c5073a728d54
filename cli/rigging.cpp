#include "rigging.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

namespace mien::cli {
namespace {

using nlohmann::json;

template <typename Elements>
std::string name_at(const Elements& elements, int index) {
  return index >= 0 && index < static_cast<int>(elements.size()) ? elements[index].name
                                                                 : fmt::format("number {}", index);
}

json describe_ranges(const std::array<ValueRange, 3>& ranges) {
  json result = json::object();
  const auto end = [](double value) { return std::isfinite(value) ? json(value) : json(); };
  for (int a = 0; a < 3; ++a)
    if (!(ranges[a] == ValueRange{}))
      result[std::string(1, "xyz"[a])] = {end(ranges[a].low), end(ranges[a].high)};
  return result;
}

std::string ranges_text(const json& constraint, const char* key) {
  std::string text;
  for (const auto& [axis, range] : constraint[key].items()) {
    const auto end = [](const json& value, const char* none) {
      return value.is_null() ? std::string(none) : fmt::format("{:g}", value.get<double>());
    };
    text += fmt::format(", {} {} [{}, {}]", key, axis, end(range[0], "-"), end(range[1], "-"));
  }
  return text;
}

}  // namespace

json describe_constraints(const Character& character) {
  constexpr const char* kinds[] = {"limit", "parent", "point", "orient", "scale", "aim"};
  json result = json::array();
  for (const Constraint& constraint : character.constraints) {
    json entry = {{"name", constraint.name},
                  {"kind", kinds[static_cast<int>(constraint.kind)]},
                  {"node", name_at(character.nodes, constraint.node)},
                  {"sources", json::array()},
                  {"relative", constraint.relative},
                  {"influence", constraint.influence},
                  {"translation", describe_ranges(constraint.translation)},
                  {"rotation", describe_ranges(constraint.rotation)},
                  {"scale", describe_ranges(constraint.scale)}};
    for (const ConstraintSource& source : constraint.sources)
      entry["sources"].push_back({{"node", name_at(character.nodes, source.node)}, {"share", source.share}});
    result.push_back(std::move(entry));
  }
  return result;
}

json describe_controls(const Character& character) {
  constexpr const char* kinds[] = {"slider", "pad", "joint"};
  json result = json::array();
  for (const Control& control : character.controls) {
    json entry = {{"name", control.name},
                  {"region", control.region},
                  {"kind", kinds[static_cast<int>(control.kind)]},
                  {"sliders", json::array()}};
    for (const int slider : control.sliders)
      entry["sliders"].push_back(slider < 0 ? json() : json(name_at(character.sliders, slider)));
    if (control.kind == Control::Kind::joint) entry["node"] = name_at(character.nodes, control.node);
    if (control.mirror >= 0) entry["mirror"] = name_at(character.controls, control.mirror);
    result.push_back(std::move(entry));
  }
  return result;
}

std::string constraint_rows(const json& constraints) {
  std::string text;
  for (const json& constraint : constraints) {
    std::string sources;
    for (const json& source : constraint["sources"])
      sources += (sources.empty() ? " to " : ", ") + source["node"].get<std::string>();
    text += fmt::format("  constraint {}: {} {}{}{}{}{}", constraint["name"].get<std::string>(),
                        constraint["kind"].get<std::string>(), constraint["node"].get<std::string>(), sources,
                        ranges_text(constraint, "translation"), ranges_text(constraint, "rotation"),
                        ranges_text(constraint, "scale"));
    if (!constraint["relative"].get<bool>()) text += ", absolute";
    if (constraint["influence"] != 1)
      text += fmt::format(", influence {:g}", constraint["influence"].get<double>());
    text += "\n";
  }
  return text;
}

std::string control_rows(const json& controls) {
  if (controls.empty()) return {};
  std::vector<std::pair<std::string, std::string>> regions;  // in the order of their first control
  for (const json& control : controls) {
    const std::string region = control["region"];
    std::size_t r = 0;
    while (r < regions.size() && regions[r].first != region) ++r;
    if (r == regions.size()) regions.emplace_back(region, "");
    regions[r].second += (regions[r].second.empty() ? "" : ", ") + control["name"].get<std::string>();
  }
  std::string text = fmt::format("  controls   {}\n", controls.size());
  for (const auto& [region, names] : regions) text += fmt::format("    {}: {}\n", region, names);
  return text;
}

}  // namespace mien::cli
