#include "mien/io/pins_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"
#include "mien/io/detail/point.h"
#include "mien/io/weights_file.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;

/// Errors of functions that know no file, with the place that they came from in front.
template <typename Function>
auto at_place(const std::string& place, const Function& function) {
  try {
    return function();
  } catch (const Error& error) {
    throw invalid_input(place, error.what());
  }
}

Eigen::Vector3d vector_of(const JsonObject& source, const char* key) {
  const std::vector<double> numbers = source.numbers(key, 3);
  if (numbers.empty())
    throw io_error(source.place(), fmt::format("has no \"{}\"", key), "give three numbers");
  return Eigen::Map<const Eigen::Vector3d>(numbers.data());
}

HeldAxes read_axes(const JsonObject& source) {
  if (!source.has("axes")) return {};
  const std::string place = source.place_of("axes");
  if (!source.json()["axes"].is_object())
    return at_place(place, [&] { return held_axes(source.text("axes")); });
  const JsonObject axes = source.object("axes");
  axes.expect_only({"plane", "direction"});
  if (axes.has("plane")) return at_place(place, [&] { return held_in_plane(vector_of(axes, "plane")); });
  return at_place(place, [&] { return held_along(vector_of(axes, "direction")); });
}

double face_size(const Character& character) {
  double size = 0;
  for (const Part& part : character.parts)
    size = std::max(size, bounding_box(part.mesh.positions).diagonal());
  return size;
}

/// A position goes to the closest surface point, which is a mistake when it is far off. Skinned parts are looked at in the
/// bind pose, as positions are.
SurfacePoint read_point(const JsonObject& at, const Character& character, detail::PointReader& points) {
  const SurfacePoint point = points.read(at);
  if (!at.has("position")) return point;
  const Part& part = character.parts[point.part];
  Eigen::Vector3d found = position_of(part.mesh, part.mesh.positions, point);
  if (part.skin < 0 && part.node >= 0)
    found = (model_matrices(character)[part.node] * found.homogeneous()).head<3>();
  const double off = (found - vector_of(at, "position")).norm();
  if (off > 0.1 * face_size(character))
    throw io_error(at.place_of("position"), fmt::format("is {:.3g} off the surface", off),
                   "move it onto the face");
  return point;
}

std::vector<int> sliders_named(const JsonObject& source, const char* key, const Character& character) {
  std::vector<int> sliders;
  for (const std::string& name : source.texts(key))
    sliders.push_back(at_place(source.place_of(key), [&] { return slider_index(character, name); }));
  return sliders;
}

int joint_named(const Character& character, const std::string& name, const std::string& place) {
  const int node = find_node(character, name);
  if (node < 0) throw io_error(place, fmt::format("names joint {}", name), "one that the character has");
  return node;
}

Pin read_pin(const JsonObject& source, const Character& character, detail::PointReader& points) {
  source.expect_only({"at", "goal", "move", "axes", "weight", "hard", "sliders"});
  Pin pin;
  if (!source.has("at")) throw io_error(source.place(), "has no \"at\"", R"(give a point, {"vertex": 17})");
  const JsonObject at = source.object("at");
  if (at.has("joint"))
    pin.at = JointPoint{joint_named(character, at.text("joint"), at.place_of("joint"))};
  else
    pin.at = read_point(at, character, points);
  if (source.has("goal") == source.has("move"))
    throw io_error(source.place(), source.has("goal") ? "has both \"goal\" and \"move\"" : "has no \"goal\"",
                   "give one of \"goal\" and \"move\"");
  pin.goal_is_move = source.has("move");
  pin.goal = vector_of(source, pin.goal_is_move ? "move" : "goal");
  pin.axes = read_axes(source);
  pin.weight = source.number_or("weight", 1);
  if (!(pin.weight > 0)) throw io_error(source.place_of("weight"), "is not above 0", "a number above 0");
  pin.hard = source.truth_or("hard", false);
  pin.sliders = sliders_named(source, "sliders", character);
  return pin;
}

NamedJoint read_joint(const JsonObject& source, int node) {
  source.expect_only({"turn", "shift"});
  NamedJoint joint;
  joint.node = node;
  const auto read_range = [&](const char* key, Eigen::Vector3d& low, Eigen::Vector3d& high) {
    if (!source.has(key)) return;
    const Json& range = source.json()[key];
    if (!range.is_array() || range.size() != 2)
      throw io_error(source.place_of(key), "is no range",
                     "give [[x, y, z], [x, y, z]], the lowest and the highest");
    const Json ends = {{"low", range[0]}, {"high", range[1]}};
    const JsonObject named(ends, source.place_of(key));
    low = vector_of(named, "low");
    high = vector_of(named, "high");
    if ((low.array() > high.array()).any())
      throw io_error(source.place_of(key), "is upside down", "the lowest first");
  };
  read_range("turn", joint.turn_low, joint.turn_high);
  read_range("shift", joint.shift_low, joint.shift_high);
  return joint;
}

void read_sliders(const JsonObject& root, const Character& character, PinSet& set) {
  set.locked = sliders_named(root, "locked", character);
  if (root.has("limits")) {
    const JsonObject limits = root.object("limits");
    for (const auto& [name, unused] : limits.json().items()) {
      const std::vector<double> ends = limits.numbers(name.c_str(), 2);
      const int slider = at_place(limits.place(), [&] { return slider_index(character, name); });
      if (ends.size() != 2 || ends[0] > ends[1])
        throw io_error(limits.place_of(name), "is no range", "give [low, high] with low <= high");
      set.limits.push_back({slider, ends[0], ends[1]});
    }
  }
  if (root.has("exclusive")) {
    const Json& groups = root.json()["exclusive"];
    if (!groups.is_array()) throw io_error("exclusive", "is no array", "give [[NAME, ...], ...]");
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const Json group = {{"group", groups[g]}};
      set.exclusive.push_back(
          sliders_named(JsonObject(group, fmt::format("exclusive[{}]", g)), "group", character));
    }
  }
  if (root.has("stiffness")) {
    const JsonObject stiffness = root.object("stiffness");
    set.stiffness.assign(character.sliders.size(), 1.0);
    for (const auto& [name, unused] : stiffness.json().items()) {
      const double value = stiffness.number(name.c_str());
      if (!(value > 0)) throw io_error(stiffness.place_of(name), "is not above 0", "a number above 0");
      set.stiffness[at_place(stiffness.place(), [&] { return slider_index(character, name); })] = value;
    }
  }
}

/// The vertices of the points' parts within `radius` of one of them.
std::vector<SurfacePoint> vertices_near(const Character& character, const std::vector<SurfacePoint>& points,
                                        double radius) {
  std::vector<SurfacePoint> near;
  for (int p = 0; p < static_cast<int>(character.parts.size()); ++p) {
    const Mesh& mesh = character.parts[p].mesh;
    for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
      const Eigen::Vector3d at = mesh.positions.row(v).transpose().cast<double>();
      const bool close = std::any_of(points.begin(), points.end(), [&](const SurfacePoint& point) {
        return point.part == p && (position_of(mesh, mesh.positions, point) - at).norm() <= radius;
      });
      if (!close) continue;
      SurfacePoint vertex;
      vertex.part = p;
      vertex.vertex = static_cast<int>(v);
      near.push_back(vertex);
    }
  }
  return near;
}

}  // namespace

PinSet read_pins(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const JsonObject& root) {
    root.expect_only({"pins", "locked", "limits", "exclusive", "stiffness", "joints", "wires"});
    if (!root.has("pins") || root.json()["pins"].empty())
      throw io_error("file", "has no \"pins\"", R"(give {"pins": [{"at": POINT, "goal": [x, y, z]}]})");
    detail::PointReader points(character);
    PinSet set;
    for (const JsonObject& pin : root.objects("pins")) set.pins.push_back(read_pin(pin, character, points));
    read_sliders(root, character, set);
    if (root.has("joints")) {
      const JsonObject joints = root.object("joints");
      for (const auto& [name, joint] : joints.json().items())
        set.joints.push_back(read_joint(JsonObject(joint, fmt::format("joint {}", name)),
                                        joint_named(character, name, "joints")));
    }
    for (const std::string& name : root.texts("wires"))
      set.wires.push_back(at_place("wires", [&] { return wire_index(character, name); }));
    return set;
  });
}

std::vector<Tag> read_tags(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const JsonObject& root) {
    root.expect_only({"tags"});
    if (!root.has("tags") || root.json()["tags"].empty())
      throw io_error("file", "has no \"tags\"", R"(give {"tags": [{"at": POINT, "axes": "xyz"}]})");
    detail::PointReader points(character);
    std::vector<Tag> tags;
    for (const JsonObject& source : root.objects("tags")) {
      source.expect_only({"at", "axes"});
      if (!source.has("at"))
        throw io_error(source.place(), "has no \"at\"", R"(give a point, {"vertex": 17})");
      tags.push_back({read_point(source.object("at"), character, points), read_axes(source)});
    }
    return tags;
  });
}

std::vector<RegionRule> read_region_rules(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const JsonObject& root) {
    root.expect_only({"rules"});
    if (!root.has("rules") || root.json()["rules"].empty())
      throw io_error("file", "has no \"rules\"",
                     R"(give {"rules": [{"region": [POINT], "sliders": [NAME]}]})");
    detail::PointReader points(character);
    std::vector<RegionRule> rules;
    for (const JsonObject& source : root.objects("rules")) {
      source.expect_only({"name", "region", "radius", "sliders", "at_most"});
      RegionRule rule;
      rule.name = source.text_or("name", fmt::format("{}", rules.size() + 1));
      for (const JsonObject& point : source.objects("region"))
        rule.region.push_back(read_point(point, character, points));
      if (rule.region.empty()) throw io_error(source.place(), "has no \"region\"", "give one or more points");
      const double radius = source.number_or("radius", 0);
      if (radius > 0) rule.region = vertices_near(character, rule.region, radius);
      rule.sliders = sliders_named(source, "sliders", character);
      rule.at_most = source.number_or("at_most", rule.at_most);
      if (!(rule.at_most >= 0)) throw io_error(source.place_of("at_most"), "is negative", "0 or more");
      rules.push_back(rule);
    }
    return rules;
  });
}

}  // namespace mien
