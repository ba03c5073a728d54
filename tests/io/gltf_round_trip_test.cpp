#include <gmock/gmock.h>

#include "mien/io/gltf.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::expect_same;
using test::Folder;

Points rows(std::initializer_list<Eigen::RowVector3f> values) {
  Points points(static_cast<Eigen::Index>(values.size()), 3);
  Eigen::Index r = 0;
  for (const Eigen::RowVector3f& value : values) points.row(r++) = value;
  return points;
}

/// A 5 x 5 grid with two UV sets, colours, tangents and normals.
Mesh grid() {
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

PartDelta delta(int part, std::vector<int> vertices, float size) {
  PartDelta d;
  d.part = part;
  d.deltas = Points::Constant(static_cast<Eigen::Index>(vertices.size()), 3, size);
  for (Eigen::Index k = 0; k < d.deltas.rows(); ++k) d.deltas(k, 1) += 0.1f * float(k);
  d.vertices = std::move(vertices);
  return d;
}

Channel channel(Channel::Property property, int target, Interpolation interpolation,
                std::vector<float> values) {
  Channel c;
  c.property = property;
  (property == Channel::Property::shape_weight ? c.shape : c.node) = target;
  c.interpolation = interpolation;
  c.times = {0, 0.5f, 2};
  c.values = std::move(values);
  return c;
}

SkinWeights six_influences() {
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

void add_nodes(Character& c) {
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
Character full_character() {
  Character c;
  add_nodes(c);
  Skin skin;
  skin.name = "rig";
  skin.joints = {0, 1, 2, 3, 4, 5};
  skin.skeleton = 0;
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
  c.shapes[0].rest = 0.25;
  c.shapes[0].parts = {delta(0, {3, 7, 9}, 0.5f), delta(1, {0, 1, 2}, -0.5f)};
  c.shapes[1].name = "smile";
  std::vector<int> all(25);
  for (int v = 0; v < 25; ++v) all[v] = v;
  c.shapes[1].parts = {delta(0, all, 0.01f)};
  c.shapes[1].parts[0].normal_deltas = Points::Constant(25, 3, 0.1f);
  c.shapes[2].name = "nothing";
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
  c.appearance.images[0].bytes = {0x89, 'P', 'N', 'G', 1, 2, 3};
  c.appearance.textures = {R"({"sampler":0,"source":0})"};
  c.appearance.samplers = {R"({"wrapS":33071})"};
  c.carried = R"({"asset":{"copyright":"me"},"extras":{"scene":"x"}})";
  return c;
}

TEST(gltf_round_trip, everything_comes_back_through_both_forms) {
  const Folder folder;
  const Character c = full_character();
  for (const char* name : {"full.glb", "full.gltf"}) {
    SCOPED_TRACE(name);
    save(c, folder / name);
    const Character again = load(folder / name);
    // The part without normals was written with computed ones, and knows it.
    expect_same(c, again);
    const nlohmann::json carried = nlohmann::json::parse(again.carried);
    EXPECT_EQ(carried["asset"]["copyright"], "me");
    EXPECT_EQ(carried["extras"]["scene"], "x");
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "full.bin"));
}

TEST(gltf_round_trip, writing_twice_gives_the_same_bytes) {
  const Folder folder;
  save(full_character(), folder / "a.glb");
  save(full_character(), folder / "b.glb");
  save(load(folder / "a.glb"), folder / "c.glb");
  EXPECT_EQ(read_file(folder / "a.glb"), read_file(folder / "b.glb"));
  save(load(folder / "c.glb"), folder / "d.glb");
  EXPECT_EQ(read_file(folder / "c.glb"), read_file(folder / "d.glb"));
}

TEST(gltf_round_trip, compressed_files_keep_everything_within_their_error) {
  const Folder folder;
  const Character c = full_character();
  SaveOptions options;
  options.compress = true;
  save(c, folder / "small.glb", options);
  const Character again = load(folder / "small.glb");
  for (std::size_t p = 0; p < c.parts.size(); ++p) {
    const double error = 1e-5 * bounding_box(c.parts[p].mesh.positions).diagonal();
    EXPECT_LE((c.parts[p].mesh.positions - again.parts[p].mesh.positions).rowwise().norm().maxCoeff(), error);
    EXPECT_EQ(c.parts[p].mesh.faces, again.parts[p].mesh.faces);
    EXPECT_EQ(c.parts[p].skin_weights, again.parts[p].skin_weights);
  }
  ASSERT_EQ(again.shapes.size(), 3u);
  for (int s : {0, 1}) {
    EXPECT_EQ(c.shapes[s].parts[0].vertices, again.shapes[s].parts[0].vertices);
    EXPECT_LE((c.shapes[s].parts[0].deltas - again.shapes[s].parts[0].deltas).cwiseAbs().maxCoeff(), 1e-5);
  }
  test::expect_same_clips(c, again);
  test::expect_same_uvs(c.parts[0].mesh.uvs, again.parts[0].mesh.uvs, 1e-5f);
}

/// An OBJ-like quad strip whose middle edge is a UV seam, with named groups.
Part seamed_part() {
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

TEST(gltf_round_trip, ngons_seams_and_groups_of_an_obj_come_back) {
  const Folder folder;
  Character c;
  c.parts = {seamed_part()};
  c.shapes.resize(1);
  c.shapes[0].name = "up";
  c.shapes[0].parts = {delta(0, {2, 3}, 1.f)};
  save(c, folder / "strip.glb");
  const Character again = load(folder / "strip.glb");
  test::expect_same_mesh(c.parts[0].mesh, again.parts[0].mesh);
  test::expect_same_shapes(c, again);
  // Another program sees the copies after the file's own vertices, moving with them.
  nlohmann::json root;
  const std::vector<std::uint8_t> bytes = read_file(folder / "strip.glb");
  root = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + (bytes[12] | bytes[13] << 8));
  EXPECT_EQ(
      root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<int>()]["count"], 9);
  EXPECT_EQ(root["meshes"][0]["primitives"].size(), 1u);
  EXPECT_FALSE(root.contains("extensionsRequired"));
}

TEST(gltf_round_trip, a_mesh_that_another_program_changed_is_read_as_plain) {
  const Folder folder;
  Character c;
  c.parts = {seamed_part()};
  save(c, folder / "strip.gltf");
  const std::vector<std::uint8_t> bytes = read_file(folder / "strip.gltf");
  nlohmann::json root = nlohmann::json::parse(bytes.begin(), bytes.end());
  root["meshes"][0]["extensions"]["MIEN_character"]["vertexCount"] = 5;
  const Character again = load(folder.write("strip.gltf", root.dump()));
  EXPECT_EQ(again.parts[0].mesh.vertex_count(), 9u);
  EXPECT_EQ(again.parts[0].mesh.faces.size(), 4u);
}

TEST(gltf_round_trip, a_skinned_mesh_below_a_moved_node_becomes_a_root) {
  const Folder folder;
  Character c = full_character();
  c.nodes[6].parent = 7;
  c.nodes[6].rest.translation = {1, 2, 3};
  save(c, folder / "root.glb");
  const Character again = load(folder / "root.glb");
  EXPECT_EQ(again.nodes[6].parent, -1);
  EXPECT_EQ(again.nodes.size(), c.nodes.size());
  EXPECT_EQ(again.parts[0].mesh.positions, c.parts[0].mesh.positions);
}

TEST(gltf_round_trip, joints_of_several_trees_get_a_common_root) {
  const Folder folder;
  Character c = full_character();
  c.nodes[3].parent = -1;
  save(c, folder / "root.glb");
  const Character again = load(folder / "root.glb");
  ASSERT_EQ(again.nodes.size(), c.nodes.size() + 1);
  EXPECT_EQ(again.nodes[3].parent, 8);
  EXPECT_EQ(again.nodes[0].parent, 8);
}

TEST(gltf_round_trip, weights_channels_with_keys_of_their_own_are_united_exactly) {
  const Folder folder;
  Character c = full_character();
  c.clips[0].channels.resize(4);
  Channel linear = channel(Channel::Property::shape_weight, 1, Interpolation::linear, {0, 1});
  linear.times = {0, 1};
  c.clips[0].channels[3] = linear;
  linear.shape = 0;
  linear.times = {0.5f, 2};
  c.clips[0].channels.push_back(linear);
  save(c, folder / "talk.glb");
  const Clip clip = load(folder / "talk.glb").clips.at(0);
  const auto found =
      std::find_if(clip.channels.begin(), clip.channels.end(), [](const Channel& k) { return k.shape == 1; });
  ASSERT_NE(found, clip.channels.end());
  EXPECT_EQ(found->times, (std::vector<float>{0, 0.5f, 1, 2}));
  EXPECT_EQ(found->values, (std::vector<float>{0, 0.5f, 1, 1}));
}

TEST(gltf_round_trip, skin_weights_are_tidied) {
  const Folder folder;
  Character c = full_character();
  SkinWeights& skin = c.parts[0].skin_weights;
  skin = {};
  skin.offsets = {0};
  for (int v = 0; v < 25; ++v) {
    for (const auto& [joint, weight] : {std::pair(1, 0.25f), std::pair(2, 0.5f), std::pair(1, 0.25f)}) {
      skin.joints.push_back(joint);
      skin.weights.push_back(weight);
    }
    skin.offsets.push_back(static_cast<int>(skin.joints.size()));
  }
  save(c, folder / "skin.glb");
  const SkinWeights again = load(folder / "skin.glb").parts[0].skin_weights;
  EXPECT_EQ(again.offsets[1], 2);
  EXPECT_THAT(std::vector<float>(again.weights.begin(), again.weights.begin() + 2),
              testing::ElementsAre(0.5f, 0.5f));
}

TEST(gltf_round_trip, a_part_without_a_node_gets_one) {
  const Folder folder;
  Character c;
  c.parts = {seamed_part()};
  save(c, folder / "a.glb");
  const Character again = load(folder / "a.glb");
  ASSERT_EQ(again.nodes.size(), 1u);
  EXPECT_EQ(again.parts[0].node, 0);
  EXPECT_EQ(again.parts[0].name, "strip");
}

TEST(gltf_round_trip, real_characters_come_back) {
  const std::filesystem::path data(MIEN_SHARED_DATA);
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data";
  const Folder folder;
  for (const char* name :
       {"makehuman/caucasian_male_young.glb", "facecap/facecap.glb", "cases/A1_ict_id1.0/source.glb",
        "cases/B1_mh_african/source.glb", "cases/C_mhrig_afr/source.glb"}) {
    SCOPED_TRACE(name);
    const Character c = load(data / name);
    save(c, folder / "again.glb");
    expect_same(c, load(folder / "again.glb"));
  }
}

}  // namespace
}  // namespace mien
