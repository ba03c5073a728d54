#include "mien/io/objects_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "mien/character/object_problems.h"
#include "mien/core/error.h"
#include "mien/geometry/nurbs_query.h"
#include "mien/io/detail/json_file.h"
#include "mien/io/detail/point.h"
#include "mien/io/obj.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;

constexpr int most_controls = 100000;
/// Control points of a curve that says neither how many nor which.
constexpr int usual_controls = 7;

class ObjectReader {
 public:
  ObjectReader(const Character& character, std::filesystem::path folder)
      : character_(character), folder_(std::move(folder)), points_(character) {}

  ObjectSketch read(const std::string& name, const JsonObject& source) {
    ObjectSketch sketch;
    sketch.object.name = name;
    const std::string kind = source.text("kind");
    if (kind == "curve")
      read_curve(source, sketch);
    else if (kind == "surface")
      read_surface(source, sketch);
    else if (kind == "lattice")
      read_lattice(source, sketch);
    else if (kind == "mesh")
      read_mesh(source, sketch);
    else if (kind == "cluster" || kind == "locator")
      read_frame(source, kind == "cluster" ? InfluenceForm(Cluster{}) : InfluenceForm(Locator{}), sketch);
    else
      throw io_error(source.place_of("kind"), fmt::format("is \"{}\"", kind.substr(0, 40)),
                     "give curve, surface, lattice, mesh, cluster or locator");
    const auto given = static_cast<std::size_t>(sketch.object.controls.rows());
    const std::size_t wanted = given > 0 ? given : control_count(sketch.object.form);
    if (const std::string fault = fault_of(sketch.object.form, wanted); !fault.empty())
      throw io_error(source.place(), fault, fmt::format("give a {} that fits its control points", kind));
    read_joints(source, sketch);
    read_reach(source, sketch.reach);
    return sketch;
  }

 private:
  void expect_only(const JsonObject& source, std::vector<std::string> own) {
    for (const char* key : {"kind", "carrier", "node", "joints", "strength", "parts", "weights_on"})
      own.emplace_back(key);
    for (const auto& [key, value] : source.json().items())
      if (std::find(own.begin(), own.end(), key) == own.end())
        throw io_error(source.place_of(key), "is not a member of this kind",
                       fmt::format("give {}", fmt::join(own, ", ")));
  }
  static std::size_t control_count(const InfluenceForm& form) {
    if (const auto* curve = std::get_if<NurbsCurve>(&form))
      return static_cast<std::size_t>(std::max(curve->control_count(), 0));
    if (const auto* surface = std::get_if<NurbsSurface>(&form))
      return static_cast<std::size_t>(surface->count_u) * static_cast<std::size_t>(surface->count_v);
    return 1;
  }
  template <std::size_t N>
  std::array<int, N> counts(const JsonObject& source, const char* key, std::array<int, N> fallback) {
    if (!source.has(key)) return fallback;
    const std::vector<double> read = source.numbers(key, N);
    std::array<int, N> numbers{};
    for (std::size_t k = 0; k < N; ++k) {
      if (!(read[k] >= 1 && read[k] <= most_controls) || read[k] != static_cast<int>(read[k]))
        throw io_error(source.place_of(key), fmt::format("holds {}", read[k]),
                       fmt::format("give whole numbers from 1 to {}", most_controls));
      numbers[k] = static_cast<int>(read[k]);
    }
    return numbers;
  }
  /// Rows of three numbers.
  PointsD rows(const JsonObject& source, const char* key) {
    PointsD result(0, 3);
    if (!source.has(key)) return result;
    const Json& json = source.json().at(key);
    const auto fail = [&] {
      return io_error(source.place_of(key), "holds something else than points", "give [x, y, z] each");
    };
    if (!json.is_array()) throw fail();
    result.resize(static_cast<Eigen::Index>(json.size()), 3);
    for (std::size_t r = 0; r < json.size(); ++r)
      for (std::size_t k = 0; k < 3; ++k) {
        if (!json[r].is_array() || json[r].size() != 3 || !json[r][k].is_number()) throw fail();
        result(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(k)) = json[r][k].get<double>();
      }
    return result;
  }
  SurfacePoint read_point(const JsonObject& source) {
    if (!source.has("landmark")) return points_.read(source);
    const std::string name = source.text("landmark");
    const auto found = std::find_if(character_.landmarks.begin(), character_.landmarks.end(),
                                    [&](const Landmark& landmark) { return landmark.name == name; });
    if (found == character_.landmarks.end())
      throw io_error(source.place_of("landmark"), fmt::format("is \"{}\"", name.substr(0, 100)),
                     "name a landmark of the character");
    return found->at;
  }
  static std::vector<double> knots_of(const JsonObject& source, const char* key, int count, int degree) {
    if (source.has(key)) return source.numbers(key);
    if (count <= degree)
      throw io_error(source.place_of("count"), fmt::format("holds {}", count),
                     fmt::format("give more than the degree, {}", degree));
    return clamped_knots(count, degree);
  }
  int read_node(const JsonObject& source, const char* key) {
    return source.has(key) ? node_named(source.text(key), source.place_of(key)) : -1;
  }
  int node_named(const std::string& name, const std::string& place) {
    const int node = find_node(character_, name);
    if (node < 0)
      throw io_error(place, fmt::format("names node {}", name.substr(0, 100)), "name one of the character's");
    return node;
  }
  void read_points(const JsonObject& source, ObjectSketch& sketch) {
    sketch.object.controls = rows(source, "controls");
    for (const JsonObject& point : source.objects("points")) sketch.through.push_back(read_point(point));
    if (sketch.through.empty() == (sketch.object.controls.rows() == 0))
      throw io_error(source.place(), sketch.through.empty() ? "has no points" : "has two kinds of points",
                     R"(give "controls": [[x, y, z], ...] or "points": [POINT, ...])");
  }
  void read_curve(const JsonObject& source, ObjectSketch& sketch);
  void read_surface(const JsonObject& source, ObjectSketch& sketch);
  void read_lattice(const JsonObject& source, ObjectSketch& sketch);
  void read_mesh(const JsonObject& source, ObjectSketch& sketch);
  void read_frame(const JsonObject& source, InfluenceForm form, ObjectSketch& sketch);
  void read_joints(const JsonObject& source, ObjectSketch& sketch);
  void read_reach(const JsonObject& source, InfluenceReach& reach);
  void read_drawn(const JsonObject& source, InfluenceReach& reach);

  const Character& character_;
  std::filesystem::path folder_;
  detail::PointReader points_;
};

void ObjectReader::read_curve(const JsonObject& source, ObjectSketch& sketch) {
  expect_only(source,
              {"degree", "count", "knots", "weights", "controls", "points", "range", "full", "distance"});
  read_points(source, sketch);
  NurbsCurve curve;
  curve.degree = static_cast<int>(source.integer_or("degree", 3, 1, 16));
  const auto given = static_cast<int>(sketch.object.controls.rows());
  const int count =
      static_cast<int>(source.integer_or("count", given > 0 ? given : usual_controls, 2, most_controls));
  curve.knots = knots_of(source, "knots", count, curve.degree);
  curve.weights = source.numbers("weights");
  sketch.object.form = curve;
}

void ObjectReader::read_surface(const JsonObject& source, ObjectSketch& sketch) {
  expect_only(source, {"degree", "count", "knots_u", "knots_v", "weights", "controls", "points", "range",
                       "full", "distance"});
  read_points(source, sketch);
  if (!source.has("count"))
    throw io_error(source.place(), "has no \"count\"", "give control vertices along u and v");
  NurbsSurface surface;
  const auto count = counts<2>(source, "count", {0, 0}), degree = counts<2>(source, "degree", {3, 3});
  surface.count_u = count[0];
  surface.count_v = count[1];
  surface.degree_u = degree[0];
  surface.degree_v = degree[1];
  surface.knots_u = knots_of(source, "knots_u", surface.count_u, surface.degree_u);
  surface.knots_v = knots_of(source, "knots_v", surface.count_v, surface.degree_v);
  surface.weights = source.numbers("weights");
  sketch.object.form = surface;
}

void ObjectReader::read_lattice(const JsonObject& source, ObjectSketch& sketch) {
  expect_only(source, {"degree", "count", "controls", "box", "fade"});
  Lattice lattice;
  lattice.count = counts<3>(source, "count", {4, 4, 4});
  for (std::size_t a = 0; a < 3; ++a) lattice.degree[a] = std::min(3, lattice.count[a] - 1);
  lattice.degree = counts<3>(source, "degree", lattice.degree);
  sketch.object.form = lattice;
  sketch.object.controls = rows(source, "controls");
  const PointsD box = rows(source, "box");
  if ((box.rows() == 2) == (sketch.object.controls.rows() > 0))
    throw io_error(source.place(), "has neither or both of \"box\" and \"controls\"",
                   R"(give "box": [[x, y, z], [x, y, z]], two corners)");
  if (box.rows() == 0) return;
  try {
    sketch.object.controls = lattice_controls(
        lattice, {box.row(0).cwiseMin(box.row(1)).transpose(), box.row(0).cwiseMax(box.row(1)).transpose()});
  } catch (const Error& error) {
    throw io_error(source.place(), error.what());
  }
}

void ObjectReader::read_mesh(const JsonObject& source, ObjectSketch& sketch) {
  expect_only(source, {"file", "range", "full", "distance", "smoothing"});
  const Character read = read_obj(folder_ / source.text("file"));
  const Mesh& mesh = read.parts.at(0).mesh;
  sketch.object.form = WrapMesh{mesh.faces};
  sketch.object.controls = mesh.positions.cast<double>();
}

void ObjectReader::read_frame(const JsonObject& source, InfluenceForm form, ObjectSketch& sketch) {
  expect_only(source, {"at", "range", "full", "distance"});
  sketch.object.form = std::move(form);
  if (source.has("at") && source.json().at("at").is_array()) {
    const std::vector<double> at = source.numbers("at", 3);
    sketch.object.controls = Eigen::Map<const Eigen::RowVector3d>(at.data());
  } else {
    sketch.through.push_back(read_point(source.object("at")));
  }
}

void ObjectReader::read_joints(const JsonObject& source, ObjectSketch& sketch) {
  sketch.object.carrier = read_node(source, "carrier");
  sketch.object.node = read_node(source, "node");
  if (!source.has("joints")) return;
  sketch.follows_skin = true;
  if (source.json().at("joints").is_string()) {
    if (source.text("joints") != "skin")
      throw io_error(source.place_of("joints"), "is another word than skin",
                     R"(give "skin", or the names of joints)");
    return;
  }
  for (const std::string& name : source.texts("joints"))
    sketch.joints.push_back(node_named(name, source.place_of("joints")));
}

void ObjectReader::read_reach(const JsonObject& source, InfluenceReach& reach) {
  reach.range = source.number_or("range", 0);
  reach.full = source.number_or("full", 0);
  reach.strength = source.number_or("strength", 1);
  reach.fade = source.number_or("fade", reach.fade);
  reach.smoothing = static_cast<int>(source.integer_or("smoothing", reach.smoothing, 1, 1000));
  const std::string distance = source.text_or("distance", "geodesic");
  if (distance != "geodesic" && distance != "euclidean")
    throw io_error(source.place_of("distance"), fmt::format("is \"{}\"", distance.substr(0, 40)),
                   "give geodesic or euclidean");
  reach.geodesic = distance == "geodesic";
  for (const std::string& name : source.texts("parts")) {
    const int part = find_part(character_, name);
    if (part < 0)
      throw io_error(source.place_of("parts"), fmt::format("name {}", name.substr(0, 100)),
                     "name parts of the character");
    reach.parts.push_back(part);
  }
  std::sort(reach.parts.begin(), reach.parts.end());
  reach.parts.erase(std::unique(reach.parts.begin(), reach.parts.end()), reach.parts.end());
  read_drawn(source, reach);
}

/// "weights_on": {PART: {VERTEX: WEIGHT, ...}, ...}
void ObjectReader::read_drawn(const JsonObject& source, InfluenceReach& reach) {
  if (!source.has("weights_on")) return;
  const JsonObject parts = source.object("weights_on");
  for (const auto& [name, map] : parts.json().items()) {
    VertexWeights drawn;
    drawn.part = find_part(character_, name);
    const std::string place = parts.place_of(name);
    if (drawn.part < 0) throw io_error(place, "is not a part", "name parts of the character");
    std::vector<std::pair<int, float>> entries;
    for (const auto& [vertex, weight] : JsonObject(map, place).json().items()) {
      int number = -1;
      const auto [end, failure] = std::from_chars(vertex.data(), vertex.data() + vertex.size(), number);
      if (failure != std::errc() || end != vertex.data() + vertex.size() || !weight.is_number())
        throw io_error(place, fmt::format("has \"{}\"", vertex.substr(0, 40)), R"(give "VERTEX": WEIGHT)");
      entries.emplace_back(number, weight.get<float>());
    }
    std::sort(entries.begin(), entries.end());
    for (const auto& [vertex, weight] : entries) {
      drawn.vertices.push_back(vertex);
      drawn.weights.push_back(weight);
    }
    reach.drawn.push_back(std::move(drawn));
  }
  std::sort(reach.drawn.begin(), reach.drawn.end(),
            [](const VertexWeights& a, const VertexWeights& b) { return a.part < b.part; });
}

}  // namespace

std::vector<ObjectSketch> read_objects(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const JsonObject& root) {
    if (!root.has("objects"))
      throw io_error("file", "has no \"objects\"", R"(give {"objects": {NAME: {"kind": "curve", ...}}})");
    const JsonObject objects = root.object("objects");
    ObjectReader reader(character, path.parent_path());
    std::vector<ObjectSketch> sketches;
    for (const auto& [name, object] : objects.json().items()) {  // a JSON object ascends by name
      const std::string place = fmt::format("object {}", name);
      if (find_object(character, name) >= 0)
        throw io_error(place, "is there already", "give it another name");
      sketches.push_back(reader.read(name, JsonObject(object, place)));
    }
    if (sketches.empty()) throw io_error("objects", "are none", "give one or more");
    return sketches;
  });
}

}  // namespace mien
