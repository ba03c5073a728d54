#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/sample/detail/character_form.h"

namespace mien::sample {

namespace {

/// The skin as a mesh: the red of the lips and the inside of the mouth are groups of their own.
Mesh skin_mesh(const HeadMesh& head) {
  Mesh mesh;
  mesh.positions.resize(head.points.size(), 3);
  for (std::size_t v = 0; v < head.points.size(); ++v) mesh.positions.row(v) = head.points[v].cast<float>();
  std::vector<int> ring(head.points.size(), -1);
  for (std::size_t k = 0; k < head.half.mouth.size(); ++k)
    for (int v : head.half.mouth[k]) ring[v] = ring[head.mirror[v]] = static_cast<int>(k);
  const auto material_of = [&](std::span<const int> face) {
    int lowest = std::numeric_limits<int>::max();
    for (int v : face) lowest = std::min(lowest, ring[v]);
    return lowest < head.half.lip_border ? 0 : lowest <= head.half.lip_contact ? 1 : 2;
  };
  const char* const names[3] = {"skin", "lips", "mouth"};
  const int materials[3] = {skin_material, lip_material, mouth_material};
  UvSet uv;
  uv.coordinates = head.uv.coordinates;
  for (int group = 0; group < 3; ++group) {
    FaceGroup run;
    run.name = names[group];
    run.material = materials[group];
    run.face_begin = static_cast<int>(mesh.faces.size());
    for (std::size_t f = 0; f < head.faces.size(); ++f) {
      if (material_of(head.faces[f]) != group) continue;
      mesh.faces.push_back(head.faces[f]);
      for (int c = head.faces.offset(f); c < head.faces.offset(f + 1); ++c)
        uv.corners.push_back(head.uv.corners[c]);
    }
    run.face_end = static_cast<int>(mesh.faces.size());
    run.vertex_end = static_cast<int>(head.points.size());
    mesh.groups.push_back(run);
  }
  mesh.uvs.push_back(std::move(uv));
  return mesh;
}

void add_part(Character& character, const std::string& name, Mesh mesh) {
  Part part;
  part.name = part.mesh_name = name;
  part.node = static_cast<int>(character.nodes.size());
  mesh.normals = vertex_normals(mesh.positions, triangulate(mesh.faces));
  part.mesh = std::move(mesh);
  Node node;
  node.name = name;
  character.nodes.push_back(node);
  character.parts.push_back(std::move(part));
}

}  // namespace

Material plain_material(const char* name, float red, float green, float blue) {
  const auto linear = [](float s) { return std::pow((s + 0.055f) / 1.055f, 2.4f); };
  Material material;
  material.name = name;
  material.base_color = {linear(red), linear(green), linear(blue), 1};
  return material;
}

BuiltCharacter build_character(const CharacterForm& form) {
  BuiltCharacter built;
  built.head = make_head(form.head);
  Character& character = built.character;
  character.name = form.name;
  character.appearance.materials = form.materials;
  const EyeForm& eye = form.head.eye;
  add_part(character, "Face", skin_mesh(built.head));
  add_part(character, "eyeLeft", make_eyeball(eye.centre, eye.radius, form.iris));
  add_part(character, "eyeRight",
           make_eyeball({-eye.centre.x(), eye.centre.y(), eye.centre.z()}, eye.radius, form.iris));
  add_part(character, "teethUpper", make_teeth(form.upper_teeth));
  add_part(character, "teethLower", make_teeth(form.lower_teeth));
  add_part(character, "tongue", make_tongue(form.tongue));
  if (!form.brows.line.empty()) add_part(character, "brows", make_brows(form.brows, form.head.sculpt));
  if (form.lashes > 0)
    add_part(character, "lashes", make_lashes(built.head, form.head, form.lashes, built.lash_anchors));
  add_landmarks(character, built.head, form);
  return built;
}

Anchors anchors_of(const Mesh& mesh, const HeadMesh& head, const std::vector<int>& given) {
  Anchors anchors(mesh.vertex_count());
  if (!given.empty()) {
    for (std::size_t v = 0; v < anchors.size(); ++v) anchors[v] = {{given[v], 1.0}};
    return anchors;
  }
  const int count = 6;
  for (std::size_t v = 0; v < anchors.size(); ++v) {
    const Vector3d p = mesh.positions.row(v).cast<double>();
    std::vector<std::pair<double, int>> near;
    for (std::size_t s = 0; s < head.points.size(); ++s)
      near.emplace_back((head.points[s] - p).squaredNorm(), static_cast<int>(s));
    std::partial_sort(near.begin(), near.begin() + count, near.end());
    double sum = 0;
    for (int k = 0; k < count; ++k) sum += 1 / (near[k].first + 1e-3);
    for (int k = 0; k < count; ++k) anchors[v].emplace_back(near[k].second, 1 / (near[k].first + 1e-3) / sum);
  }
  return anchors;
}

void place(Character& character, double scale, const Eigen::Quaterniond& turn, const Vector3d& move) {
  const Eigen::Matrix3d rotation = turn.toRotationMatrix();
  const auto direct = [&](Points& points) {
    for (Eigen::Index v = 0; v < points.rows(); ++v)
      points.row(v) = (rotation * points.row(v).transpose().cast<double>()).transpose().cast<float>();
  };
  const auto vector = [&](Points& points) {
    direct(points);
    points *= static_cast<float>(scale);
  };
  for (Part& part : character.parts) {
    vector(part.mesh.positions);
    part.mesh.positions.rowwise() += move.transpose().cast<float>();
    direct(part.mesh.normals);
  }
  for (Shape& shape : character.shapes)
    for (PartDelta& delta : shape.parts) vector(delta.deltas);
  // Joints hang below roots; only those are turned and moved as a whole.
  std::vector<char> is_part(character.nodes.size(), 0);
  for (const Part& part : character.parts)
    if (part.node >= 0) is_part[part.node] = 1;
  for (std::size_t n = 0; n < character.nodes.size(); ++n) {
    Node& node = character.nodes[n];
    if (is_part[n]) continue;
    node.rest.translation *= scale;
    if (node.parent >= 0) continue;
    node.rest.translation = turn * node.rest.translation + move;
    node.rest.rotation = turn * node.rest.rotation;
  }
  const auto matrices = model_matrices(character);
  for (Skin& skin : character.skins)
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
      skin.inverse_bind[j] = matrices[skin.joints[j]].inverse();
  for (Clip& clip : character.clips)
    for (Channel& channel : clip.channels)
      if (channel.property == Channel::Property::translation)
        for (float& value : channel.values) value *= static_cast<float>(scale);
}

}  // namespace mien::sample
