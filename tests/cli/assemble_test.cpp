// Whole-face OBJs, in a folder or by name, into a character; and what inspect says of it.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

class assemble : public testing::Test {
 protected:
  void SetUp() override {
    const std::string rest = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("my_Neutral.obj", "v 0 0 0\n" + rest);
    folder.write("jawOpen.obj", "v 0 -0.2 0\n" + rest);
    folder.write("smile.obj", "v 0.1 0 0\n" + rest);
    folder.write("identity0.obj", "v 0 0 0\nv 2 0 0\n" + rest);
    folder.write("notes.txt", "none");
  }
  nlohmann::json inspected(const std::string& file) {
    const Ran ran = run_mien(folder, "inspect --json " + file);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return nlohmann::json::parse(ran.out);
  }
  const std::vector<std::string> both = {"jawOpen", "smile"};
  Folder folder;
  const std::string here = folder.path().string(), out = folder / "face.glb";
};

TEST_F(assemble, a_folder_has_its_neutral_by_name_and_leaves_out_what_is_excluded) {
  const Ran ran = run_mien(folder, "assemble --exclude 'identity*' " + here + " -o " + out);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const nlohmann::json face = inspected(out);
  EXPECT_EQ(face["shapes"], both);
  EXPECT_EQ(face["vertices"], 3);
  EXPECT_EQ(face["parts"][0]["name"], "my_Neutral");
  EXPECT_TRUE(face["problems"].empty());
}

TEST_F(assemble, files_by_name_begin_with_the_neutral) {
  const std::string files = folder / "my_Neutral.obj " + folder / "smile.obj " + folder / "jawOpen.obj";
  ASSERT_EQ(run_mien(folder, "assemble " + files + " -o " + out).exit_code, 0);
  EXPECT_EQ(inspected(out)["shapes"], (std::vector<std::string>{"smile", "jawOpen"}));
}

TEST_F(assemble, a_named_neutral_is_no_shape) {
  const std::string neutral = folder / "smile.obj";
  ASSERT_EQ(
      run_mien(folder, "assemble " + here + " --exclude 'identity*' --neutral " + neutral + " -o " + out)
          .exit_code,
      0);
  EXPECT_EQ(inspected(out)["shapes"], (std::vector<std::string>{"jawOpen", "my_Neutral"}));
}

TEST_F(assemble, a_file_of_another_vertex_count_is_named_and_nothing_is_written) {
  expect_failure(run_mien(folder, "assemble " + here + " -o " + out),
                 folder / "identity0.obj" + ": vertices: are 4; the neutral has 3");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace mien::test
