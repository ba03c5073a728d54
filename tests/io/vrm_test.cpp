#include "mien/io/vrm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "full_character.h"
#include "mien/io/load.h"
#include "mien/naming/plan_vrm.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;
using test::full_character;
using ::testing::HasSubstr;

VrmMeta meta() {
  VrmMeta meta;
  meta.name = "Ada";
  meta.authors = {"K"};
  return meta;
}

/// The plan of a character whose shapes are called jawOpen, smile and nothing.
VrmPlan plan() {
  Character c = full_character();
  c.shapes[1].name = "mouthSmileLeft";
  c.sliders[1].name = "mouthSmileLeft";
  return plan_vrm(c, meta());
}

/// The JSON chunk of a binary glTF.
nlohmann::json json_of(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  const std::size_t size = bytes.at(12) | bytes.at(13) << 8 | bytes.at(14) << 16 | bytes.at(15) << 24;
  return nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + static_cast<std::ptrdiff_t>(size));
}

TEST(WriteVrm, WhatVrmForbidsIsRefused) {
  const Folder folder;
  const auto error_with = [&](const auto& spoil) {
    VrmPlan made = plan();
    spoil(made);
    return test::error_of([&] { write_vrm(made.character, made.avatar, folder / "a.vrm"); });
  };
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.meta.name = ""; }),
              HasSubstr("a.vrm: VRM meta: has no name"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.meta.authors = {}; }),
              HasSubstr("VRM meta: has no author"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.meta.license_url = ""; }),
              HasSubstr("has no licence URL"));
  EXPECT_THAT(error_with([](VrmPlan& p) {
                std::erase_if(p.avatar.bones, [](const VrmBone& b) { return b.name == "hips"; });
              }),
              HasSubstr("VRM bone hips: is missing; VRM requires it"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.bones[0].name = "tail"; }),
              HasSubstr("VRM bone tail: is not one"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.bones[0].node = 999; }),
              HasSubstr("VRM bone hips: names node 999"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.bones[1].node = p.avatar.bones[0].node; }),
              HasSubstr("shares node"));
  EXPECT_THAT(error_with([](VrmPlan& p) { std::swap(p.avatar.bones[0].node, p.avatar.bones[1].node); }),
              HasSubstr("VRM bone spine: does not hang below hips"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.bones.push_back(p.avatar.bones[0]); }),
              HasSubstr("is there twice"));
  EXPECT_THAT(error_with([](VrmPlan& p) {
                p.avatar.bones.push_back({"upperChest", 0});
              }),
              HasSubstr("VRM bone upperChest: has no chest; give both or neither"));
  EXPECT_THAT(error_with([](VrmPlan& p) {
                p.character.nodes[static_cast<std::size_t>(p.avatar.bones[0].node)].rest.scale.x() = -1;
              }),
              HasSubstr("VRM bone hips: has a scale that is not above 0"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.expressions[0].name = "joyful"; }),
              HasSubstr("is no preset of VRM's"));
  EXPECT_THAT(error_with([](VrmPlan& p) {
                p.avatar.expressions.push_back({"blink", false, {}});
              }),
              HasSubstr("VRM expression blink: has the name of a preset"));
  EXPECT_THAT(error_with([](VrmPlan& p) { p.avatar.expressions.push_back(p.avatar.expressions[0]); }),
              HasSubstr("is there twice"));
  EXPECT_THAT(error_with([](VrmPlan& p) {
                p.avatar.expressions[0].binds = {{7, 1}};
              }),
              HasSubstr("names shape 7"));
  EXPECT_THAT(error_with([](VrmPlan& p) {
                p.avatar.expressions[0].binds = {{0, 1.5}};
              }),
              HasSubstr("weights in [0, 1]"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.vrm"));
}

TEST(WriteVrm, TheExtensionIsAsSpecified) {
  const Folder folder;
  const VrmPlan made = plan();
  write_vrm(made.character, made.avatar, folder / "a.vrm");
  const nlohmann::json file = json_of(folder / "a.vrm");
  EXPECT_THAT(file["extensionsUsed"].get<std::set<std::string>>(), ::testing::Contains("VRMC_vrm"));
  const nlohmann::json& vrm = file["extensions"]["VRMC_vrm"];
  EXPECT_EQ(vrm["specVersion"], "1.0");
  EXPECT_EQ(vrm["meta"]["name"], "Ada");
  EXPECT_EQ(vrm["meta"]["authors"], (std::vector<std::string>{"K"}));
  EXPECT_EQ(vrm["meta"]["licenseUrl"], "https://vrm.dev/licenses/1.0/");
  EXPECT_GE(vrm["humanoid"]["humanBones"].size(), 15u);
  for (const auto& [name, bone] : vrm["humanoid"]["humanBones"].items())
    EXPECT_LT(bone["node"].get<std::size_t>(), file["nodes"].size()) << name;
  for (const char* kind : {"preset", "custom"})
    for (const auto& [name, expression] : vrm["expressions"][kind].items())
      for (const auto& bind : expression["morphTargetBinds"]) {
        const nlohmann::json& node = file["nodes"][bind["node"].get<std::size_t>()];
        ASSERT_TRUE(node.contains("mesh")) << name;
        const nlohmann::json& mesh = file["meshes"][node["mesh"].get<std::size_t>()];
        for (const auto& primitive : mesh["primitives"])
          EXPECT_LT(bind["index"].get<std::size_t>(), primitive["targets"].size()) << name;
        EXPECT_GE(bind["weight"].get<double>(), 0);
        EXPECT_LE(bind["weight"].get<double>(), 1);
      }
  // jawOpen is the first target of both meshes that have it.
  const nlohmann::json& open = vrm["expressions"]["custom"]["jawOpen"]["morphTargetBinds"];
  ASSERT_EQ(open.size(), 2u);
  std::set<std::string> meshes;
  for (const auto& bind : open) {
    const nlohmann::json& mesh =
        file["meshes"][file["nodes"][bind["node"].get<std::size_t>()]["mesh"].get<std::size_t>()];
    EXPECT_EQ(mesh["extras"]["targetNames"][bind["index"].get<std::size_t>()], "jawOpen");
    meshes.insert(mesh["name"].get<std::string>());
  }
  EXPECT_EQ(meshes.size(), 2u);
}

TEST(WriteVrm, LoadsAgainAndKeepsWhatVrmSays) {
  const Folder folder;
  const VrmPlan made = plan();
  write_vrm(made.character, made.avatar, folder / "a.vrm");
  const Character again = load(folder / "a.vrm");
  Character expected = made.character;
  expected.carried = again.carried;
  test::expect_same(expected, again);
  EXPECT_THAT(again.carried, HasSubstr("VRMC_vrm"));
}

TEST(VrmMetaFile, IsRead) {
  const Folder folder;
  const VrmMeta read = read_vrm_meta(folder.write(
      "m.json", R"({"name": "Ada", "authors": ["K", "L"], "version": "2", "references": ["x"]})"));
  EXPECT_EQ(read.name, "Ada");
  EXPECT_EQ(read.authors.size(), 2u);
  EXPECT_EQ(read.license_url, "https://vrm.dev/licenses/1.0/");
  EXPECT_THAT(test::error_of([&] { read_vrm_meta(folder.write("m.json", R"({"author": "K"})")); }),
              HasSubstr("m.json: file: has an unknown member \"author\""));
}

}  // namespace
}  // namespace mien
