#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "mien/character/object_problems.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"
#include "mien/io/detail/rows_json.h"

// Influence objects in the MIEN_character extension: control points as JSON numbers, which keep doubles, what is long in accessors. A
// binding to a mesh that another program changed no longer fits; it is left out.

namespace mien::detail {
namespace {

constexpr int most_controls = 1000000;

int accessor_of(const std::vector<int>& numbers, GltfBuilder& builder) {
  return builder.add_numbers(std::vector<std::uint32_t>(numbers.begin(), numbers.end()));
}

/// Offsets as the number of entries of each row.
std::vector<int> counts_of(const std::vector<int>& offsets) {
  std::vector<int> counts;
  for (std::size_t k = 0; k + 1 < offsets.size(); ++k) counts.push_back(offsets[k + 1] - offsets[k]);
  return counts;
}

std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets{0};
  for (const int count : counts) offsets.push_back(offsets.back() + count);
  return offsets;
}

void write_form(const InfluenceForm& form, GltfBuilder& builder, Json& json) {
  const auto add_weights = [&](const std::vector<double>& weights) {
    if (!weights.empty()) json["weights"] = weights;
  };
  if (const auto* curve = std::get_if<NurbsCurve>(&form)) {
    json["degree"] = curve->degree;
    json["knots"] = curve->knots;
    add_weights(curve->weights);
  } else if (const auto* surface = std::get_if<NurbsSurface>(&form)) {
    json["degree"] = {surface->degree_u, surface->degree_v};
    json["count"] = {surface->count_u, surface->count_v};
    json["knotsU"] = surface->knots_u;
    json["knotsV"] = surface->knots_v;
    add_weights(surface->weights);
  } else if (const auto* lattice = std::get_if<Lattice>(&form)) {
    json["degree"] = lattice->degree;
    json["count"] = lattice->count;
  } else if (const auto* mesh = std::get_if<WrapMesh>(&form)) {
    std::vector<int> sizes;
    for (std::size_t f = 0; f < mesh->faces.size(); ++f)
      sizes.push_back(static_cast<int>(mesh->faces[f].size()));
    json["faceSizes"] = accessor_of(sizes, builder);
    json["corners"] = accessor_of(mesh->faces.corners(), builder);
  }
}

Json binding_json(const InfluenceBinding& binding, GltfBuilder& builder) {
  Json json = {{"mesh", binding.part},
               {"vertices", accessor_of(binding.vertices, builder)},
               {"weights", builder.add_floats(binding.weights, 1)}};
  if (binding.offsets.empty()) return json;
  json["counts"] = accessor_of(counts_of(binding.offsets), builder);
  json["controls"] = accessor_of(binding.controls, builder);
  json["coefficients"] = builder.add_floats(binding.coefficients, 1);
  return json;
}

Json object_json(const InfluenceObject& object, GltfBuilder& builder) {
  Json json = {{"name", object.name}, {"kind", name_of(object.form)}};
  write_form(object.form, builder, json);
  json["points"] = rows_json(object.controls);
  if (object.carrier >= 0) json["carrier"] = object.carrier;
  if (object.node >= 0) json["node"] = object.node;
  if (object.skin >= 0) json["skin"] = object.skin;
  if (!object.skin_weights.empty())
    json["skinWeights"] = {{"counts", accessor_of(counts_of(object.skin_weights.offsets), builder)},
                           {"joints", accessor_of(object.skin_weights.joints, builder)},
                           {"weights", builder.add_floats(object.skin_weights.weights, 1)}};
  for (const InfluenceBinding& binding : object.bindings)
    if (!binding.vertices.empty()) json["bindings"].push_back(binding_json(binding, builder));
  return json;
}

Json moves_json(const Character& character, const Shape& shape, GltfBuilder& builder) {
  Json objects = Json::array();
  std::vector<float> values;
  for (const ObjectMove& move : shape.objects) {
    if (move.controls.rows() == 0) continue;
    objects.push_back(character.objects[move.object].name);
    for (Eigen::Index r = 0; r < move.controls.rows(); ++r)
      for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(move.controls(r, k)));
  }
  if (objects.empty()) return {};
  return {{"shape", shape.name}, {"objects", std::move(objects)}, {"values", builder.add_floats(values, 1)}};
}

/// Reads one object; every count is checked against what backs it.
class ObjectReader {
 public:
  ObjectReader(GltfDocument& document, const std::vector<PartSource>& sources, const Character& character)
      : document_(document), sources_(sources), character_(character) {}

  InfluenceObject read(const JsonObject& source) {
    InfluenceObject object;
    object.name = source.text("name");
    object.controls = rows_of(source.numbers("points"));
    object.form = read_form(source);
    const auto count = static_cast<std::size_t>(object.controls.rows());
    if (const std::string fault = fault_of(object.form, count); !fault.empty())
      throw io_error(source.place(), fault, "give a descriptor of its points");
    object.carrier = source.index_or_none("carrier", character_.nodes.size());
    object.node = source.index_or_none("node", character_.nodes.size());
    object.skin = source.index_or_none("skin", character_.skins.size());
    if (source.has("skinWeights")) object.skin_weights = read_skin(source.object("skinWeights"), count);
    for (const JsonObject& binding : source.objects("bindings")) read_binding(binding, object);
    return object;
  }

 private:
  std::vector<int> integers(const JsonObject& source, const char* key) {
    const auto read = document_.integers(source.index(key, document_.count("accessors")), 1);
    std::vector<int> numbers;
    for (const std::uint32_t number : read)
      numbers.push_back(static_cast<int>(std::min<std::uint32_t>(number, 1u << 30)));
    return numbers;
  }
  std::vector<float> floats(const JsonObject& source, const char* key) {
    return document_.floats(source.index(key, document_.count("accessors")), 1).values;
  }
  /// Offsets of `rows` rows with `entries` entries in all.
  std::vector<int> offsets(const JsonObject& source, std::size_t rows, std::size_t entries) {
    const std::vector<int> counts = integers(source, "counts");
    const auto total = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    if (counts.size() != rows || total != entries)
      throw io_error(source.place_of("counts"), fmt::format("are {} of {} in all", counts.size(), total),
                     fmt::format("give {} of {} in all", rows, entries));
    return offsets_of(counts);
  }
  template <std::size_t N>
  std::array<int, N> whole_numbers(const JsonObject& source, const char* key) {
    const std::vector<double> read = source.numbers(key, N);
    if (read.size() != N)
      throw io_error(source.place(), fmt::format("has no \"{}\"", key), fmt::format("give {} numbers", N));
    std::array<int, N> numbers{};
    for (std::size_t k = 0; k < N; ++k) {
      if (!(read[k] >= 0 && read[k] <= most_controls))
        throw io_error(source.place_of(key), fmt::format("holds {}", read[k]),
                       fmt::format("give numbers from 0 to {}", most_controls));
      numbers[k] = static_cast<int>(read[k]);
    }
    return numbers;
  }
  InfluenceForm read_form(const JsonObject& source);
  SkinWeights read_skin(const JsonObject& source, std::size_t rows);
  void read_binding(const JsonObject& source, InfluenceObject& object);

  GltfDocument& document_;
  const std::vector<PartSource>& sources_;
  const Character& character_;
};

InfluenceForm ObjectReader::read_form(const JsonObject& source) {
  const std::string kind = source.text("kind");
  if (kind == "curve") {
    NurbsCurve curve;
    curve.degree = static_cast<int>(source.integer("degree", 1, most_controls));
    curve.knots = source.numbers("knots");
    curve.weights = source.numbers("weights");
    return curve;
  }
  if (kind == "surface") {
    NurbsSurface surface;
    const auto degree = whole_numbers<2>(source, "degree"), count = whole_numbers<2>(source, "count");
    surface.degree_u = degree[0];
    surface.degree_v = degree[1];
    surface.count_u = count[0];
    surface.count_v = count[1];
    surface.knots_u = source.numbers("knotsU");
    surface.knots_v = source.numbers("knotsV");
    surface.weights = source.numbers("weights");
    return surface;
  }
  if (kind == "lattice")
    return Lattice{whole_numbers<3>(source, "count"), whole_numbers<3>(source, "degree")};
  if (kind == "cluster") return Cluster{};
  if (kind == "locator") return Locator{};
  if (kind != "mesh")
    throw io_error(source.place_of("kind"), fmt::format("is \"{}\"", kind.substr(0, 40)),
                   "give curve, surface, lattice, mesh, cluster or locator");
  WrapMesh mesh;
  const std::vector<int> sizes = integers(source, "faceSizes"), corners = integers(source, "corners");
  std::size_t next = 0;
  for (const int size : sizes) {
    if (static_cast<std::size_t>(size) > corners.size() - next)
      throw io_error(source.place_of("corners"), fmt::format("number {}", corners.size()),
                     "give as many as the faces have");
    mesh.faces.push_back(std::span(corners).subspan(next, static_cast<std::size_t>(size)));
    next += static_cast<std::size_t>(size);
  }
  return mesh;
}

SkinWeights ObjectReader::read_skin(const JsonObject& source, std::size_t rows) {
  SkinWeights skin;
  skin.joints = integers(source, "joints");
  skin.weights = floats(source, "weights");
  if (skin.weights.size() != skin.joints.size())
    throw io_error(source.place_of("weights"), fmt::format("number {}", skin.weights.size()),
                   fmt::format("give {}, one a joint", skin.joints.size()));
  skin.offsets = offsets(source, rows, skin.joints.size());
  return skin;
}

bool fits(const InfluenceBinding& binding, std::size_t vertex_count, const InfluenceObject& object) {
  for (std::size_t k = 0; k < binding.vertices.size(); ++k)
    if (binding.vertices[k] < 0 || binding.vertices[k] >= static_cast<int>(vertex_count) ||
        (k > 0 && binding.vertices[k] <= binding.vertices[k - 1]) ||
        !(binding.weights[k] > 0 && binding.weights[k] <= 1))
      return false;
  return std::all_of(binding.controls.begin(), binding.controls.end(),
                     [&](int control) { return control >= 0 && control < object.controls.rows(); });
}

void ObjectReader::read_binding(const JsonObject& source, InfluenceObject& object) {
  InfluenceBinding binding;
  binding.part = part_of_mesh(source, sources_);
  if (binding.part < 0) return;
  binding.vertices = integers(source, "vertices");
  binding.weights = floats(source, "weights");
  if (binding.weights.size() != binding.vertices.size())
    throw io_error(source.place_of("weights"), fmt::format("number {}", binding.weights.size()),
                   fmt::format("give {}, one a vertex", binding.vertices.size()));
  if (!is_frame(object.form)) {
    binding.controls = integers(source, "controls");
    binding.coefficients = floats(source, "coefficients");
    if (binding.coefficients.size() != binding.controls.size())
      throw io_error(source.place_of("coefficients"), fmt::format("number {}", binding.coefficients.size()),
                     fmt::format("give {}, one a control point", binding.controls.size()));
    binding.offsets = offsets(source, binding.vertices.size(), binding.controls.size());
  }
  if (fits(binding, character_.parts[binding.part].mesh.vertex_count(), object))
    object.bindings.push_back(std::move(binding));
}

void read_object_moves(const JsonObject& source, GltfDocument& document, Character& character) {
  const int shape = find_shape(character, source.text("shape"));
  if (shape < 0) return;  // another program took the shape away
  const std::vector<float> values =
      document.floats(source.index("values", document.count("accessors")), 1).values;
  std::size_t next = 0;
  std::vector<ObjectMove>& moves = character.shapes[shape].objects;
  for (const std::string& name : source.texts("objects")) {
    ObjectMove move{find_object(character, name), {}};
    if (move.object < 0)
      throw io_error(source.place_of("objects"), fmt::format("name {}", name.substr(0, 100)),
                     "name objects of the file");
    const Eigen::Index rows = character.objects[move.object].controls.rows();
    if (values.size() - next < static_cast<std::size_t>(3 * rows))
      throw io_error(source.place_of("values"), fmt::format("hold {} numbers", values.size()),
                     "give three a control point of each object");
    move.controls.resize(rows, 3);
    for (Eigen::Index r = 0; r < rows; ++r)
      for (int k = 0; k < 3; ++k) move.controls(r, k) = values[next++];
    moves.push_back(std::move(move));
  }
}

}  // namespace

Json object_channel_json(const Character& character, const Channel& channel, GltfBuilder& builder) {
  return {{"object", character.objects[channel.object].name},
          {"index", channel.control},
          {"interpolation", name_of(channel.interpolation)},
          {"input", builder.add_floats(channel.times, 1, true)},
          {"output", builder.add_floats(channel.values, channel.width())}};
}

Channel read_object_channel(const JsonObject& source, const Character& character) {
  Channel channel;
  channel.property = Channel::Property::object_control;
  channel.object = find_object(character, source.text("object"));
  if (channel.object < 0)
    throw io_error(source.place_of("object"), fmt::format("names {}", source.text("object").substr(0, 100)),
                   "name one of the objects");
  channel.control =
      source.index("index", static_cast<std::size_t>(character.objects[channel.object].controls.rows()));
  return channel;
}

void write_objects(const Character& character, GltfBuilder& builder, Json& vendor) {
  for (const InfluenceObject& object : character.objects)
    vendor["objects"].push_back(object_json(object, builder));
  for (const Shape& shape : character.shapes)
    if (Json moves = moves_json(character, shape, builder); !moves.empty())
      vendor["objectMoves"].push_back(std::move(moves));
}

void read_objects(const JsonObject& vendor, GltfDocument& document, const std::vector<PartSource>& sources,
                  Character& character) {
  for (const JsonObject& source : vendor.objects("objects"))
    character.objects.push_back(ObjectReader(document, sources, character).read(source));
  for (const JsonObject& source : vendor.objects("objectMoves"))
    read_object_moves(source, document, character);
}

std::optional<Character> with_shapes_of_objects(const Character& character) {
  const auto is_lost = [](const Shape& shape) { return shape.parts.empty() && !shape.objects.empty(); };
  if (character.parts.empty() || std::none_of(character.shapes.begin(), character.shapes.end(), is_lost))
    return {};
  Character listed = character;
  for (Shape& shape : listed.shapes)
    if (is_lost(shape)) shape.parts.push_back({0, {}, Points(0, 3), {}, {}});
  return listed;
}

}  // namespace mien::detail
