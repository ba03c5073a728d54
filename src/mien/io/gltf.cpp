#include "mien/io/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"
#include "mien/io/detail/uri.h"
#include "mien/io/file.h"

namespace mien {
namespace {

using detail::GltfBuilder;
using detail::Json;

/// The nodes as they are written: skinned meshes as roots, a root above the joints where they have none in
/// common.
class SceneWriter {
 public:
  explicit SceneWriter(const Character& character)
      : character_(character), parents_(character.nodes.size()) {}
  void write();
  Json nodes = Json::array(), scenes = Json::array(), skins = Json::array();
  int scene = 0;
  std::vector<int> node_of_part;

 private:
  void place_parts();
  void join_skin_roots();
  void write_skins();
  void write_scenes(const Json& carried);
  Json node_json(const Node& node, bool animated) const;
  int add_root(Json node);
  std::vector<int> roots() const;
  bool is_bare(int node) const;
  bool is_above_all(int node, const std::vector<int>& joints) const;

  const Character& character_;
  std::vector<int> parents_;
  std::vector<bool> animated_, has_children_;
  std::vector<bool> is_used_;  ///< by a skin, a constraint or a control
};

Json SceneWriter::node_json(const Node& node, bool animated) const {
  Json json = detail::carried_json(node.carried, fmt::format("node {}: carried", node.name));
  if (!node.name.empty()) json["name"] = node.name;
  if (node.has_matrix && !animated) {
    if (!node.matrix.isIdentity(0))
      json["matrix"] = std::vector<double>(node.matrix.data(), node.matrix.data() + 16);
    return json;
  }
  const Transform& rest = node.rest;
  const Eigen::Vector4d q = rest.rotation.coeffs();
  if (rest.translation != Eigen::Vector3d::Zero())
    json["translation"] = std::vector(rest.translation.data(), rest.translation.data() + 3);
  if (q != Eigen::Vector4d(0, 0, 0, 1)) json["rotation"] = std::vector(q.data(), q.data() + 4);
  if (rest.scale != Eigen::Vector3d::Ones())
    json["scale"] = std::vector(rest.scale.data(), rest.scale.data() + 3);
  return json;
}

int SceneWriter::add_root(Json node) {
  nodes.push_back(std::move(node));
  parents_.push_back(-1);
  return static_cast<int>(nodes.size()) - 1;
}

/// Each node's root; every chain of parents is walked once.
std::vector<int> SceneWriter::roots() const {
  std::vector<int> root(parents_.size(), -1), walked;
  for (int n = 0; n < static_cast<int>(parents_.size()); ++n) {
    walked.clear();
    int at = n;
    for (; root[at] < 0 && parents_[at] >= 0; at = parents_[at]) walked.push_back(at);
    if (root[at] < 0) root[at] = at;
    for (const int below : walked) root[below] = root[at];
  }
  return root;
}

/// Whether nothing but its mesh depends on a node's place in the tree.
bool SceneWriter::is_bare(int node) const {
  return !animated_[node] && !has_children_[node] && !is_used_[node];
}

void SceneWriter::write() {
  const std::size_t count = character_.nodes.size();
  animated_.assign(count, false);
  has_children_.assign(count, false);
  is_used_.assign(count, false);
  for (const Clip& clip : character_.clips)
    for (const Channel& channel : clip.channels)
      if (channel.node >= 0) animated_[channel.node] = true;
  for (const Skin& skin : character_.skins)
    for (const int joint : skin.joints) is_used_[joint] = true;
  for (const Constraint& constraint : character_.constraints) {
    is_used_[constraint.node] = true;
    for (const ConstraintSource& source : constraint.sources) is_used_[source.node] = true;
    if (constraint.up_node >= 0) is_used_[constraint.up_node] = true;
  }
  for (const Control& control : character_.controls)
    if (control.node >= 0) is_used_[control.node] = true;
  for (std::size_t n = 0; n < count; ++n) {
    const Node& node = character_.nodes[n];
    parents_[n] = node.parent;
    if (node.parent >= 0) has_children_[node.parent] = true;
    nodes.push_back(node_json(node, animated_[n]));
  }
  place_parts();
  join_skin_roots();
  for (std::size_t n = 0; n < parents_.size(); ++n)
    if (parents_[n] >= 0) nodes[parents_[n]]["children"].push_back(n);
  write_skins();
  write_scenes(detail::carried_json(character_.carried, "carried"));
}

/// A skinned mesh ignores its node's transform, so its node is written as a root without one.
void SceneWriter::place_parts() {
  std::vector<bool> taken(character_.nodes.size(), false);
  for (std::size_t p = 0; p < character_.parts.size(); ++p) {
    const Part& part = character_.parts[p];
    if (!part.shown) {
      node_of_part.push_back(-1);
      continue;
    }
    int node = part.node;
    const bool must_move =
        node >= 0 && part.skin >= 0 &&
        (parents_[node] >= 0 || nodes[node].contains("matrix") || nodes[node].contains("translation") ||
         nodes[node].contains("rotation") || nodes[node].contains("scale"));
    if (node < 0 || taken[node] || (must_move && !is_bare(node))) {
      node = add_root({{"name", part.name}});
    } else {
      taken[node] = true;
      if (must_move) {
        parents_[node] = -1;
        for (const char* key : {"matrix", "translation", "rotation", "scale"}) nodes[node].erase(key);
      }
      if (!character_.nodes[node].name.empty()) nodes[node]["name"] = part.name;
    }
    nodes[node]["mesh"] = p;
    if (part.skin >= 0 && !part.skin_weights.empty()) nodes[node]["skin"] = part.skin;
    node_of_part.push_back(node);
  }
}

void SceneWriter::join_skin_roots() {
  for (const Skin& skin : character_.skins) {
    const std::vector<int> root_of = roots();
    std::set<int> trees;
    for (const int joint : skin.joints) trees.insert(root_of[joint]);
    if (trees.size() < 2) continue;
    const int above = add_root({{"name", skin.name.empty() ? "skeleton" : skin.name + ".skeleton"}});
    for (const int root : trees) parents_[root] = above;
  }
}

/// Whether every joint is the node itself or below it.
bool SceneWriter::is_above_all(int node, const std::vector<int>& joints) const {
  enum State : char { unknown, below, beside };
  std::vector<State> state(parents_.size(), unknown);
  state[node] = below;
  std::vector<int> walked;
  for (const int joint : joints) {
    walked.clear();
    int at = joint;
    for (; state[at] == unknown && parents_[at] >= 0; at = parents_[at]) walked.push_back(at);
    if (state[at] == unknown) state[at] = beside;
    for (const int n : walked) state[n] = state[at];
    if (state[joint] != below) return false;
  }
  return true;
}

void SceneWriter::write_skins() {
  for (const Skin& skin : character_.skins) {
    Json json = detail::carried_json(skin.carried, fmt::format("skin {}: carried", skin.name));
    if (!skin.name.empty()) json["name"] = skin.name;
    json["joints"] = skin.joints;
    if (skin.skeleton >= 0 && is_above_all(skin.skeleton, skin.joints)) json["skeleton"] = skin.skeleton;
    if (skin.method == SkinningMethod::dual_quaternion)
      json["extensions"][detail::vendor_extension]["method"] = "dualQuaternion";
    skins.push_back(std::move(json));
  }
}

/// The file's own scenes, with the new roots in the shown one; otherwise one scene of all roots.
void SceneWriter::write_scenes(const Json& carried) {
  const auto is_root = [&](const Json& node) {
    return node.is_number_integer() && node.get<std::int64_t>() >= 0 &&
           node.get<std::int64_t>() < static_cast<std::int64_t>(parents_.size()) &&
           parents_[node.get<int>()] < 0;
  };
  std::set<int> placed;
  if (carried.contains("scenes") && carried["scenes"].is_array())
    for (Json scene_json : carried["scenes"]) {
      if (!scene_json.is_object()) continue;
      Json kept = Json::array();
      if (scene_json.contains("nodes") && scene_json["nodes"].is_array())
        for (const Json& node : scene_json["nodes"])
          if (is_root(node) && placed.insert(node.get<int>()).second) kept.push_back(node);
      scene_json["nodes"] = kept;
      scenes.push_back(std::move(scene_json));
    }
  if (scenes.empty()) scenes.push_back({{"nodes", Json::array()}});
  if (carried.contains("scene") && carried["scene"].is_number_unsigned() &&
      carried["scene"].get<std::uint64_t>() < scenes.size())
    scene = carried["scene"].get<int>();
  // Joints of a part that is shown have to be in the scene, whoever added them.
  std::set<int> joint_roots;
  for (const Skin& skin : character_.skins)
    for (int joint : skin.joints) {
      while (parents_[joint] >= 0) joint = parents_[joint];
      joint_roots.insert(joint);
    }
  const auto was_placed = [&](int n) {  // a root that the file showed nowhere stays unseen
    if (joint_roots.contains(n)) return false;
    return n < static_cast<int>(character_.nodes.size()) && carried.contains("scenes") &&
           character_.nodes[n].parent < 0;
  };
  for (int n = 0; n < static_cast<int>(parents_.size()); ++n)
    if (parents_[n] < 0 && !placed.contains(n) && !was_placed(n)) scenes[scene]["nodes"].push_back(n);
  for (Json& one : scenes)
    if (one["nodes"].empty()) one.erase("nodes");
}

/// The base colour that carried material JSON says; white where it says none.
Eigen::Vector4f carried_color(const Json& material) {
  Eigen::Vector4f color = Eigen::Vector4f::Ones();
  const auto pbr = material.find("pbrMetallicRoughness");
  if (pbr == material.end() || !pbr->is_object() || !pbr->contains("baseColorFactor")) return color;
  const Json& factor = (*pbr)["baseColorFactor"];
  for (std::size_t k = 0; factor.is_array() && k < 4 && k < factor.size(); ++k)
    if (factor[k].is_number()) color[k] = factor[k].get<float>();
  return color;
}

Json write_materials(const Appearance& appearance) {
  Json materials = Json::array();
  for (const Material& material : appearance.materials) {
    Json json = detail::carried_json(material.carried, fmt::format("material {}: carried", material.name));
    if (material.carried.empty())
      json["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}};
    if (carried_color(json) != material.base_color)
      json["pbrMetallicRoughness"]["baseColorFactor"] =
          std::vector<float>(material.base_color.data(), material.base_color.data() + 4);
    if (!material.name.empty()) json["name"] = material.name;
    materials.push_back(std::move(json));
  }
  return materials;
}

std::string sniffed_type(const Image& image) {
  if (!image.mime_type.empty()) return image.mime_type;
  const std::vector<unsigned char>& b = image.bytes;
  if (b.size() > 3 && b[0] == 0xFF && b[1] == 0xD8) return "image/jpeg";
  if (b.size() > 12 && std::memcmp(b.data() + 8, "WEBP", 4) == 0) return "image/webp";
  if (b.size() > 8 && std::memcmp(b.data() + 1, "KTX 20", 6) == 0) return "image/ktx2";
  return "image/png";
}

Json write_images(const Appearance& appearance, GltfBuilder& builder) {
  Json images = Json::array();
  for (const Image& image : appearance.images) {
    Json json = detail::carried_json(image.carried, fmt::format("image {}: carried", image.name));
    if (!image.name.empty()) json["name"] = image.name;
    if (!image.bytes.empty()) {
      json["bufferView"] = builder.add_bytes(image.bytes);
      json["mimeType"] = sniffed_type(image);
    } else {
      json["uri"] = image.uri.empty() ? "missing.png" : image.uri;
      if (!image.mime_type.empty()) json["mimeType"] = image.mime_type;
    }
    images.push_back(std::move(json));
  }
  return images;
}

void write_extension_lists(const Character& character, GltfBuilder& builder, Json& root) {
  const std::set<std::string> rebuilt = {"KHR_mesh_quantization", "EXT_meshopt_compression",
                                         detail::vendor_extension};
  std::set<std::string> used, required;
  for (const auto& [key, names] :
       {std::pair("extensionsUsed", &used), std::pair("extensionsRequired", &required)})
    if (root.contains(key) && root[key].is_array())
      for (const Json& name : root[key])
        if (name.is_string() && !rebuilt.contains(name.get<std::string>()))
          names->insert(name.get<std::string>());
  const Json vendor = detail::vendor_root(character, builder);
  if (!vendor.empty()) root["extensions"][detail::vendor_extension] = vendor;
  bool within = false;
  for (const char* list : {"meshes", "skins", "animations"})
    for (const Json& element : root.value(list, Json::array()))
      within = within ||
               (element.contains("extensions") && element["extensions"].contains(detail::vendor_extension));
  if (within || !vendor.empty()) used.insert(detail::vendor_extension);
  if (builder.compressed_any()) {
    used.insert("EXT_meshopt_compression");
    required.insert("EXT_meshopt_compression");
  }
  root["extensionsUsed"] = used;
  root["extensionsRequired"] = required;
}

Json character_json(const Character& character, GltfBuilder& builder) {
  Json root = detail::carried_json(character.carried, "carried");
  for (const char* key : {"scenes", "scene"}) root.erase(key);
  SceneWriter scene(character);
  scene.write();
  for (std::size_t s = 0; s < character.skins.size(); ++s) {
    const Skin& skin = character.skins[s];
    if (!skin.has_inverse_bind) continue;
    std::vector<float> matrices;
    for (const Eigen::Matrix4d& matrix : skin.inverse_bind)
      for (int k = 0; k < 16; ++k) matrices.push_back(static_cast<float>(matrix.data()[k]));
    scene.skins[s]["inverseBindMatrices"] = builder.add_floats(matrices, 16);
  }
  if (!root.contains("asset") || !root["asset"].is_object()) root["asset"] = Json::object();
  root["asset"]["version"] = "2.0";
  root["asset"]["generator"] = "mien";
  root["meshes"] = detail::write_meshes(character, builder);
  root["animations"] = detail::write_animations(character, scene.node_of_part, builder);
  root["nodes"] = std::move(scene.nodes);
  root["scenes"] = std::move(scene.scenes);
  root["scene"] = scene.scene;
  root["skins"] = std::move(scene.skins);
  root["materials"] = write_materials(character.appearance);
  root["images"] = write_images(character.appearance, builder);
  for (const auto& [key, texts] : {std::pair("textures", &character.appearance.textures),
                                   std::pair("samplers", &character.appearance.samplers)}) {
    root[key] = Json::array();
    for (const std::string& text : *texts) root[key].push_back(detail::carried_json(text, key));
  }
  write_extension_lists(character, builder, root);
  root["accessors"] = std::move(builder.accessors());
  root["bufferViews"] = std::move(builder.views());
  for (auto member = root.begin(); member != root.end();)  // glTF forbids empty arrays
    member = member->is_array() && member->empty() ? root.erase(member) : std::next(member);
  return root;
}

/// .gltf in small or large letters.
bool is_text_form(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".gltf";
}

void append_word(std::vector<std::uint8_t>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::vector<std::uint8_t> binary_container(const Json& root, const std::vector<std::uint8_t>& buffer) {
  std::string text = detail::json_text(root);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (buffer.empty() ? 0 : 8 + buffer.size());
  if (total > 0xFFFFFFFF)
    throw io_error("file", "would be larger than 4 GB", "write it as .gltf, or compressed");
  std::vector<std::uint8_t> bytes;
  bytes.reserve(total);
  for (const std::size_t value :
       {std::size_t{0x46546C67}, std::size_t{2}, total, text.size(), std::size_t{0x4E4F534A}})
    append_word(bytes, value);
  bytes.insert(bytes.end(), text.begin(), text.end());
  if (buffer.empty()) return bytes;
  append_word(bytes, buffer.size());
  append_word(bytes, 0x004E4942);
  bytes.insert(bytes.end(), buffer.begin(), buffer.end());
  return bytes;
}

}  // namespace

namespace detail {

std::vector<int> written_nodes_of_parts(const Character& character) {
  SceneWriter scene(character);
  scene.write();
  return scene.node_of_part;
}

Json carried_json(const std::string& text, const std::string& place) {
  if (text.empty()) return Json::object();
  Json json = parse_json(text, place);
  if (!json.is_object()) throw invalid_input(place, "is not a JSON object", "carry members as one object");
  return json;
}

}  // namespace detail

Character read_gltf(const std::filesystem::path& path) {
  try {
    detail::GltfDocument document(path);
    Character character;
    detail::read_nodes(document, character);
    detail::read_skins(document, character);
    detail::read_appearance(document, character);
    const std::vector<detail::PartSource> sources = detail::read_parts(document, character);
    detail::read_vendor(document, sources, character);
    detail::read_clips(document, sources, character);
    Json carried = detail::carried_json(
        document.root().others({"accessors", "bufferViews", "buffers", "nodes", "meshes", "skins",
                                "animations", "materials", "textures", "samplers", "images"}),
        "file");
    if (carried.contains("extensions") && carried["extensions"].is_object()) {
      carried["extensions"].erase(detail::vendor_extension);
      if (carried["extensions"].empty()) carried.erase("extensions");
    }
    character.carried = detail::json_text(carried);
    return character;
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

void write_gltf(const Character& character, const std::filesystem::path& path, const SaveOptions& options) {
  try {
    require_valid(character);
    GltfBuilder builder(options.compress);
    const std::optional<Character> listed = detail::with_shapes_of_objects(character);
    Json root = character_json(listed ? *listed : character, builder);
    std::vector<std::uint8_t>& buffer = builder.buffer();
    buffer.resize((buffer.size() + 3) / 4 * 4);
    if (!buffer.empty()) root["buffers"].push_back({{"byteLength", buffer.size()}});
    if (builder.compressed_any())
      root["buffers"].push_back({{"byteLength", builder.fallback_size()},
                                 {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    if (is_text_form(path)) {
      std::filesystem::path beside = path;
      beside.replace_extension(".bin");
      if (!buffer.empty()) {
        root["buffers"][0]["uri"] = detail::encode_uri(beside.filename().string());
        write_file_atomically(beside, buffer);
      }
      write_file_atomically(path, detail::json_text(root, 1));
    } else {
      write_file_atomically(path, binary_container(root, buffer));
    }
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
