#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/run_program.h"

namespace mien::test {
namespace {

using ::testing::HasSubstr;

std::string quoted(const std::string& path) {
  return " '" + path + "' ";
}

/// A square of nine vertices, one unit apart, to add objects to.
void write_square(const Folder& folder) {
  std::string text;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) text += "v " + std::to_string(i) + " " + std::to_string(j) + " 0\n";
  text += "f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\n";
  folder.write("square.obj", text);
}

Ran add(const Folder& folder, const std::string& objects) {
  folder.write("objects.json", R"({"objects": {)" + objects + "}}");
  return run_mien(folder, "objects --json" + quoted(folder / "square.obj") + "--add" +
                              quoted(folder / "objects.json") + "-o" + quoted(folder / "out.glb"));
}

TEST(ObjectsCommand, AddsListsAndDrawsObjects) {
  const Folder folder;
  write_square(folder);
  const Ran ran = add(folder, R"(
    "line": {"kind": "curve", "degree": 1, "controls": [[0, 1, 0], [2, 1, 0]], "range": 0.9},
    "box": {"kind": "lattice", "count": [2, 2, 2], "box": [[-1, -1, -1], [3, 3, 1]]},
    "spot": {"kind": "cluster", "at": {"vertex": 8}, "range": 0.5})");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto listed = nlohmann::json::parse(ran.out)["objects"];
  ASSERT_EQ(listed.size(), 3u);
  EXPECT_EQ(listed[0]["name"], "box");
  EXPECT_EQ(listed[0]["kind"], "lattice");
  EXPECT_EQ(listed[0]["controls"], 8);
  EXPECT_EQ(listed[1]["bindings"][0]["vertices"], 3);
  EXPECT_EQ(listed[2]["bindings"][0]["vertices"], 1);
  const Ran inspected = run_mien(folder, "inspect --json" + quoted(folder / "out.glb"));
  ASSERT_EQ(inspected.exit_code, 0) << inspected.err;
  EXPECT_EQ(nlohmann::json::parse(inspected.out)["objects"], listed);
  EXPECT_THAT(run_mien(folder, "inspect" + quoted(folder / "out.glb")).out,
              HasSubstr("line: curve degree 1, 2 control points; 3 vertices of"));
  EXPECT_EQ(run_mien(folder, "objects" + quoted(folder / "out.glb")).exit_code, 0);
  const Ran drawn = run_mien(folder, "render --objects" + quoted(folder / "out.glb") + "-o" +
                                         quoted(folder / "out.png") + "--size 64,64");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
}

TEST(ObjectsCommand, SaysWhatIsWrong) {
  const Folder folder;
  write_square(folder);
  const auto refusal = [&](const std::string& objects) {
    const Ran ran = add(folder, objects);
    expect_failure(ran, "");
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
    return ran.err;
  };
  EXPECT_THAT(
      refusal(R"("a": {"kind": "curve", "degree": 1, "controls": [[0, 1, 9], [2, 1, 9]], "range": 0.5})"),
      HasSubstr("reaches no vertex; a longer range"));
  EXPECT_THAT(refusal(R"("a": {"kind": "curve", "degree": 1, "controls": [[0, 1, 0], [2, 1, 0]]})"),
              HasSubstr("has range 0"));
  EXPECT_THAT(
      refusal(
          R"("a": {"kind": "curve", "degree": 1, "controls": [[0, 1, 0], [2, 1, 0]], "knots": [0, 1, 0, 1], "range": 1})"),
      HasSubstr("knots that descend"));
  EXPECT_THAT(refusal(R"("a": {"kind": "lattice", "box": [[5, 5, 5], [6, 6, 6]]})"),
              HasSubstr("holds no vertex; a lattice around some of the skin"));
  EXPECT_THAT(refusal(R"("a": {"kind": "cluster", "at": {"vertex": 0}, "node": "nose", "range": 1})"),
              HasSubstr("names node nose"));
  EXPECT_THAT(refusal(R"("a": {"kind": "mesh", "file": "none.obj", "range": 1})"), HasSubstr("none.obj"));
}

}  // namespace
}  // namespace mien::test
