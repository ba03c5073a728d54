#include <gmock/gmock.h>

#include "full_character.h"
#include "mien/io/gltf.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::expect_same;
using test::Folder;
using ::testing::HasSubstr;

using test::channel;
using test::delta;
using test::full_character;
using test::seamed_part;

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

TEST(gltf_round_trip, ngons_seams_and_groups_of_an_obj_come_back) {
  const Folder folder;
  Character c;
  c.parts = {seamed_part()};
  c.shapes.resize(1);
  c.shapes[0].name = "up";
  c.shapes[0].parts = {delta(0, {2, 3}, 1.f)};
  complete_sliders(c);
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

/// The full character; two of its clip's shapes move on keys of their own.
Character with_own_keys() {
  Character c = full_character();
  c.clips[0].channels.resize(4);
  Channel linear = channel(Channel::Property::shape_weight, 1, Interpolation::linear, {0, 1});
  linear.times = {0, 1};
  c.clips[0].channels[3] = linear;
  linear.shape = 0;
  linear.times = {0.5f, 2};
  c.clips[0].channels.push_back(linear);
  return c;
}

TEST(gltf_round_trip, weights_channels_keep_their_own_keys) {
  const Folder folder;
  const Character c = with_own_keys();
  save(c, folder / "talk.glb");
  const Clip again = load(folder / "talk.glb").clips.at(0);
  for (const int shape : {0, 1}) {
    const auto of_shape = [&](const Channel& k) { return k.shape == shape; };
    const auto& was = c.clips[0].channels;
    const auto before = std::find_if(was.begin(), was.end(), of_shape);
    ASSERT_EQ(std::count_if(again.channels.begin(), again.channels.end(), of_shape), 1);
    const auto after = std::find_if(again.channels.begin(), again.channels.end(), of_shape);
    EXPECT_EQ(after->times, before->times);
    EXPECT_EQ(after->values, before->values);
    EXPECT_EQ(after->part, before->part);
    EXPECT_EQ(after->interpolation, before->interpolation);
  }
}

TEST(gltf_round_trip, own_keys_of_shapes_that_the_file_does_not_have_are_said) {
  const Folder folder;
  save(with_own_keys(), folder / "talk.gltf");
  const nlohmann::json good = nlohmann::json::parse(read_file(folder / "talk.gltf"));
  const auto error_with = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json file = good;
    file["animations"][0]["extensions"]["MIEN_character"]["weights"][0][key] = value;
    const auto path = folder.write("talk.gltf", file.dump());
    return test::error_of([&] { load(path); });
  };
  EXPECT_THAT(error_with("shape", "gone"), HasSubstr("names gone; name one of the shapes"));
  EXPECT_THAT(error_with("mesh", 99), HasSubstr("is 99; name a mesh in use"));
  EXPECT_THAT(error_with("input", 9999), HasSubstr("input"));
}

TEST(gltf_round_trip, other_programs_see_weights_channels_united_exactly) {
  const Folder folder;
  save(with_own_keys(), folder / "talk.gltf");
  nlohmann::json file = nlohmann::json::parse(read_file(folder / "talk.gltf"));
  file["animations"][0].erase("extensions");
  const Clip clip = load(folder.write("talk.gltf", file.dump())).clips.at(0);
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

TEST(gltf_round_trip, a_part_without_faces_comes_back) {
  const Folder folder;
  Character c;
  c.parts.resize(1);
  c.parts[0].name = "points";
  c.parts[0].mesh.positions = Points::Random(5, 3);
  save(c, folder / "points.glb");
  const Character again = load(folder / "points.glb");
  ASSERT_EQ(again.parts.size(), 1u);
  test::expect_same_mesh(c.parts[0].mesh, again.parts[0].mesh);
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
