// What `mien sample` accepts, refuses and writes.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/run_program.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"

namespace mien::test {
namespace {

TEST(SampleCommand, InvalidInputs) {
  const Folder folder;
  expect_failure(run_mien(folder, "sample robot -o " + folder / "out"),
                 "sample robot: is not a built-in character; use one of human, cartoon, creature");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  folder.write("file", "");
  expect_failure(run_mien(folder, "sample human -o " + folder / "file"), "cannot be made");
  EXPECT_EQ(run_mien(folder, "sample").exit_code, 2);
}

TEST(SampleCommand, ListsTheCharacters) {
  const Folder folder;
  const Ran ran = run_mien(folder, "sample --list");
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* name : {"human", "cartoon", "creature"}) EXPECT_NE(ran.out.find(name), std::string::npos);
}

TEST(SampleCommand, WritesFilesThatReadBack) {
  const Folder folder;
  ASSERT_EQ(run_mien(folder, "sample all --quiet -o " + folder / "out").exit_code, 0);
  for (const std::string name : {"human", "cartoon", "creature"}) {
    const std::string base = folder / "out/" + name;
    const Character character = load(base + ".glb");
    EXPECT_EQ(character.landmarks.size(), 68u) << name;
    EXPECT_EQ(read_landmarks(base + ".landmarks.json", character).landmarks.size(), 68u) << name;
    if (name == "human") {
      EXPECT_EQ(character.shapes.size(), 52u);
      continue;
    }
    // One landmark file serves both forms of a target.
    const Character bare = load(base + ".obj");
    const LandmarkSet set = read_landmarks(base + ".landmarks.json", bare);
    for (std::size_t i = 0; i < set.landmarks.size(); ++i) {
      const int vertex = set.landmarks[i].at.vertex;
      EXPECT_NEAR(
          (bare.parts[0].mesh.positions.row(vertex) - character.parts[0].mesh.positions.row(vertex)).norm(),
          0, 1e-4)
          << name << " " << set.landmarks[i].name;
    }
  }
}

}  // namespace
}  // namespace mien::test
