#include "mien/controls/detail/check_config.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

std::set<std::string> region_names(const ControlConfig& config) {
  std::set<std::string> names{config.other};
  for (const ControlRegion& region : config.regions) {
    if (region.name.empty()) throw invalid_input("region", "has no name", "give it one");
    if (region.name == config.other || !names.insert(region.name).second)
      throw invalid_input("region " + region.name, "is there twice", "give each its own name");
    if (std::any_of(region.match.begin(), region.match.end(), [](const auto& p) { return p.empty(); }))
      throw invalid_input("region " + region.name, "has an empty pattern", "leave it out");
  }
  return names;
}

void check_ranges(const ControlLimits& limits) {
  const auto check = [&](const ValueRange& range, bool finite) {
    if (!(range.low <= range.high) || (finite && !(std::isfinite(range.low) && std::isfinite(range.high))))
      throw invalid_input("limits " + limits.match, "are no range", "give [low, high] with low <= high");
  };
  if (limits.match.empty()) throw invalid_input("limits", "have no pattern", "say what they hold for");
  if (limits.slider) {
    check(*limits.slider, true);
    if (!(limits.slider->low < limits.slider->high))
      throw invalid_input("limits " + limits.match, "leave a slider no range", "give a low below the high");
  }
  for (const ValueRange& range : limits.rotation) check(range, false);
  for (const ValueRange& range : limits.translation) check(range, false);
}

void check_pads(const ControlConfig& config, const std::set<std::string>& regions) {
  std::set<std::string> names;
  for (const ControlPad& pad : config.pads) {
    if (pad.name.empty()) throw invalid_input("pad", "has no name", "give it one");
    if (!names.insert(pad.name).second)
      throw invalid_input("pad " + pad.name, "is there twice", "give each its own name");
    if (!regions.contains(pad.region))
      throw invalid_input("pad " + pad.name, "names region " + pad.region, "one of the regions");
    if (std::count(pad.match.begin(), pad.match.end(), "") > 2)
      throw invalid_input("pad " + pad.name, "has fewer than two directions", "give two or more patterns");
  }
}

}  // namespace

void check_config(const ControlConfig& config) {
  if (config.other.empty()) throw invalid_input("other", "is empty", "name the region of what fits nowhere");
  const std::set<std::string> regions = region_names(config);
  for (const NameRule& rule : config.names)
    if (rule.match.empty() || rule.is.empty())
      throw invalid_input("names", "has an empty pattern", "give both sides");
  for (const auto& [first, second] : config.mirrors)
    if (first.empty() || second.empty())
      throw invalid_input("mirrors", "has an empty pattern", "give both sides");
  for (const ControlLimits& limits : config.limits) check_ranges(limits);
  check_pads(config, regions);
  std::set<std::string> placed;
  for (const auto& column : config.layout.columns)
    for (const std::string& name : column) {
      if (!regions.contains(name))
        throw invalid_input("layout", "names region " + name, "one of the regions");
      if (!placed.insert(name).second)
        throw invalid_input("layout", "places region " + name + " twice", "place each once");
    }
  if (!(config.layout.width >= 1 && config.layout.width <= 1000) ||
      !(config.layout.rows >= 4 && config.layout.rows <= 1e5))
    throw invalid_input("layout", "has a width or rows out of range",
                        "a width of 1 to 1000, 4 to 100000 rows");
}

}  // namespace mien::detail
