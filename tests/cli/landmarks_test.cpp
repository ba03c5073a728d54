// What `mien landmarks` accepts, refuses and writes, and that `mien transfer` asks for no landmark files.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "sample/made.h"

namespace mien::test {
namespace {

Character bare(const std::string& name) {
  Character character = made(name);
  character.landmarks.clear();
  character.curves.clear();
  return character;
}

/// A box has no face.
constexpr const char* box =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(LandmarksCommand, InvalidInputs) {
  const Folder folder;
  folder.write("box.obj", box);
  expect_failure(run_mien(folder, "landmarks " + folder / "box.obj" + " -o " + folder / "f.json"),
                 "no face was found");
  EXPECT_FALSE(std::filesystem::exists(folder / "f.json"));
  expect_failure(run_mien(folder, "landmarks " + folder / "box.obj" + " -o f.json --picture p.jpg"),
                 "not a picture that mien writes");
  EXPECT_EQ(run_mien(folder, "landmarks").exit_code, 2);
}

TEST(LandmarksCommand, WritesEveryPointWithItsConfidenceAndAPicture) {
  const Folder folder;
  save(bare("cartoon"), folder / "head.glb");
  const Ran ran =
      run_mien(folder, "landmarks " + folder / "head.glb" + " -o " + folder / "f.json --json --size 64,64" +
                           " --picture " + folder / "p.png");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto said = nlohmann::json::parse(ran.out);
  EXPECT_NE(said["verdict"], "refuse");
  EXPECT_EQ(said["confidence"].size(), 68u);
  EXPECT_TRUE(std::filesystem::exists(folder / "p.png"));
  const LandmarkSet set = read_landmarks(folder / "f.json", made("cartoon"));
  EXPECT_EQ(set.landmarks.size(), 68u);
  EXPECT_EQ(set.curves.size(), 4u);
  EXPECT_EQ(nlohmann::json::parse(text_of(folder / "f.json"))["confidence"].size(), 68u);
}

TEST(LandmarksCommand, TransferFindsWhatItWasNotGiven) {
  const Folder folder;
  save(made("human"), folder / "source.glb");
  save(bare("creature"), folder / "target.glb");
  const Ran ran = run_mien(
      folder, "transfer " + folder / "source.glb " + folder / "target.glb -o " + folder / "out.glb --json");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto said = nlohmann::json::parse(ran.out);
  ASSERT_EQ(said["found_landmarks"].size(), 1u);
  // By their names the transfer knows that they were found, not given.
  EXPECT_EQ(said["found_landmarks"].begin().value()["curves"],
            nlohmann::json({"browLeft", "browRight", "lipUpper", "lipLower"}));
  EXPECT_GE(said["landmarks"], 68);
}

}  // namespace
}  // namespace mien::test
