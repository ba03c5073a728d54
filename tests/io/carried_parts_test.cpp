#include <gmock/gmock.h>

#include "full_character.h"
#include "mien/character/validate.h"
#include "mien/io/gltf.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;
using test::GltfText;
using testing::ElementsAre;

/// The quad, with attributes of every stored type.
GltfText quad_with_attributes() {
  GltfText text;
  text.add_quad();
  nlohmann::json& attributes = text.primitive()["attributes"];
  const std::vector<std::uint8_t> bytes = {1, 0, 0, 0, 2, 0, 0, 0, 255, 0, 0, 0, 128, 0, 0, 0};
  attributes["_BYTE"] = text.accessor(text.view(bytes, 4), 5121, "SCALAR", 4);
  const std::vector<std::int8_t> pairs = {-128, 127, 0, 0, 5, -5, 0, 0, 1, 2, 0, 0, 3, 4, 0, 0};
  attributes["_SIGNED"] = text.accessor(text.view(pairs, 4), 5120, "VEC2", 4);
  text.root["accessors"].back()["normalized"] = true;
  const std::vector<std::uint16_t> triples = {1, 2, 3, 0, 4, 5, 6, 0, 65535, 8, 9, 0, 10, 11, 12, 0};
  attributes["_SHORT"] = text.accessor(text.view(triples, 8), 5123, "VEC3", 4);
  const std::vector<std::int16_t> fours = {-32768, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  attributes["_SIGNED_SHORT"] = text.accessor(text.view(fours), 5122, "VEC4", 4);
  attributes["_FLOAT"] = text.floats({0.1f, 0.2f, 1e-20f, -3.5f}, "SCALAR", 1);
  return text;
}

const VertexAttribute& attribute(const Mesh& mesh, const std::string& name) {
  for (const VertexAttribute& one : mesh.attributes)
    if (one.name == name) return one;
  throw std::runtime_error("no attribute " + name);
}

/// Loads, saves in both forms and compressed, and expects the same each time.
Character expect_kept(const Folder& folder, const std::string& text) {
  const Character first = load(folder.write("first.gltf", text));
  SaveOptions small;
  small.compress = true;
  for (const char* name : {"again.glb", "again.gltf", "small.glb"}) {
    SCOPED_TRACE(name);
    save(first, folder / name, std::string(name) == "small.glb" ? small : SaveOptions{});
    test::expect_same(first, load(folder / name));
  }
  return first;
}

std::string problem_of(const Character& character) {
  const std::vector<Problem> problems = validate(character);
  return problems.empty() ? "" : problems.front().error().what();
}

TEST(carried_parts, what_is_wrong_is_named) {
  Character c;
  c.parts = {test::seamed_part()};
  Mesh& mesh = c.parts[0].mesh;
  const auto with = [&](VertexAttribute attribute) {
    mesh.attributes = {std::move(attribute)};
    return problem_of(c);
  };
  const std::vector<float> seven(7, 1.f);
  EXPECT_EQ(with({"_A", 1, 5126, false, seven}), "");
  EXPECT_EQ(with({"A", 1, 5126, false, seven}),
            "part strip: attribute A: has no underscore before its name; call it _NAME");
  EXPECT_EQ(with({"_A", 1, 5125, false, seven}),
            "part strip: attribute _A: is stored as type 5125; give 5120, 5121, 5122, 5123 or 5126");
  EXPECT_EQ(with({"_A", 5, 5126, false, seven}),
            "part strip: attribute _A: has 5 numbers a vertex; give 1 to 4");
  EXPECT_EQ(with({"_A", 2, 5126, false, seven}), "part strip: attribute _A: has 7 values; 14 are needed");
  EXPECT_EQ(with({"_A", 1, 5121, false, std::vector<float>(7, 256.f)}),
            "part strip: attribute _A: holds 256.000000; give numbers that its type can store");
  EXPECT_EQ(with({"_A", 1, 5121, false, std::vector<float>(7, 0.5f)}),
            "part strip: attribute _A: holds 0.500000; give numbers that its type can store");
  EXPECT_EQ(with({"_A", 1, 5126, false, std::vector<float>(7, NAN)}),
            "part strip: attribute _A: holds nan; give numbers that its type can store");
  mesh.attributes = {{"_A", 1, 5126, false, seven}, {"_A", 1, 5126, false, seven}};
  EXPECT_EQ(problem_of(c), "part strip: attribute _A: is there twice; names are unique");
  mesh.attributes.clear();
  const auto loose = [&](LooseElements elements) {
    mesh.loose = {std::move(elements)};
    return problem_of(c);
  };
  EXPECT_EQ(loose({false, -1, {}}), "part strip: points: name no vertices; leave them out");
  EXPECT_EQ(loose({true, -1, {0, 1, 2}}), "part strip: lines: name 3 vertices; each line has two");
  EXPECT_EQ(loose({true, -1, {0, 7}}), "part strip: lines: name vertex 7; there are 7");
  EXPECT_EQ(loose({false, 2, {0}}), "part strip: points: name material 2; there are 0");
  mesh.loose.clear();
  c.parts.push_back(c.parts[0]);
  c.parts[0].shown = false;
  EXPECT_EQ(problem_of(c),
            "part strip: comes after a part that is not shown; parts that are not shown come last");
}

TEST(carried_parts, broken_attributes_are_refused) {
  const Folder folder;
  GltfText text = quad_with_attributes();
  text.root["accessors"].back()["count"] = 3;
  EXPECT_EQ(test::error_of([&] { load(folder.write("bad.gltf", text.text())); }),
            "bad.gltf: accessors[6].count: is 3; 4 elements are needed here");
  text = quad_with_attributes();
  text.primitive()["attributes"]["_BYTE"] = 99;
  EXPECT_EQ(test::error_of([&] { load(folder.write("bad.gltf", text.text())); }),
            "bad.gltf: meshes[0].primitives[0].attributes._BYTE: is 99; give 0 to 6");
}

TEST(carried_parts, attributes_of_every_type_come_back_as_they_were_stored) {
  const Folder folder;
  const Character c = expect_kept(folder, quad_with_attributes().text());
  const Mesh& mesh = c.parts[0].mesh;
  ASSERT_EQ(mesh.attributes.size(), 5u);
  EXPECT_EQ(attribute(mesh, "_BYTE"), (VertexAttribute{"_BYTE", 1, 5121, false, {1, 2, 255, 128}}));
  EXPECT_EQ(attribute(mesh, "_SIGNED"),
            (VertexAttribute{"_SIGNED", 2, 5120, true, {-128, 127, 5, -5, 1, 2, 3, 4}}));
  EXPECT_EQ(attribute(mesh, "_SHORT").values[6], 65535.f);
  EXPECT_EQ(attribute(mesh, "_SIGNED_SHORT").values[0], -32768.f);
  EXPECT_EQ(attribute(mesh, "_FLOAT").values[2], 1e-20f);
}

TEST(carried_parts, attributes_that_primitives_store_differently_become_floats) {
  const Folder folder;
  GltfText text = quad_with_attributes();
  nlohmann::json second = text.primitive();
  const int positions = text.floats({5, 0, 0, 6, 0, 0, 6, 1, 0}, "VEC3", 3);
  const int own = text.floats({1, 2, 3, 4, 5, 6}, "VEC2", 2);
  second["attributes"] = {{"POSITION", positions}, {"_SIGNED", own}, {"_BYTE", own}};
  second["indices"] = text.shorts({0, 1, 2});
  text.root["meshes"][0]["primitives"].push_back(second);
  const Character c = expect_kept(folder, text.text());
  const Mesh& mesh = c.parts[0].mesh;
  EXPECT_EQ(attribute(mesh, "_SIGNED"), (VertexAttribute{"_SIGNED",
                                                         2,
                                                         5126,
                                                         false,
                                                         {-1, 1, 5 / 127.f, -5 / 127.f, 1 / 127.f, 2 / 127.f,
                                                          3 / 127.f, 4 / 127.f, 1, 2, 3, 4, 5, 6}}));
  EXPECT_EQ(attribute(mesh, "_BYTE"),
            (VertexAttribute{"_BYTE", 2, 5126, false, {1, 0, 2, 0, 255, 0, 128, 0, 1, 2, 3, 4, 5, 6}}));
  EXPECT_EQ(attribute(mesh, "_FLOAT").values, (std::vector<float>{0.1f, 0.2f, 1e-20f, -3.5f, 0, 0, 0}));
}

TEST(carried_parts, copies_at_a_seam_have_the_attributes_of_their_vertex) {
  const Folder folder;
  Character c;
  c.parts = {test::seamed_part()};
  Mesh& mesh = c.parts[0].mesh;
  mesh.attributes = {{"_NUMBER", 1, 5123, false, {0, 1, 2, 3, 4, 5, 6}}};
  mesh.loose = {{true, -1, {2, 3, 6, 0}}};
  save(c, folder / "strip.glb");
  const Character again = load(folder / "strip.glb");
  test::expect_same_mesh(mesh, again.parts[0].mesh);
}

/// The quad with another primitive of `mode` on three vertices of its own.
GltfText quad_and(int mode, const std::vector<std::uint16_t>& indices) {
  GltfText text;
  text.add_quad();
  nlohmann::json other = {{"mode", mode}, {"extras", {{"pen", mode}}}};
  other["attributes"]["POSITION"] = text.floats({5, 0, 0, 6, 0, 0, 6, 1, 0}, "VEC3", 3);
  if (!indices.empty()) other["indices"] = text.shorts(indices);
  text.root["meshes"][0]["primitives"].insert(text.root["meshes"][0]["primitives"].begin(), other);
  return text;
}

TEST(carried_parts, points_and_lines_beside_faces_come_back) {
  const Folder folder;
  const auto loose = [&](int mode, const std::vector<std::uint16_t>& indices) {
    const Character c = expect_kept(folder, quad_and(mode, indices).text());
    const Mesh& mesh = c.parts[0].mesh;
    EXPECT_EQ(mesh.faces.size(), 2u);
    EXPECT_EQ(mesh.vertex_count(), 7u);
    EXPECT_EQ(c.parts[0].carried, R"({"primitives":[{},{"extras":{"pen":)" + std::to_string(mode) + "}}]}");
    return mesh.loose.empty() ? std::vector<int>() : mesh.loose[0].vertices;
  };
  EXPECT_THAT(loose(0, {}), ElementsAre(4, 5, 6));
  EXPECT_THAT(loose(0, {2, 0}), ElementsAre(6, 4));
  EXPECT_THAT(loose(1, {0, 1, 1, 2}), ElementsAre(4, 5, 5, 6));
  EXPECT_THAT(loose(2, {}), ElementsAre(4, 5, 5, 6, 6, 4));
  EXPECT_THAT(loose(3, {2, 1, 0}), ElementsAre(6, 5, 5, 4));
}

TEST(carried_parts, lines_on_the_vertices_of_the_faces_share_them) {
  const Folder folder;
  GltfText text = quad_with_attributes();
  nlohmann::json wire = text.primitive(), dots = text.primitive();
  wire["mode"] = 2;
  wire["indices"] = text.shorts({0, 1, 2, 3});
  dots["mode"] = 0;
  dots["attributes"].erase("_BYTE");
  dots.erase("indices");
  text.root["meshes"][0]["primitives"].push_back(wire);
  text.root["meshes"][0]["primitives"].push_back(dots);
  const Character c = expect_kept(folder, text.text());
  const Mesh& mesh = c.parts[0].mesh;
  EXPECT_EQ(mesh.vertex_count(), 4u);
  ASSERT_EQ(mesh.loose.size(), 2u);
  EXPECT_THAT(mesh.loose[0].vertices, ElementsAre(0, 1, 1, 2, 2, 3, 3, 0));
  EXPECT_THAT(mesh.loose[1].vertices, ElementsAre(0, 1, 2, 3));
}

TEST(carried_parts, a_mesh_of_lines_alone_is_a_part) {
  const Folder folder;
  GltfText text;
  text.add_quad();
  text.primitive()["mode"] = 3;
  text.primitive()["targets"] = {
      {{"POSITION", text.floats({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3)}}};
  const Character c = expect_kept(folder, text.text());
  ASSERT_EQ(c.parts.size(), 1u);
  EXPECT_TRUE(c.parts[0].mesh.faces.empty());
  EXPECT_EQ(c.parts[0].mesh.loose[0].vertices.size(), 10u);
  ASSERT_EQ(c.shapes.size(), 1u);
  EXPECT_THAT(c.shapes[0].parts[0].vertices, ElementsAre(1));
}

TEST(carried_parts, tangents_of_faces_stay_when_lines_have_none) {
  const Folder folder;
  GltfText text = quad_and(1, {0, 1});
  const std::vector<float> tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, -1};
  nlohmann::json& faces = text.root["meshes"][0]["primitives"][1]["attributes"];
  faces["TANGENT"] = text.floats(tangents, "VEC4", 4);
  faces["NORMAL"] = text.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  const Character c = expect_kept(folder, text.text());
  EXPECT_EQ(c.parts[0].mesh.tangents.rows(), 7);
  EXPECT_EQ(c.parts[0].mesh.tangents(3, 1), 1);
  EXPECT_EQ(c.parts[0].mesh.tangents.row(4).norm(), 0);
}

TEST(carried_parts, meshes_that_no_node_shows_come_last_and_come_back) {
  const Folder folder;
  GltfText text;
  text.add_quad();
  const nlohmann::json quad = text.root["meshes"][0];
  nlohmann::json hidden = quad;
  hidden["name"] = "spare";
  hidden["extras"]["targetNames"] = {"up"};
  hidden["weights"] = {0.5};
  hidden["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  hidden["primitives"][0]["attributes"]["JOINTS_0"] =
      text.accessor(text.view(std::vector<std::uint8_t>(16, 3)), 5121, "VEC4", 4);
  hidden["primitives"][0]["attributes"]["WEIGHTS_0"] =
      text.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  text.root["meshes"] = {hidden, quad};
  text.root["nodes"][0]["mesh"] = 1;
  const Character c = expect_kept(folder, text.text());
  ASSERT_EQ(c.parts.size(), 2u);
  EXPECT_TRUE(c.parts[0].shown);
  EXPECT_FALSE(c.parts[1].shown);
  EXPECT_EQ(c.parts[1].name, "spare");
  EXPECT_EQ(c.parts[1].node, -1);
  EXPECT_THAT(c.parts[1].skin_weights.joints, ElementsAre(3, 3, 3, 3));
  ASSERT_EQ(c.sliders.size(), 1u);
  EXPECT_EQ(c.sliders[0].rest, 0.5);
  save(c, folder / "seen.obj");
  EXPECT_EQ(load(folder / "seen.obj").parts[0].mesh.vertex_count(), 4u);
}

}  // namespace
}  // namespace mien
