#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <list>
#include <set>
#include <unordered_map>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/uri.h"

namespace mien::detail {
namespace {

/// The translation, rotation and scale closest to a matrix; a shear is lost.
Transform decomposed(const Eigen::Matrix4d& matrix) {
  Transform transform;
  transform.translation = matrix.topRightCorner<3, 1>();
  Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  for (int c = 0; c < 3; ++c) transform.scale[c] = linear.col(c).norm();
  if (linear.determinant() < 0) transform.scale[0] = -transform.scale[0];
  for (int c = 0; c < 3; ++c)
    if (transform.scale[c] != 0) linear.col(c) /= transform.scale[c];
  if (std::abs(linear.determinant()) > 1e-6) transform.rotation = Eigen::Quaterniond(linear).normalized();
  return transform;
}

Node read_node(const JsonObject& source) {
  Node node;
  node.name = source.text_or("name", "");
  if (source.has("matrix")) {
    const std::vector<double> m = source.numbers("matrix", 16);
    node.has_matrix = true;
    node.matrix = Eigen::Map<const Eigen::Matrix4d>(m.data());
    node.rest = decomposed(node.matrix);
  }
  if (source.has("translation"))
    node.rest.translation = Eigen::Map<const Eigen::Vector3d>(source.numbers("translation", 3).data());
  if (source.has("scale"))
    node.rest.scale = Eigen::Map<const Eigen::Vector3d>(source.numbers("scale", 3).data());
  if (source.has("rotation")) {
    const std::vector<double> q = source.numbers("rotation", 4);
    node.rest.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
    const double length = node.rest.rotation.norm();
    if (length < 1e-6) throw io_error(source.place_of("rotation"), "has no length", "give a unit quaternion");
    // A rotation that is unit within float rounding is kept as written.
    if (std::abs(length - 1) > 1e-6) node.rest.rotation.coeffs() /= length;
  }
  node.carried = source.others(
      {"name", "children", "matrix", "translation", "rotation", "scale", "mesh", "skin", "weights"});
  return node;
}

void check_cycles(const std::vector<Node>& nodes) {
  std::vector<int> state(nodes.size(), 0);  // 0 not seen, else the walk that saw it
  for (int start = 0; start < static_cast<int>(nodes.size()); ++start)
    for (int at = start; at >= 0 && state[at] != start + 1; at = nodes[at].parent) {
      if (state[at] != 0) break;
      state[at] = start + 1;
      if (nodes[at].parent >= 0 && state[nodes[at].parent] == start + 1)
        throw io_error(fmt::format("nodes[{}]", at), "is its own ancestor", "nodes must form trees");
    }
}

/// All names in an order that agrees with each part's own order wherever those agree with one another.
class NameOrder {
 public:
  void add(const std::vector<std::string>& names) {
    auto after = order_.end();
    for (const std::string& name : names) {
      const auto known = places_.find(name);
      if (known != places_.end()) {
        after = known->second;
        continue;
      }
      after = order_.insert(after == order_.end() ? after : std::next(after), name);
      places_.emplace(name, after);
    }
  }
  const std::list<std::string>& names() const { return order_; }

 private:
  std::list<std::string> order_;
  std::unordered_map<std::string, std::list<std::string>::iterator> places_;
};

std::vector<std::string> target_names(const JsonObject& mesh, std::size_t count, const std::string& part) {
  std::vector<std::string> names;
  if (mesh.has("extras") && mesh.json().at("extras").is_object()) {
    const JsonObject extras = mesh.object("extras");
    if (extras.has("targetNames")) names = extras.texts("targetNames");
  }
  names.resize(count);
  std::set<std::string> used;
  for (std::size_t t = 0; t < count; ++t) {
    if (names[t].empty()) names[t] = fmt::format("{}.target_{}", part, t);
    const std::string wanted = names[t];
    for (int copy = 2; !used.insert(names[t]).second; ++copy) names[t] = fmt::format("{}.{}", wanted, copy);
  }
  return names;
}

std::string mesh_carried(const JsonObject& mesh, const MeshData& data) {
  Json carried = Json::object();
  const std::string others = mesh.others({"name", "primitives", "weights", "extras", "extensions"});
  if (!others.empty()) carried = Json::parse(others);
  if (mesh.has("extras")) {
    Json extras = mesh.json().at("extras");
    if (extras.is_object()) extras.erase("targetNames");
    if (!extras.is_object() || !extras.empty()) carried["extras"] = extras;
  }
  if (mesh.has("extensions")) {
    const std::string extensions = mesh.object("extensions").others({vendor_extension});
    if (!extensions.empty()) carried["extensions"] = Json::parse(extensions);
  }
  if (!data.carried_primitives.empty()) carried["primitives"] = Json::parse(data.carried_primitives);
  return carried.empty() ? std::string() : json_text(carried);
}

/// A mesh of the file and the node that shows it, -1: none does.
struct FoundMesh {
  int mesh, node;
};

bool has_influences(const JsonObject& mesh) {
  for (const JsonObject& primitive : mesh.objects("primitives"))
    if (primitive.object("attributes").has("JOINTS_0")) return true;
  return false;
}

std::vector<FoundMesh> find_meshes(const GltfDocument& document) {
  std::vector<FoundMesh> found;
  for (std::size_t n = 0; n < document.count("nodes"); ++n) {
    const int mesh =
        document.element("nodes", static_cast<int>(n)).index_or_none("mesh", document.count("meshes"));
    if (mesh >= 0) found.push_back({mesh, static_cast<int>(n)});
  }
  // In the order of the meshes, because extensions name meshes by number.
  std::stable_sort(found.begin(), found.end(),
                   [](const FoundMesh& a, const FoundMesh& b) { return a.mesh < b.mesh; });
  std::vector<bool> shown(document.count("meshes"), false);
  for (const FoundMesh& mesh : found) shown[mesh.mesh] = true;
  for (std::size_t m = 0; m < shown.size(); ++m)
    if (!shown[m]) found.push_back({static_cast<int>(m), -1});
  return found;
}

}  // namespace

void read_nodes(GltfDocument& document, Character& character) {
  const std::size_t count = document.count("nodes");
  character.nodes.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const JsonObject source = document.element("nodes", static_cast<int>(n));
    const int parent = character.nodes[n].parent;
    character.nodes[n] = read_node(source);
    character.nodes[n].parent = parent;
    for (const int child : source.indices("children", count)) {
      if (character.nodes[child].parent >= 0)
        throw io_error(source.place_of("children"), fmt::format("names node {}, which has a parent", child),
                       "nodes must form trees");
      character.nodes[child].parent = static_cast<int>(n);
    }
  }
  check_cycles(character.nodes);
}

/// What MIEN_character says of the skin; linear blend, as glTF has it, otherwise.
SkinningMethod skinning_method(const JsonObject& skin) {
  if (!skin.has("extensions") || !skin.object("extensions").has(vendor_extension))
    return SkinningMethod::linear_blend;
  const JsonObject vendor = skin.object("extensions").object(vendor_extension);
  const std::string method = vendor.text_or("method", "linearBlend");
  if (method == "dualQuaternion") return SkinningMethod::dual_quaternion;
  if (method == "linearBlend") return SkinningMethod::linear_blend;
  throw io_error(vendor.place_of("method"), fmt::format("is {}", method.substr(0, 100)),
                 "linearBlend or dualQuaternion");
}

void read_skins(GltfDocument& document, Character& character) {
  for (std::size_t s = 0; s < document.count("skins"); ++s) {
    const JsonObject source = document.element("skins", static_cast<int>(s));
    Skin skin;
    skin.name = source.text_or("name", "");
    skin.joints = source.indices("joints", character.nodes.size());
    if (skin.joints.empty()) throw io_error(source.place_of("joints"), "is empty", "a skin needs joints");
    skin.skeleton = source.index_or_none("skeleton", character.nodes.size());
    skin.inverse_bind.assign(skin.joints.size(), Eigen::Matrix4d::Identity());
    const int bind = source.index_or_none("inverseBindMatrices", document.count("accessors"));
    skin.has_inverse_bind = bind >= 0;
    if (bind >= 0) {
      const Table table = document.floats(bind, 16);
      if (static_cast<std::size_t>(table.rows) < skin.joints.size())
        throw io_error(source.place_of("inverseBindMatrices"), fmt::format("has {} matrices", table.rows),
                       fmt::format("there are {} joints", skin.joints.size()));
      for (std::size_t j = 0; j < skin.joints.size(); ++j)
        skin.inverse_bind[j] = Eigen::Map<const Eigen::Matrix4f>(table.values.data() + 16 * j).cast<double>();
    }
    skin.method = skinning_method(source);
    skin.carried = others_but_vendor(source, {"name", "joints", "skeleton", "inverseBindMatrices"});
    character.skins.push_back(std::move(skin));
  }
}

std::vector<PartSource> read_parts(GltfDocument& document, Character& character) {
  std::vector<PartSource> sources;
  std::vector<std::vector<std::string>> names;
  std::vector<std::vector<PartDelta>> targets;
  std::unordered_map<std::string, double> rest;
  NameOrder order;
  for (const FoundMesh& found : find_meshes(document)) {
    const JsonObject mesh = document.element("meshes", found.mesh);
    Part part;
    part.node = found.node;
    part.shown = found.node >= 0;
    if (part.shown)
      part.skin = document.element("nodes", found.node).index_or_none("skin", character.skins.size());
    MeshData data = read_mesh(document, found.mesh, part.skin >= 0 || (!part.shown && has_influences(mesh)));
    if (data.mesh.positions.rows() == 0) continue;
    part.mesh_name = mesh.text_or("name", "");
    part.name = part.shown ? character.nodes[found.node].name : "";
    if (part.name.empty()) part.name = part.mesh_name;
    if (part.name.empty()) part.name = fmt::format("mesh_{}", found.mesh);
    part.carried = mesh_carried(mesh, data);
    part.mesh = std::move(data.mesh);
    part.skin_weights = std::move(data.skin_weights);
    names.push_back(target_names(mesh, data.targets.size(), part.name));
    targets.push_back(std::move(data.targets));
    const bool own = part.shown && document.element("nodes", found.node).has("weights");
    const std::vector<double> weights =
        (own ? document.element("nodes", found.node) : mesh).numbers("weights");
    for (std::size_t t = 0; t < std::min(weights.size(), names.back().size()); ++t)
      rest.emplace(names.back()[t], weights[t]);
    order.add(names.back());
    character.parts.push_back(std::move(part));
    sources.push_back({found.mesh, {}});
  }
  std::unordered_map<std::string, int> numbers;
  for (const std::string& name : order.names()) {
    numbers.emplace(name, static_cast<int>(character.shapes.size()));
    Shape shape;
    shape.name = name;
    character.shapes.push_back(std::move(shape));
  }
  for (std::size_t p = 0; p < sources.size(); ++p)
    for (std::size_t t = 0; t < names[p].size(); ++t) {
      sources[p].shapes.push_back(numbers.at(names[p][t]));
      targets[p][t].part = static_cast<int>(p);
      character.shapes[sources[p].shapes.back()].parts.push_back(std::move(targets[p][t]));
    }
  complete_sliders(character);
  for (Slider& slider : character.sliders)
    if (const auto found = rest.find(slider.name); found != rest.end()) slider.rest = found->second;
  return sources;
}

void read_appearance(GltfDocument& document, Character& character) {
  Appearance& appearance = character.appearance;
  for (std::size_t m = 0; m < document.count("materials"); ++m) {
    const JsonObject source = document.element("materials", static_cast<int>(m));
    Material material;
    material.name = source.text_or("name", "");
    material.base_color = Eigen::Vector4f::Ones();
    if (source.has("pbrMetallicRoughness")) {
      const std::vector<double> color = source.object("pbrMetallicRoughness").numbers("baseColorFactor");
      if (color.size() == 4)
        material.base_color =
            Eigen::Map<const Eigen::Vector4d>(color.data()).cwiseMax(0).cwiseMin(1).cast<float>();
    }
    material.carried = json_text(source.json());
    appearance.materials.push_back(std::move(material));
  }
  for (std::size_t i = 0; i < document.count("images"); ++i) {
    const JsonObject source = document.element("images", static_cast<int>(i));
    Image image;
    image.name = source.text_or("name", "");
    image.mime_type = source.text_or("mimeType", "");
    const int view = source.index_or_none("bufferView", document.count("bufferViews"));
    const std::string uri = source.text_or("uri", "");
    if (view >= 0) {
      const auto bytes = document.view(view);
      image.bytes.assign(bytes.begin(), bytes.end());
    } else if (document.has_uri_file(uri)) {
      image.bytes = document.bytes_of_uri(uri, source.place_of("uri"));
      if (image.mime_type.empty()) image.mime_type = media_type_of(uri);
    }
    if (!uri.starts_with("data:")) image.uri = uri;
    image.carried = source.others({"name", "mimeType", "bufferView", "uri"});
    appearance.images.push_back(std::move(image));
  }
  for (std::size_t t = 0; t < document.count("textures"); ++t) {
    const JsonObject texture = document.element("textures", static_cast<int>(t));
    texture.index_or_none("source", document.count("images"));
    texture.index_or_none("sampler", document.count("samplers"));
    appearance.textures.push_back(json_text(texture.json()));
  }
  for (std::size_t s = 0; s < document.count("samplers"); ++s)
    appearance.samplers.push_back(json_text(document.element("samplers", static_cast<int>(s)).json()));
}

}  // namespace mien::detail
