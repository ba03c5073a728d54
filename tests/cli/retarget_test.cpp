// Captures onto characters, and names between conventions, as a user types them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

class retarget : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_mien(folder, "sample human --quiet -o " + folder.path().string()).exit_code, 0);
    folder.write(
        "take.csv",
        "Timecode,BlendShapeCount,JawOpen,HeadYaw,Nonsense\n00:00:00:00,3,0,0,0\n00:00:01:00,3,0.5,0.3,1\n");
  }
  const Folder folder;
  const std::string face = folder / "human.glb", take = folder / "take.csv", out = folder / "out.glb";
};

TEST_F(retarget, a_take_becomes_a_clip_and_what_is_left_out_is_said) {
  const Ran ran = run_mien(folder, "retarget " + take + " " + face + " -o " + out + " --json");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["clip"], "capture");
  EXPECT_EQ(json["channels"], 2) << "a slider and the head";
  EXPECT_EQ(json["unmapped"], nlohmann::json({"Nonsense"}));
  EXPECT_EQ(json["still"].size(), 51u);
  const auto inspected = nlohmann::json::parse(run_mien(folder, "inspect " + out + " --json").out);
  EXPECT_EQ(inspected["clips"].size(), 2u);
  EXPECT_TRUE(inspected["problems"].empty());
}

TEST_F(retarget, bad_input_leaves_nothing_behind) {
  folder.write("empty.csv", "JawOpen\n");
  folder.write("map.json", R"({"map": {"JawOpen": "gills"}})");
  expect_failure(run_mien(folder, "retarget " + folder / "empty.csv" + " " + face + " -o " + out),
                 "empty.csv: file: has no rows");
  expect_failure(
      run_mien(folder, "retarget " + take + " " + face + " -o " + out + " --map " + folder / "map.json"),
      "slider gills: does not exist");
  expect_failure(run_mien(folder, "retarget " + take + " " + face + " -o " + out + " --gain jawOpen=big"),
                 "--gain jawOpen=big: is not NAME=FACTOR");
  expect_failure(run_mien(folder, "retarget " + folder / "take.c3d" + " " + face + " -o " + out),
                 "is not known");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(retarget, names_go_to_another_convention_and_back) {
  ASSERT_EQ(run_mien(folder, "rename " + face + " --to ict -o " + out).exit_code, 0);
  const auto ict = nlohmann::json::parse(run_mien(folder, "map " + out + " --to arkit --json").out);
  EXPECT_EQ(ict["convention"], "ict");
  EXPECT_EQ(ict["map"]["eyeBlink_L"], "eyeBlinkLeft");
  ASSERT_EQ(run_mien(folder, "rename " + out + " --to arkit -o " + folder / "back.glb").exit_code, 0);
  const auto names = [&](const std::string& file) {
    return nlohmann::json::parse(run_mien(folder, "inspect " + file + " --json").out)["shapes"];
  };
  EXPECT_EQ(names(folder / "back.glb"), names(face));
  EXPECT_EQ(run_mien(folder, "rename " + face + " -o " + out).exit_code, 2);
  expect_failure(run_mien(folder, "map " + face + " --to pixar"), "convention pixar: is not known");
}

}  // namespace
}  // namespace mien::test
