#include <gmock/gmock.h>

#include "mien/io/gltf.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using nlohmann::json;
using test::error_of;
using test::Folder;
using test::GltfText;
using test::one_quad;
using testing::ElementsAre;

Character read(const GltfText& gltf) {
  const Folder folder;
  return load(folder.write("face.gltf", gltf.text()));
}

TEST(read_gltf, triangles_strips_fans_and_no_indices_give_faces) {
  GltfText gltf = one_quad();
  gltf.primitive()["mode"] = 5;
  gltf.primitive()["indices"] = gltf.shorts({0, 1, 3, 2});
  EXPECT_THAT(read(gltf).parts.at(0).mesh.faces.corners(), ElementsAre(0, 1, 3, 3, 1, 2));
  gltf.primitive()["mode"] = 6;
  gltf.primitive()["indices"] = gltf.shorts({0, 1, 2, 3});
  EXPECT_THAT(read(gltf).parts.at(0).mesh.faces.corners(), ElementsAre(0, 1, 2, 0, 2, 3));
  gltf.primitive().erase("indices");
  EXPECT_THAT(read(gltf).parts.at(0).mesh.faces.corners(), ElementsAre(0, 1, 2, 0, 2, 3));
}

TEST(read_gltf, lines_make_a_part_without_faces) {
  GltfText gltf = one_quad();
  gltf.primitive()["mode"] = 1;
  const Character character = read(gltf);
  ASSERT_EQ(character.parts.size(), 1u);
  EXPECT_TRUE(character.parts[0].mesh.faces.empty());
  ASSERT_EQ(character.parts[0].mesh.loose.size(), 1u);
  EXPECT_TRUE(character.parts[0].mesh.loose[0].lines);
  EXPECT_EQ(character.nodes.size(), 1u);
}

TEST(read_gltf, strides_step_over_what_lies_between) {
  GltfText gltf = one_quad();
  std::vector<float> interleaved;
  for (int v = 0; v < 4; ++v) interleaved.insert(interleaved.end(), {float(v), 1.f, 2.f, 9.f});
  gltf.primitive()["attributes"]["POSITION"] = gltf.accessor(gltf.view(interleaved, 16), 5126, "VEC3", 4);
  EXPECT_EQ(read(gltf).parts[0].mesh.positions.row(3), Eigen::RowVector3f(3, 1, 2));
}

TEST(read_gltf, integers_are_quantised_positions_and_normalised_ones_are_fractions) {
  GltfText gltf = one_quad();
  gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int shorts = gltf.view(std::vector<std::int16_t>{0, 0, 0, 7, 0, 0, 0, 0, 0, 32767, -32768, 0}, 6);
  gltf.primitive()["attributes"]["POSITION"] = gltf.accessor(shorts, 5122, "VEC3", 4);
  EXPECT_EQ(read(gltf).parts[0].mesh.positions(2, 0), 0.f);
  EXPECT_EQ(read(gltf).parts[0].mesh.positions(3, 0), 32767.f);
  gltf.root["accessors"].back()["normalized"] = true;
  EXPECT_EQ(read(gltf).parts[0].mesh.positions(3, 0), 1.f);
  EXPECT_EQ(read(gltf).parts[0].mesh.positions(3, 1), -1.f);
  EXPECT_EQ(read(gltf).parts[0].mesh.positions(1, 0), 7 / 32767.f);
}

TEST(read_gltf, sparse_rows_replace_those_of_the_base_or_of_zeros) {
  GltfText gltf = one_quad();
  const json sparse = {
      {"count", 2},
      {"indices", {{"bufferView", gltf.view(std::vector<std::uint8_t>{1, 3})}, {"componentType", 5121}}},
      {"values", {{"bufferView", gltf.view(std::vector<float>{9, 9, 9, 8, 8, 8})}}}};
  gltf.root["accessors"][0]["sparse"] = sparse;
  const int zeros = gltf.accessor(-1, 5126, "VEC3", 4);
  gltf.root["accessors"][zeros]["sparse"] = sparse;
  gltf.primitive()["targets"] = {{{"POSITION", zeros}}};
  const Character c = read(gltf);
  EXPECT_EQ(c.parts[0].mesh.positions.row(1), Eigen::RowVector3f(9, 9, 9));
  EXPECT_EQ(c.parts[0].mesh.positions.row(2), Eigen::RowVector3f(1, 1, 0));
  EXPECT_EQ(c.shapes.at(0).name, "face.target_0");
  EXPECT_THAT(c.shapes[0].parts.at(0).vertices, ElementsAre(1, 3));
  EXPECT_EQ(c.shapes[0].parts[0].deltas.row(1), Eigen::RowVector3f(8, 8, 8));
}

TEST(read_gltf, primitives_share_a_vertex_range_or_follow_one_another) {
  GltfText gltf = one_quad();
  json shared = gltf.primitive(), own = gltf.primitive();
  shared["indices"] = gltf.shorts({3, 2, 1});
  own["attributes"]["POSITION"] = gltf.floats({5, 0, 0, 6, 0, 0, 5, 1, 0}, "VEC3", 3);
  own["attributes"]["TEXCOORD_0"] = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
  own["indices"] = gltf.shorts({0, 1, 2});
  gltf.root["meshes"][0]["primitives"].push_back(shared);
  gltf.root["meshes"][0]["primitives"].push_back(own);
  const Mesh mesh = read(gltf).parts.at(0).mesh;
  EXPECT_EQ(mesh.vertex_count(), 7u);
  EXPECT_THAT(mesh.faces.corners(), ElementsAre(0, 1, 2, 0, 2, 3, 3, 2, 1, 4, 5, 6));
  ASSERT_EQ(mesh.groups.size(), 3u);
  EXPECT_EQ(mesh.groups[1].vertex_end, 4);
  EXPECT_EQ(mesh.groups[2].vertex_begin, 4);
  EXPECT_EQ(mesh.groups[2].vertex_end, 7);
  ASSERT_EQ(mesh.uvs.size(), 1u);
  EXPECT_EQ(mesh.uvs[0].coordinates.row(0), Eigen::RowVector2f(0, 0));  // the range without UVs
  EXPECT_EQ(mesh.uvs[0].coordinates.row(4), Eigen::RowVector2f(0, 1));  // v points up
}

TEST(read_gltf, parts_come_in_the_order_of_their_meshes_and_one_mesh_may_be_two_parts) {
  GltfText gltf = one_quad();
  gltf.root["meshes"].push_back(gltf.root["meshes"][0]);
  gltf.root["meshes"][1]["name"] = "other";
  gltf.root["nodes"] = {{{"mesh", 1}}, {{"mesh", 0}, {"name", "left"}}, {{"mesh", 0}, {"name", "right"}}};
  const Character c = read(gltf);
  ASSERT_EQ(c.parts.size(), 3u);
  EXPECT_EQ(c.parts[0].name, "left");
  EXPECT_EQ(c.parts[1].name, "right");
  EXPECT_EQ(c.parts[2].name, "other");
  EXPECT_EQ(c.parts[2].node, 0);
}

TEST(read_gltf, shapes_of_one_name_are_one_shape_and_each_part_keeps_its_order) {
  GltfText gltf = one_quad();
  const int delta = gltf.floats({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3", 3);
  const auto mesh = [&](std::vector<std::string> names) {
    json result = gltf.root["meshes"][0];
    for (std::size_t t = 0; t < names.size(); ++t)
      result["primitives"][0]["targets"].push_back({{"POSITION", delta}});
    result["extras"]["targetNames"] = names;
    return result;
  };
  gltf.root["meshes"] = {mesh({"jawOpen", "smile"}), mesh({"jawOpen", "tongueOut", "smile"})};
  gltf.root["meshes"][0]["weights"] = {0.5, 0};
  gltf.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
  const Character c = read(gltf);
  ASSERT_EQ(c.shapes.size(), 3u);
  EXPECT_EQ(c.shapes[0].name, "jawOpen");
  EXPECT_EQ(c.sliders[0].rest, 0.5);
  EXPECT_EQ(c.shapes[0].parts.size(), 2u);
  EXPECT_EQ(c.shapes[1].name, "tongueOut");
  EXPECT_EQ(c.shapes[1].parts.at(0).part, 1);
  EXPECT_EQ(c.shapes[2].name, "smile");
}

TEST(read_gltf, skins_without_bind_matrices_and_byte_weights) {
  GltfText gltf = one_quad();
  gltf.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "a"}, {"children", {2}}}, {{"name", "b"}}};
  gltf.root["skins"] = {{{"joints", {1, 2}}}};
  gltf.primitive()["attributes"]["JOINTS_0"] = gltf.accessor(
      gltf.view(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0}), 5121, "VEC4", 4);
  const int weights = gltf.accessor(
      gltf.view(std::vector<std::uint8_t>{51, 204, 0, 0, 255, 0, 0, 0, 100, 155, 0, 0, 0, 0, 0, 0}), 5121,
      "VEC4", 4);
  gltf.root["accessors"][weights]["normalized"] = true;
  gltf.primitive()["attributes"]["WEIGHTS_0"] = weights;
  const Character c = read(gltf);
  EXPECT_FALSE(c.skins.at(0).has_inverse_bind);
  EXPECT_EQ(c.skins[0].inverse_bind.at(1), Eigen::Matrix4d::Identity());
  const SkinWeights& skin = c.parts[0].skin_weights;
  EXPECT_THAT(skin.offsets, ElementsAre(0, 2, 3, 4, 5));
  EXPECT_THAT(skin.joints,
              ElementsAre(1, 0, 0, 1, 0));  // strongest first; twice the same joint is once; none is joint 0
  EXPECT_THAT(skin.weights, ElementsAre(204 / 255.f, 51 / 255.f, 1.f, 1.f, 1.f));
}

TEST(read_gltf, files_beside_a_gltf_have_percent_encoded_names) {
  const Folder folder;
  const GltfText gltf = one_quad();
  json root = json::parse(gltf.text());
  root["buffers"][0]["uri"] = "my%20data.bin";
  write_file_atomically(folder / "my data.bin", gltf.bytes);
  EXPECT_EQ(load(folder.write("face.gltf", root.dump())).parts.at(0).mesh.vertex_count(), 4u);
}

TEST(read_gltf, images_come_from_views_uris_and_files) {
  const Folder folder;
  GltfText gltf = one_quad();
  gltf.root["images"] = {
      {{"bufferView", gltf.view(std::vector<std::uint8_t>{1, 2, 3})}, {"mimeType", "image/png"}},
      {{"uri", "data:image/jpeg;base64,BAUG"}},
      {{"uri", "skin.png"}},
      {{"uri", "missing.png"}}};
  folder.write("skin.png", "png");
  const Character c = load(folder.write("face.gltf", gltf.text()));
  ASSERT_EQ(c.appearance.images.size(), 4u);
  EXPECT_EQ(c.appearance.images[0].bytes, (std::vector<unsigned char>{1, 2, 3}));
  EXPECT_EQ(c.appearance.images[1].bytes, (std::vector<unsigned char>{4, 5, 6}));
  EXPECT_EQ(c.appearance.images[1].mime_type, "image/jpeg");
  EXPECT_EQ(c.appearance.images[2].bytes.size(), 3u);
  EXPECT_EQ(c.appearance.images[3].uri, "missing.png");
}

TEST(read_gltf, unknown_extensions_extras_and_scenes_are_carried_to_the_next_file) {
  const Folder folder;
  GltfText gltf = one_quad();
  gltf.root["extensionsUsed"] = {"KHR_lights_punctual", "ACME_thing"};
  gltf.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}},
                             {"ACME_thing", {{"a", 1}}}};
  gltf.root["nodes"].push_back({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  gltf.root["nodes"][0]["extras"] = {{"id", 7}};
  gltf.primitive()["extras"] = {{"p", 2}};
  gltf.root["scenes"] = {{{"name", "first"}, {"nodes", {1}}}, {{"name", "second"}, {"nodes", {0}}}};
  gltf.root["scene"] = 1;
  save(load(folder.write("face.gltf", gltf.text())), folder / "again.gltf");
  const std::vector<std::uint8_t> bytes = read_file(folder / "again.gltf");
  const json again = json::parse(bytes.begin(), bytes.end());
  EXPECT_EQ(again["extensions"], gltf.root["extensions"]);
  EXPECT_EQ(again["scenes"], gltf.root["scenes"]);
  EXPECT_EQ(again["scene"], 1);
  EXPECT_EQ(again["nodes"][0]["extras"]["id"], 7);
  EXPECT_EQ(again["nodes"][1]["extensions"], gltf.root["nodes"][1]["extensions"]);
  EXPECT_EQ(again["meshes"][0]["primitives"][0]["extras"]["p"], 2);
  EXPECT_THAT(again["extensionsUsed"], testing::Contains("ACME_thing"));
}

TEST(read_gltf, an_empty_scene_is_an_empty_character) {
  GltfText gltf;
  const Folder folder;
  EXPECT_TRUE(load(folder.write("a.gltf", gltf.root.dump())).parts.empty());
}

}  // namespace
}  // namespace mien
