#include <gmock/gmock.h>

#include <cstring>
#include <limits>

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

std::string error_in(const std::string& text, const std::string& name = "face.gltf") {
  const Folder folder;
  const auto path = folder.write(name, text);
  const std::string error = error_of([&] { load(path); });
  EXPECT_EQ(error.find('\n'), error.npos);
  EXPECT_LT(error.size(), 400u);
  return error;
}

struct BrokenGltf {
  const char* name;
  std::function<void(GltfText&)> damage;
  const char* error;
};

const float nan_value = std::numeric_limits<float>::quiet_NaN();

const BrokenGltf cases[] = {
    {"no asset", [](GltfText& g) { g.root.erase("asset"); }, "file: has no \"asset\""},
    {"version", [](GltfText& g) { g.root["asset"]["version"] = "1.0"; },
     "asset.version: is \"1.0\"; mien reads version 2"},
    {"draco", [](GltfText& g) { g.root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "extensionsRequired: asks for KHR_draco_mesh_compression, which mien does not read; export without "
     "Draco "
     "compression, or with EXT_meshopt_compression"},
    {"unknown extension", [](GltfText& g) { g.root["extensionsRequired"] = {"ACME_geometry"}; },
     "extensionsRequired: asks for ACME_geometry, which mien does not read; export without it"},
    {"nodes of wrong type", [](GltfText& g) { g.root["nodes"] = 7; }, "nodes: is a number; give an array"},
    {"node of wrong type", [](GltfText& g) { g.root["nodes"] = {7}; },
     "nodes[0]: is a number; give an object"},
    {"name of wrong type", [](GltfText& g) { g.root["nodes"][0]["name"] = 7; },
     "nodes[0].name: is a number; give a string"},
    {"mesh out of range", [](GltfText& g) { g.root["nodes"][0]["mesh"] = 5; },
     "nodes[0].mesh: is 5; give 0 to 0"},
    {"mesh is negative", [](GltfText& g) { g.root["nodes"][0]["mesh"] = -1; },
     "nodes[0].mesh: is -1; give 0 to 0"},
    {"mesh is a fraction", [](GltfText& g) { g.root["nodes"][0]["mesh"] = 0.5; },
     "nodes[0].mesh: is 0.5; give a whole number"},
    {"cycle",
     [](GltfText& g) {
       g.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
     },
     "nodes[1]: is its own ancestor; nodes must form trees"},
    {"own child", [](GltfText& g) { g.root["nodes"][0]["children"] = {0}; },
     "nodes[0]: is its own ancestor; nodes must form trees"},
    {"two parents",
     [](GltfText& g) {
       g.root["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"name", "c"}}};
     },
     "nodes[1].children: names node 2, which has a parent; nodes must form trees"},
    {"zero quaternion",
     [](GltfText& g) {
       g.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "nodes[0].rotation: has no length; give a unit quaternion"},
    {"short matrix",
     [](GltfText& g) {
       g.root["nodes"][0]["matrix"] = {1, 2, 3};
     },
     "nodes[0].matrix: has 3 numbers; give 16"},
    {"no POSITION", [](GltfText& g) { g.primitive()["attributes"] = json::object(); },
     "meshes[0].primitives[0].attributes: has no \"POSITION\""},
    {"accessor out of range", [](GltfText& g) { g.primitive()["attributes"]["POSITION"] = 9; },
     "meshes[0].primitives[0].attributes.POSITION: is 9; give 0 to 1"},
    {"absurd count", [](GltfText& g) { g.root["accessors"][0]["count"] = 4000000000u; },
     "accessors[0].count: is 4000000000; give 1 to 134217727"},
    {"count beyond its view", [](GltfText& g) { g.root["accessors"][0]["count"] = 5; },
     "accessors[0]: has 5 elements of 12 bytes from byte 0 on; bufferViews[0] has 48 bytes"},
    {"absurd count without a view",
     [](GltfText& g) {
       g.root["accessors"][0].erase("bufferView");
       g.root["accessors"][0]["count"] = 100000000;
     },
     "accessors[0]: asks for far more memory than the file has bytes; give counts that the data backs"},
    {"count of zero", [](GltfText& g) { g.root["accessors"][0]["count"] = 0; },
     "accessors[0].count: is 0; give 1 to 134217727"},
    {"negative byteOffset", [](GltfText& g) { g.root["accessors"][0]["byteOffset"] = -12; },
     "accessors[0].byteOffset: is -12; give 0 to 1099511627776"},
    {"offset beyond its view", [](GltfText& g) { g.root["accessors"][0]["byteOffset"] = 4; },
     "accessors[0]: has 4 elements of 12 bytes from byte 4 on; bufferViews[0] has 48 bytes"},
    {"huge byteOffset", [](GltfText& g) { g.root["accessors"][0]["byteOffset"] = 1099511627776; },
     "accessors[0]: has 4 elements of 12 bytes from byte 1099511627776 on; bufferViews[0] has 48 bytes"},
    {"stride below the element", [](GltfText& g) { g.root["bufferViews"][0]["byteStride"] = 4; },
     "bufferViews[0].byteStride: is 4; elements of accessors[0] take 12 bytes"},
    {"view beyond its buffer", [](GltfText& g) { g.root["bufferViews"][0]["byteLength"] = 4800; },
     "bufferViews[0]: spans bytes 0 to 4800; its buffer has 60"},
    {"view offset overflows",
     [](GltfText& g) { g.root["bufferViews"][0]["byteOffset"] = 18446744073709551615u; },
     "bufferViews[0].byteOffset: is 18446744073709551615; give 0 to 1099511627776"},
    {"component type", [](GltfText& g) { g.root["accessors"][0]["componentType"] = 5124; },
     "accessors[0].componentType: is 5124; give 5120, 5121, 5122, 5123, 5125 or 5126"},
    {"type", [](GltfText& g) { g.root["accessors"][0]["type"] = "VEC9"; },
     "accessors[0].type: is \"VEC9\"; give SCALAR, VEC2, VEC3, VEC4 or MAT4"},
    {"wrong columns", [](GltfText& g) { g.root["accessors"][0]["type"] = "VEC2"; },
     "accessors[0].type: is VEC2; 3 components are needed here"},
    {"float indices",
     [](GltfText& g) {
       g.primitive()["indices"] = g.floats({0, 1, 2}, "SCALAR", 1);
     },
     "accessors[2].componentType: is 5126; unsigned integers are needed here"},
    {"index out of range",
     [](GltfText& g) {
       g.primitive()["indices"] = g.shorts({0, 1, 4});
     },
     "accessors[2]: index 2 is 4; there are 4 vertices"},
    {"indices that are no triangles",
     [](GltfText& g) {
       g.primitive()["indices"] = g.shorts({0, 1, 2, 3});
     },
     "meshes[0].primitives[0]: has 4 indices; triangles need a multiple of three"},
    {"NaN position",
     [](GltfText& g) {
       g.primitive()["attributes"]["POSITION"] =
           g.floats({0, 0, nan_value, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
     },
     "accessors[2]: element 0 is not finite; give finite numbers"},
    {"NORMAL of another count",
     [](GltfText& g) {
       g.primitive()["attributes"]["NORMAL"] = g.floats({0, 0, 1}, "VEC3", 3);
     },
     "accessors[2].count: is 1; 4 elements are needed here"},
    {"sparse row out of range",
     [](GltfText& g) {
       const int rows = g.view(std::vector<std::uint16_t>{1, 4}), values = g.view(std::vector<float>(6, 1.f));
       g.root["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", rows}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", values}}}};
     },
     "accessors[0].sparse.indices: has row 4 at 1; rows must ascend and stay below 4"},
    {"sparse rows unsorted",
     [](GltfText& g) {
       const int rows = g.view(std::vector<std::uint16_t>{2, 1}), values = g.view(std::vector<float>(6, 1.f));
       g.root["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", rows}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", values}}}};
     },
     "accessors[0].sparse.indices: has row 1 at 1; rows must ascend and stay below 4"},
    {"sparse count",
     [](GltfText& g) {
       g.root["accessors"][0]["sparse"] = {{"count", 4000000000u}};
     },
     "accessors[0].sparse: has no \"indices\""},
    {"targets of unequal number",
     [](GltfText& g) {
       json second = g.primitive();
       second["targets"] = {{{"POSITION", 0}}};
       g.root["meshes"][0]["primitives"].push_back(second);
     },
     "meshes[0].primitives[1].targets: has 1 targets; the mesh's other primitives have 0"},
    {"target of another count",
     [](GltfText& g) {
       g.primitive()["targets"] = {{{"POSITION", g.floats({0, 0, 1}, "VEC3", 3)}}};
     },
     "accessors[2].count: is 1; 4 elements are needed here"},
    {"skin without joints",
     [](GltfText& g) {
       g.root["skins"] = {{{"joints", json::array()}}};
     },
     "skins[0].joints: is empty; a skin needs joints"},
    {"joint out of range",
     [](GltfText& g) {
       g.root["skins"] = {{{"joints", {3}}}};
     },
     "skins[0].joints[0]: is 3; give 0 to 0"},
    {"joint index beyond the skin",
     [](GltfText& g) {
       g.root["skins"] = {{{"joints", {0}}}};
       g.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
       g.primitive()["attributes"]["JOINTS_0"] =
           g.accessor(g.view(std::vector<std::uint8_t>(16, 9)), 5121, "VEC4", 4);
       g.primitive()["attributes"]["WEIGHTS_0"] = g.floats(std::vector<float>(16, .25f), "VEC4", 4);
     },
     "part quad: vertex 0: names joint 9; there are 1"},
    {"keys that do not ascend",
     [](GltfText& g) {
       const int times = g.floats({0, 1, 1}, "SCALAR", 1),
                 values = g.floats(std::vector<float>(9, 0.f), "VEC3", 3);
       g.root["animations"] = {
           {{"samplers", {{{"input", times}, {"output", values}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
     },
     "clip 0: channel 0: key 2: is not later than the one before it; times must ascend from 0"},
    {"values of another count",
     [](GltfText& g) {
       const int times = g.floats({0, 1}, "SCALAR", 1),
                 values = g.floats(std::vector<float>(9, 0.f), "VEC3", 3);
       g.root["animations"] = {
           {{"samplers", {{{"input", times}, {"output", values}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
     },
     "accessors[3].count: is 3; 2 elements are needed here"},
    {"sampler out of range",
     [](GltfText& g) {
       g.root["animations"] = {
           {{"samplers", json::array()},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
     },
     "animations[0].channels[0].sampler: is 0; there is nothing to name"},
    {"image in no view",
     [](GltfText& g) {
       g.root["images"] = {{{"bufferView", 77}}};
     },
     "images[0].bufferView: is 77; give 0 to 1"},
    {"a landmark on no vertex",
     [](GltfText& g) {
       g.root["extensions"]["MIEN_character"] = {
           {"version", 1}, {"landmarks", {{{"name", "n"}, {"mesh", 0}, {"vertex", 4}}}}};
     },
     "extensions.MIEN_character.landmarks[0].vertex: is 4; give 0 to 3"},
};

TEST(read_gltf_bad_input, one_line_says_what_is_wrong) {
  for (const BrokenGltf& bad : cases) {
    SCOPED_TRACE(bad.name);
    GltfText gltf = one_quad();
    bad.damage(gltf);
    EXPECT_EQ(error_in(gltf.text()), std::string("face.gltf: ") + bad.error);
  }
}

TEST(read_gltf_bad_input, the_undamaged_file_is_read) {
  EXPECT_EQ(error_in(one_quad().text()), "");
}

TEST(read_gltf_bad_input, buffers_stay_in_the_folder) {
  for (const char* uri :
       {"../secret.bin", "/etc/passwd", "%2e%2e/secret.bin", "a/../../b.bin", "http://a/b.bin", ""}) {
    json root = json::parse(one_quad().text());
    root["buffers"][0]["uri"] = uri;
    EXPECT_EQ(error_in(root.dump()), std::string("face.gltf: buffers[0].uri: names \"") + uri +
                                         "\"; name a file in the glTF's folder");
  }
  json root = json::parse(one_quad().text());
  root["buffers"][0]["uri"] = "none.bin";
  EXPECT_EQ(error_in(root.dump()),
            "face.gltf: buffers[0].uri: names \"none.bin\", which does not exist; keep the files beside each "
            "other");
  root["buffers"][0]["uri"] = "data:application/octet-stream;base64,@@@@";
  EXPECT_EQ(error_in(root.dump()), "face.gltf: buffers[0].uri: is not valid base64; check the data: URI");
}

TEST(read_gltf_bad_input, headers) {
  EXPECT_EQ(error_in("", "a.glb"), "a.glb: file: is empty; give a glTF 2.0 file");
  EXPECT_EQ(error_in("PK", "a.glb"),
            "a.glb: header: is not that of a glTF file; a .glb starts with glTF, a .gltf with {");
  EXPECT_EQ(error_in("glTF", "a.glb"), "a.glb: header: ends after 4 bytes; the file is cut off");
  EXPECT_EQ(error_in("{", "a.gltf"),
            "a.gltf: JSON: is not valid JSON at byte 2; give well-formed UTF-8 JSON");
  EXPECT_EQ(error_in("{\"asset\": 1e999}", "a.gltf"),
            "a.gltf: JSON: holds a number that is out of range; give numbers that a double can hold");
  EXPECT_EQ(error_in("{\"a\": \"\xFF\"}", "a.gltf").substr(0, 32), "a.gltf: JSON: is not valid JSON ");
}

TEST(read_gltf_bad_input, nesting_bombs) {
  for (const char* open : {"[", "{\"a\":"}) {
    std::string text = "{\"asset\":";
    for (int i = 0; i < 200000; ++i) text += open;
    EXPECT_EQ(error_in(text), "face.gltf: JSON: JSON is nested deeper than 64 levels; use a flatter file");
  }
}

TEST(read_gltf_bad_input, a_glb_cut_off_anywhere) {
  const Folder folder;
  const auto source = folder.write("quad.gltf", one_quad().text());
  save(load(source), folder / "quad.glb");
  const std::vector<std::uint8_t> whole = read_file(folder / "quad.glb");
  for (std::size_t size = 0; size < whole.size(); size += 64) {
    write_file_atomically(folder / "cut.glb", std::span(whole).first(size));
    EXPECT_NE(error_of([&] { load(folder / "cut.glb"); }), "") << size;
  }
  for (const std::size_t at : {std::size_t{12}, std::size_t{16}, std::size_t{8}}) {  // chunk and file lengths
    std::vector<std::uint8_t> bytes = whole;
    std::memset(bytes.data() + at, 0xFF, 4);
    write_file_atomically(folder / "cut.glb", bytes);
    EXPECT_NE(error_of([&] { load(folder / "cut.glb"); }), "") << at;
  }
}

TEST(read_gltf_bad_input, a_mesh_in_very_many_nodes_does_not_fill_the_memory) {
  GltfText gltf;
  std::vector<float> positions(3 * 60000, 0.f);
  gltf.root["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", gltf.floats(positions, "VEC3", 3)}}}}}}}};
  for (int n = 0; n < 20000; ++n) gltf.root["nodes"].push_back({{"mesh", 0}});
  EXPECT_THAT(error_in(gltf.text()), testing::HasSubstr("far more memory"));
}

TEST(save, an_invalid_character_leaves_no_file) {
  const Folder folder;
  Character c = load(folder.write("quad.gltf", one_quad().text()));
  c.parts[0].mesh.positions(2, 1) = nan_value;
  for (const char* name : {"out.glb", "out.gltf", "out.obj"})
    EXPECT_EQ(error_of([&] { save(c, folder / name); }),
              std::string(name) + ": part face: vertex 2: is not finite; give finite numbers");
  EXPECT_EQ(error_of([&] { save(c, folder / "out.fbx"); }),
            "out.fbx: format: \".fbx\" is not known; name a .glb, .gltf or .obj");
  EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace
}  // namespace mien
