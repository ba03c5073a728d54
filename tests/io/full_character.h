#pragma once
/// A character with a bit of everything that a file can hold.

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/sliders.h"

namespace mien::test {

inline Points rows(std::initializer_list<Eigen::RowVector3f> values) {
  Points points(static_cast<Eigen::Index>(values.size()), 3);
  Eigen::Index r = 0;
  for (const Eigen::RowVector3f& value : values) points.row(r++) = value;
  return points;
}

/// A 5 x 5 grid with two UV sets, colours, tangents and normals.
inline Mesh grid() {
  Mesh mesh;
  mesh.positions.resize(25, 3);
  Points2 uv(25, 2);
  for (int v = 0; v < 25; ++v) {
    mesh.positions.row(v) << float(v % 5) / 3.f, float(v / 5) / 7.f, 0.1f * float(v % 3);
    uv.row(v) << float(v % 5) / 4, float(v / 5) / 4;
  }
  for (int f = 0; f < 16; ++f) {
    const int a = f / 4 * 5 + f % 4;
    mesh.faces.push_back({a, a + 1, a + 6});
    mesh.faces.push_back({a, a + 6, a + 5});
  }
  mesh.normals = vertex_normals(mesh.positions, triangulate(mesh.faces));
  mesh.tangents = Points4::Zero(25, 4);
  mesh.tangents.col(0).setOnes();
  mesh.tangents.col(3).setConstant(-1);
  mesh.uvs = {{uv, {}}, {uv * 0.5f, {}}};
  mesh.colors = {Points4::Constant(25, 4, 0.25f)};
  mesh.groups = {{"", 0, 0, 20, 0, 25}, {"", 1, 20, 32, 0, 25}};
  return mesh;
}

inline PartDelta delta(int part, std::vector<int> vertices, float size) {
  PartDelta d;
  d.part = part;
  d.deltas = Points::Constant(static_cast<Eigen::Index>(vertices.size()), 3, size);
  for (Eigen::Index k = 0; k < d.deltas.rows(); ++k) d.deltas(k, 1) += 0.1f * float(k);
  d.vertices = std::move(vertices);
  return d;
}

inline Channel channel(Channel::Property property, int target, Interpolation interpolation,
                       std::vector<float> values) {
  Channel c;
  c.property = property;
  (property == Channel::Property::shape_weight ? c.shape : c.node) = target;
  c.interpolation = interpolation;
  c.times = {0, 0.5f, 2};
  c.values = std::move(values);
  return c;
}

inline SkinWeights six_influences() {
  SkinWeights skin;
  skin.offsets = {0};
  for (int v = 0; v < 25; ++v) {
    const std::vector<float> weights =
        v % 2 ? std::vector<float>{0.5f, 0.25f, 0.125f, 0.0625f, 0.03125f, 0.03125f}
              : std::vector<float>{1.f};
    for (std::size_t k = 0; k < weights.size(); ++k) {
      skin.joints.push_back(static_cast<int>(k));
      skin.weights.push_back(weights[k]);
    }
    skin.offsets.push_back(static_cast<int>(skin.joints.size()));
  }
  return skin;
}

inline void add_nodes(Character& c) {
  for (int n = 0; n < 8; ++n) {
    Node node;
    node.name = n < 6 ? "joint" + std::to_string(n) : n == 6 ? "Skin" : "Teeth";
    node.parent = n == 0 || n == 6 ? -1 : n == 7 ? 0 : n - 1;
    node.rest.translation = n == 6 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(0.1, n, 0.3);
    if (n == 2) node.rest.rotation = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5);
    if (n == 3) node.rest.scale = {1, 2, 1};
    if (n == 5) node.carried = R"({"extras":{"side":"left"}})";
    c.nodes.push_back(node);
  }
}

/// A bit of everything that a file can hold.
inline Character full_character() {
  Character c;
  add_nodes(c);
  Skin skin;
  skin.name = "rig";
  skin.joints = {0, 1, 2, 3, 4, 5};
  skin.skeleton = 0;
  skin.method = SkinningMethod::dual_quaternion;
  for (int j = 0; j < 6; ++j) skin.inverse_bind.push_back(Eigen::Matrix4d::Identity() * 1.0);
  skin.inverse_bind[3](0, 3) = 2.5;
  c.skins.push_back(skin);
  Part face;
  face.name = face.mesh_name = "Skin";
  face.mesh = grid();
  face.node = 6;
  face.skin = 0;
  face.skin_weights = six_influences();
  face.carried = R"({"extras":{"artist":"K"}})";
  Part teeth;
  teeth.name = "Teeth";
  teeth.mesh_name = "teeth mesh";
  teeth.mesh.positions = rows({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  teeth.mesh.faces.push_back({0, 1, 2});
  teeth.mesh.groups = {{"", -1, 0, 1, 0, 3}};
  teeth.node = 7;
  c.parts = {face, teeth};
  c.shapes.resize(3);
  c.shapes[0].name = "jawOpen";
  c.shapes[0].parts = {delta(0, {3, 7, 9}, 0.5f), delta(1, {0, 1, 2}, -0.5f)};
  c.shapes[1].name = "smile";
  std::vector<int> all(25);
  for (int v = 0; v < 25; ++v) all[v] = v;
  c.shapes[1].parts = {delta(0, all, 0.01f)};
  c.shapes[1].parts[0].normal_deltas = Points::Constant(25, 3, 0.1f);
  c.shapes[2].name = "nothing";
  complete_sliders(c);
  c.sliders[0].rest = 0.25;
  c.shapes[2].parts = {delta(0, {}, 0)};
  Clip clip;
  clip.name = "talk";
  clip.carried = R"({"extras":{"take":3}})";
  using P = Channel::Property;
  clip.channels = {channel(P::translation, 1, Interpolation::linear, {0, 0, 0, 1, 1, 1, 2, 2, 2}),
                   channel(P::rotation, 2, Interpolation::step, {0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0}),
                   channel(P::scale, 3, Interpolation::cubic_spline, std::vector<float>(27, 1.f)),
                   channel(P::shape_weight, 0, Interpolation::cubic_spline, {0, 0, 1, 0, 1, 0, 2, .5f, 0}),
                   channel(P::shape_weight, 1, Interpolation::cubic_spline, std::vector<float>(9, .5f)),
                   channel(P::shape_weight, 2, Interpolation::cubic_spline, std::vector<float>(9, .125f))};
  c.clips.push_back(clip);
  SurfacePoint nose, lip;
  nose.vertex = 12;
  lip.part = 1;
  lip.face = 0;
  lip.barycentric = {0.25, 0.25, 0.5};
  c.landmarks = {{"noseTip", nose}, {"lip", lip}};
  c.curves = {{"brow", {nose, lip}, 7}};
  c.appearance.materials.resize(2);
  c.appearance.materials[0].name = "skin";
  c.appearance.materials[0].carried =
      R"({"name":"skin","pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"extras":{"a":1}})";
  c.appearance.materials[0].base_color = Eigen::Vector4f::Ones();
  c.appearance.materials[1].name = "gum";
  c.appearance.images.resize(1);
  c.appearance.images[0].name = "albedo";
  c.appearance.images[0].mime_type = "image/png";
  c.appearance.images[0].bytes = {137, 80,  78,  71, 13, 10, 26,  10, 0,   0,  0,  13,  73,  72, 68,
                                  82,  0,   0,   0,  1,  0,  0,   0,  1,   8,  6,  0,   0,   0,  31,
                                  21,  196, 137, 0,  0,  0,  13,  73, 68,  65, 84, 120, 218, 99, 100,
                                  248, 207, 80,  15, 0,  3,  134, 1,  128, 90, 52, 125, 107, 0,  0,
                                  0,   0,   73,  69, 78, 68, 174, 66, 96,  130};  // one pixel
  c.appearance.textures = {R"({"sampler":0,"source":0})"};
  c.appearance.samplers = {R"({"wrapS":33071})"};
  c.carried = R"({"asset":{"copyright":"me"},"extras":{"scene":"x"}})";
  return c;
}

/// An OBJ-like quad strip whose middle edge is a UV seam, with named groups.
inline Part seamed_part() {
  Part part;
  part.name = "strip";
  part.mesh.positions = rows({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}, {5, 5, 5}});
  part.mesh.faces.push_back({0, 2, 3, 1});
  part.mesh.faces.push_back({2, 4, 5, 3});
  UvSet uv;
  uv.coordinates.resize(8, 2);
  uv.coordinates << 0, 0, .5f, 0, .5f, 1, 0, 1, .75f, 0, 1, 0, 1, 1, .75f, 1;
  uv.corners = {0, 1, 2, 3, 4, 5, 6, 7};
  part.mesh.uvs = {uv};
  part.mesh.groups = {{"left", -1, 0, 1, 0, 7}, {"right", -1, 1, 2, 0, 7}};
  return part;
}

}  // namespace mien::test
