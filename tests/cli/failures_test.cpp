// What cannot be done: exit 1, one line, and nothing left behind.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/run_program.h"

namespace mien::test {
namespace {

/// Runs, expects the failure, and that no file has appeared.
void expect_clean_failure(const Folder& folder, const std::string& arguments,
                          const std::string& part_of_text) {
  SCOPED_TRACE(arguments);
  std::vector<std::filesystem::path> before, after;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    before.push_back(entry.path());
  expect_failure(run_mien(folder, arguments), part_of_text);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    after.push_back(entry.path());
  EXPECT_EQ(after, before) << "files were left behind";
}

TEST(failures, a_file_that_does_not_exist_is_named) {
  const Folder folder;
  const std::string nobody = folder / "nobody.glb", out = folder / "out.glb";
  const std::string text = "mien: " + nobody + ": ";
  expect_clean_failure(folder, "inspect " + nobody, text);
  expect_clean_failure(folder, "render " + nobody + " -o " + folder / "out.png", text);
  expect_clean_failure(folder, "transfer " + nobody + " " + nobody + " -o " + out, text);
  expect_clean_failure(folder, "assemble " + nobody + " -o " + out, nobody);
}

TEST(failures, a_file_of_no_known_format_is_named) {
  const Folder folder;
  folder.write("notes.txt", "hello");
  const std::string notes = folder / "notes.txt";
  expect_clean_failure(folder, "inspect " + notes, "notes.txt");
  expect_clean_failure(folder, "inspect " + folder.path().string(), folder.path().string());
}

TEST(failures, files_that_are_not_what_their_names_say) {
  const Folder folder;
  for (const char* name : {"face.glb", "face.gltf", "face.obj"})
    for (const char* content :
         {"", "hello", "glTF", "{", "[1, 2]", "{\"asset\": {\"version\": \"2.0\"}}", "v 1 2"}) {
      SCOPED_TRACE(content);
      folder.write(name, content);
      const Ran ran = run_mien(folder, "render " + folder / name + " -o " + folder / "out.png");
      EXPECT_EQ(ran.exit_code, 1) << ran.err;
      EXPECT_TRUE(ran.err.starts_with("mien: " + folder / name + ": ")) << ran.err;
      EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
    }
}

TEST(failures, names_that_are_not_known) {
  const Folder folder;
  expect_clean_failure(folder, "sample nobody -o " + folder.path().string(), "nobody");
}

/// One built-in face for the tests below.
class with_a_face : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_mien(folder, "sample human -o " + folder.path().string()).exit_code, 0);
  }
  const Folder folder;
  const std::string face = folder / "human.glb";
};

TEST_F(with_a_face, outputs_that_cannot_be_written) {
  const std::string nowhere = folder / "no/such/folder/";
  expect_clean_failure(folder, "render " + face + " --size 16,16 -o " + nowhere + "x.png", nowhere + "x.png");
  expect_clean_failure(folder, "transfer " + face + " " + face + " -o " + nowhere + "x.glb",
                       nowhere + "x.glb");
  expect_clean_failure(folder, "render " + face + " -o " + folder / "out.jpeg", "out.jpeg");
  expect_clean_failure(folder, "transfer " + face + " " + face + " -o " + folder / "out.fbx", "out.fbx");
}

TEST_F(with_a_face, weights_and_shapes_that_do_not_fit) {
  const std::string out = " -o " + folder / "out.png", weights = folder / "weights.json";
  expect_clean_failure(folder, "render " + face + out + " --shape noSuchShape=1", "noSuchShape");
  expect_clean_failure(folder, "render " + face + out + " --size 0,10", "");
  expect_clean_failure(folder, "render " + face + out + " --view behind", "behind");
  for (const char* content : {"", "{}", "{\"weights\": 3}", "{\"weights\": {\"jawOpen\": \"much\"}}",
                              "{\"weights\": {\"noSuchShape\": 1}}"}) {
    folder.write("weights.json", content);
    expect_clean_failure(folder, "render " + face + out + " --weights " + weights, "weights.json");
  }
}

TEST_F(with_a_face, landmarks_that_cannot_be_used) {
  const std::string begin = "transfer " + face + " " + face + " -o " + folder / "out.glb --target-landmarks ";
  const std::string landmarks = folder / "points.json";
  expect_clean_failure(folder, begin + folder / "nothing.json", "nothing.json");
  for (const char* content :
       {"", "[]", "{\"landmarks\": {\"ibug_1\": {\"vertex\": 99999999}}}",
        "{\"landmarks\": {\"ibug_1\": {}}}", "{\"landmarks\": {\"ibug_1\": {\"position\": [1, 2]}}}",
        "{\"landmarks\": {\"ibug_1\": {\"vertex\": -1}}}"}) {
    folder.write("points.json", content);
    expect_clean_failure(folder, begin + landmarks, "points.json");
  }
  folder.write("points.json", "{\"landmarks\": {\"ibug_1\": {\"vertex\": 1}, \"other\": {\"vertex\": 2}}}");
  // One and the same face needs no landmarks.
  EXPECT_EQ(run_mien(folder, begin + landmarks).exit_code, 0);
}

TEST_F(with_a_face, exaggerations_that_do_not_fit) {
  const std::string begin = "transfer " + face + " " + face + " -o " + folder / "out.glb --exaggerate ";
  expect_clean_failure(folder, begin + "much", "--exaggerate much");
  expect_clean_failure(folder, begin + "noSuchShape=120", "noSuchShape");
}

TEST_F(with_a_face, uvs_that_are_not_shared) {
  ASSERT_EQ(run_mien(folder, "sample cartoon -o " + folder.path().string()).exit_code, 0);
  expect_clean_failure(folder,
                       "transfer " + face + " " + folder / "cartoon.glb" + " -o " + folder / "out.glb" +
                           " --correspondence uvs",
                       "does not share the source's UV layout");
}

}  // namespace
}  // namespace mien::test
