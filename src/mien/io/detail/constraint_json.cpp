#include "mien/io/detail/constraint_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

constexpr std::array<const char*, 6> kind_names{"limit",  "parent", "point",
                                                "orient", "scale",  "aim"};  // in Kind's order
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

Json numbers_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// An end that is not there is null.
Json end_json(double end) {
  return std::isfinite(end) ? Json(end) : Json();
}

void read_vector(const JsonObject& source, const char* key, Eigen::Vector3d& vector) {
  const std::vector<double> numbers = source.numbers(key, 3);
  if (!numbers.empty()) vector = Eigen::Map<const Eigen::Vector3d>(numbers.data());
}

Constraint::Kind read_kind(const JsonObject& source) {
  const std::string kind = source.text("kind");
  const auto known = std::find(kind_names.begin(), kind_names.end(), kind);
  if (known == kind_names.end())
    throw io_error(source.place_of("kind"), fmt::format("is \"{}\"", kind.substr(0, 40)),
                   "give limit, parent, point, orient, scale or aim");
  return static_cast<Constraint::Kind>(known - kind_names.begin());
}

std::array<bool, 3> read_axes(const JsonObject& source) {
  const std::string axes = source.text_or("axes", "xyz");
  std::array<bool, 3> obey{};
  for (const char axis : axes) {
    if (axis < 'x' || axis > 'z')
      throw io_error(source.place_of("axes"), fmt::format("is \"{}\"", axes.substr(0, 40)),
                     "give some of x, y and z");
    obey[static_cast<std::size_t>(axis - 'x')] = true;
  }
  return obey;
}

}  // namespace

void write_ranges(const std::array<ValueRange, 3>& ranges, const char* key, Json& json) {
  for (int a = 0; a < 3; ++a)
    if (!(ranges[a] == ValueRange{}))
      json[key][axis_names[a]] = {end_json(ranges[a].low), end_json(ranges[a].high)};
}

void read_ranges(const JsonObject& source, const char* key, std::array<ValueRange, 3>& ranges) {
  if (!source.has(key)) return;
  const JsonObject by_axis = source.object(key);
  by_axis.expect_only({"x", "y", "z"});
  for (int a = 0; a < 3; ++a) {
    if (!by_axis.has(axis_names[a])) continue;
    const Json& range = by_axis.json()[axis_names[a]];
    const auto is_end = [](const Json& end) {
      return end.is_null() || (end.is_number() && std::isfinite(end.get<double>()));
    };
    if (!range.is_array() || range.size() != 2 || !is_end(range[0]) || !is_end(range[1]))
      throw io_error(by_axis.place_of(axis_names[a]), "is no range",
                     "give [low, high]; null where there is no limit");
    if (!range[0].is_null()) ranges[a].low = range[0].get<double>();
    if (!range[1].is_null()) ranges[a].high = range[1].get<double>();
  }
}

Json constraint_json(const Constraint& constraint) {
  const Constraint usual;
  Json json = {{"name", constraint.name},
               {"kind", kind_names[static_cast<std::size_t>(constraint.kind)]},
               {"node", constraint.node}};
  for (const ConstraintSource& source : constraint.sources) {
    Json entry = {{"node", source.node}};
    if (source.share != 1) entry["share"] = source.share;
    json["sources"].push_back(std::move(entry));
  }
  if (constraint.relative != usual.relative) json["relative"] = constraint.relative;
  if (constraint.axes != usual.axes) {
    std::string axes;
    for (int a = 0; a < 3; ++a)
      if (constraint.axes[a]) axes += axis_names[a];
    json["axes"] = axes;
  }
  if (constraint.influence != usual.influence) json["influence"] = constraint.influence;
  write_ranges(constraint.translation, "translation", json);
  write_ranges(constraint.rotation, "rotation", json);
  write_ranges(constraint.scale, "scale", json);
  if (constraint.aim_axis != usual.aim_axis) json["aimAxis"] = numbers_json(constraint.aim_axis);
  if (constraint.up_axis != usual.up_axis) json["upAxis"] = numbers_json(constraint.up_axis);
  if (constraint.up != usual.up) json["up"] = numbers_json(constraint.up);
  if (constraint.up_node >= 0) json["upNode"] = constraint.up_node;
  return json;
}

Constraint read_constraint(const JsonObject& source, const NodeReader& node_of) {
  source.expect_only({"name", "kind", "node", "sources", "relative", "axes", "influence", "translation",
                      "rotation", "scale", "aimAxis", "upAxis", "up", "upNode"});
  Constraint constraint;
  constraint.name = source.text("name");
  constraint.kind = read_kind(source);
  constraint.node = node_of(source, "node");
  for (const JsonObject& entry : source.objects("sources")) {
    entry.expect_only({"node", "share"});
    constraint.sources.push_back({node_of(entry, "node"), entry.number_or("share", 1)});
  }
  constraint.relative = source.truth_or("relative", constraint.relative);
  constraint.axes = read_axes(source);
  constraint.influence = source.number_or("influence", constraint.influence);
  read_ranges(source, "translation", constraint.translation);
  read_ranges(source, "rotation", constraint.rotation);
  read_ranges(source, "scale", constraint.scale);
  read_vector(source, "aimAxis", constraint.aim_axis);
  read_vector(source, "upAxis", constraint.up_axis);
  read_vector(source, "up", constraint.up);
  if (source.has("upNode")) constraint.up_node = node_of(source, "upNode");
  return constraint;
}

}  // namespace mien::detail
