#include <gtest/gtest.h>

#include <cstdlib>

#include "full_character.h"
#include "mien/io/load.h"
#include "mien/io/vrm.h"
#include "mien/naming/plan_vrm.h"
#include "npm.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;

/// What the validator has to say about the files; empty: no errors and no warnings.
std::string issues_of(const std::filesystem::path& packages,
                      const std::vector<std::filesystem::path>& files) {
  const Folder folder;
  std::string command = "node '" MIEN_SOURCE "/tests/tools/validate_gltf.mjs' '" + packages.string() + "'";
  for (const std::filesystem::path& file : files) command += " '" + file.string() + "'";
  const int code = std::system((command + " > '" + (folder / "out.txt").string() + "' 2>&1").c_str());
  const std::vector<std::uint8_t> text = read_file(folder / "out.txt");
  return code == 0 ? std::string() : "issues:\n" + std::string(text.begin(), text.end());
}

class GltfValidator : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_node()) GTEST_SKIP() << "node and npm are not installed";
    packages_ = test::npm_packages("gltf-validator", "gltf-validator@2.0.0-dev.3.10");
    if (packages_.empty()) GTEST_SKIP() << "npm cannot install gltf-validator here";
  }
  /// Writes in both forms, and compressed.
  void write(const Character& character, const std::string& name) {
    SaveOptions small;
    small.compress = true;
    save(character, folder_ / (name + ".glb"));
    save(character, folder_ / (name + ".gltf"));
    save(character, folder_ / (name + ".small.glb"), small);
    for (const char* extension : {".glb", ".gltf", ".small.glb"})
      files_.push_back(folder_ / (name + extension));
  }
  Folder folder_;
  std::filesystem::path packages_;
  std::vector<std::filesystem::path> files_;
};

/// Attributes of every stored type, lines and points on the faces' vertices and on their own, a mesh that is not shown.
Character carried() {
  Character c = test::full_character();
  Mesh& mesh = c.parts[0].mesh;
  for (const int type : {5120, 5121, 5122, 5123, 5126})
    for (const int width : {1, 2, 3, 4})
      mesh.attributes.push_back({"_A" + std::to_string(type) + "_" + std::to_string(width), width, type,
                                 type < 5126, std::vector<float>(25 * static_cast<std::size_t>(width), 1.f)});
  mesh.loose = {{true, 0, {0, 1, 1, 2}}, {false, -1, {3, 4}}};
  Part more = c.parts[1];
  more.mesh.positions = Points::Random(7, 3);
  more.mesh.tangents = Points4::Zero(7, 4);
  more.mesh.tangents.topRows(3).col(0).setOnes();
  more.mesh.tangents.topRows(3).col(3).setOnes();
  more.mesh.loose = {{true, -1, {3, 4}}, {false, -1, {5, 6}}};
  more.name = "loose";
  more.node = -1;
  Part spare = c.parts[0];
  spare.shown = false;
  spare.node = spare.skin = -1;
  c.parts.push_back(more);
  c.parts.push_back(spare);
  return c;
}

TEST_F(GltfValidator, finds_faults_at_all) {
  EXPECT_NE(
      issues_of(packages_, {folder_.write("bad.gltf", R"({"asset": {"version": "2.0"}, "nodes": [7]})")}),
      "");
}

TEST_F(GltfValidator, finds_no_error_and_no_warning_in_what_we_write) {
  write(test::full_character(), "full");
  Character c = test::full_character();
  c.nodes[6].parent = 7;
  c.nodes[3].parent = -1;
  c.skins[0].has_inverse_bind = false;
  write(c, "roots");
  Character strip;
  strip.parts = {test::seamed_part()};
  write(strip, "strip");
  strip.parts[0].mesh = Mesh{};
  strip.parts[0].mesh.positions = Points::Random(5, 3);
  write(strip, "points");
  write(carried(), "carried");
  EXPECT_EQ(issues_of(packages_, files_), "");
}

TEST_F(GltfValidator, finds_no_error_and_no_warning_in_avatars) {
  VrmMeta meta;
  meta.name = "a";
  meta.authors = {"b"};
  const VrmPlan plan = plan_vrm(test::full_character(), meta);
  files_.push_back(folder_ / "a.vrm");
  write_vrm(plan.character, plan.avatar, files_.back());
  EXPECT_EQ(issues_of(packages_, files_), "");
}

TEST_F(GltfValidator, finds_no_error_and_no_warning_in_real_faces) {
  const std::filesystem::path data(MIEN_SHARED_DATA);
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data";
  for (const char* name : {"makehuman/caucasian_male_young.glb", "facecap/facecap.glb", "makehuman/x_elf.obj",
                           "cases/C_mhrig_afr/source.glb", "mediapipe/canonical_face_model.obj"})
    write(load(data / name), std::filesystem::path(name).stem().string());
  EXPECT_EQ(issues_of(packages_, files_), "");
}

}  // namespace
}  // namespace mien
