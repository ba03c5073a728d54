// mien constrain, controls, vrm, and renamed joints, as a user's shell runs them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

class rigging : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_mien(folder, "sample human --quiet -o " + folder.path().string()).exit_code, 0);
  }
  nlohmann::json succeed(const std::string& arguments) {
    const Ran ran = run_mien(folder, arguments + " --json");
    EXPECT_EQ(ran.exit_code, 0) << arguments << "\n" << ran.err;
    return nlohmann::json::parse(ran.out, nullptr, false);
  }
  const Folder folder;
  const std::string face = folder / "human.glb", out = folder / "out.glb";
};

TEST_F(rigging, misuse_and_bad_inputs_are_said) {
  EXPECT_EQ(run_mien(folder, "constrain " + face + " -o " + out).exit_code, 2);
  EXPECT_EQ(run_mien(folder, "controls").exit_code, 2);
  EXPECT_EQ(run_mien(folder, "controls " + face).exit_code, 2);
  EXPECT_EQ(run_mien(folder, "vrm " + face + " -o " + out).exit_code, 2);
  expect_failure(run_mien(folder, "vrm " + face + " -o " + folder / "a.vrm"), "has no author");
  expect_failure(run_mien(folder, "constrain " + face + " --remove gone -o " + out), "names no constraint");
  expect_failure(run_mien(folder, "rename " + face + " --joints-to bipedal -o " + out), "is not known");
  folder.write(
      "circle.json",
      R"({"constraints": [{"name": "a", "kind": "point", "node": "head", "sources": [{"node": "jaw"}]}]})");
  expect_failure(run_mien(folder, "constrain " + face + " --add " + folder / "circle.json" + " -o " + out),
                 "circle.json: constraint a: head depends on jaw, that on head");
  folder.write("config.json", R"({"regions": [{"name": "a", "match": [""]}]})");
  expect_failure(run_mien(folder, "controls " + face + " --config " + folder / "config.json" + " -o " + out),
                 "config.json: region a: has an empty pattern");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(rigging, a_constraint_is_added_listed_obeyed_and_removed) {
  folder.write("c.json", R"({"nodes": [{"name": "lookAt", "parent": "head", "at": [0, 0.03, 1]}],
    "constraints": [{"name": "look", "kind": "aim", "node": "eyeLeft_joint", "sources": [{"node": "lookAt"}]}]})");
  const auto made = succeed("constrain " + face + " --add " + folder / "c.json" + " -o " + out);
  EXPECT_EQ(made["added"], 1);
  EXPECT_EQ(made["constraints"].back(), "look");
  const auto listed = succeed("inspect " + out);
  EXPECT_EQ(listed["constraints"].back()["kind"], "aim");
  EXPECT_EQ(listed["constraints"].back()["sources"][0]["node"], "lookAt");
  EXPECT_TRUE(listed["problems"].empty());
  EXPECT_EQ(succeed("constrain " + out + " --remove look -o " + out)["constraints"].size(), 3u);
}

TEST_F(rigging, controls_are_made_listed_and_drawn) {
  const auto made = succeed("controls " + face + " -o " + out + " --picture " + folder / "panel.png");
  EXPECT_TRUE(made["other_sliders"].empty());
  EXPECT_TRUE(made["other_joints"].empty()) << made["other_joints"];
  EXPECT_EQ(succeed("inspect " + out)["controls"], made["controls"]);
  EXPECT_EQ(text_of(folder / "panel.png").substr(1, 3), "PNG");
  succeed("controls --print-config " + folder / "usual.json");
  const auto same = succeed("controls " + face + " --config " + folder / "usual.json" + " -o " + out);
  EXPECT_EQ(same["controls"], made["controls"]);
}

TEST_F(rigging, an_avatar_has_every_preset) {
  const auto made = succeed("vrm " + face + " --author K -o " + folder / "a.vrm");
  EXPECT_EQ(made["presets"].size(), 17u);
  EXPECT_EQ(made["custom"].size(), 52u);
  EXPECT_EQ(made["bones"]["head"], "head");
  EXPECT_TRUE(succeed("inspect " + folder / "a.vrm")["problems"].empty());
}

TEST_F(rigging, joints_are_renamed) {
  const auto made = succeed("rename " + face + " --joints-to rigify -o " + out);
  EXPECT_EQ(made["joints"]["head"], "spine.006");
  EXPECT_EQ(made["joints"]["lidUpperLeft"], "lid.T.L");
  EXPECT_EQ(succeed("map " + out)["joint_convention"], "rigify");
}

}  // namespace
}  // namespace mien::test
