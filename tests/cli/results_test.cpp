// What the program prints and writes when all is well.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

class results : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_mien(folder, "sample human --quiet -o " + folder.path().string()).exit_code, 0);
  }
  const Folder folder;
  const std::string face = folder / "human.glb";
};

/// Succeeds in silence on stderr; returns what it prints.
std::string succeed(const Folder& folder, const std::string& arguments) {
  const Ran ran = run_mien(folder, arguments);
  EXPECT_EQ(ran.exit_code, 0) << arguments << "\n" << ran.err;
  EXPECT_EQ(ran.err, "") << "no progress bar off a terminal";
  return ran.out;
}

TEST_F(results, json_is_one_object_and_quiet_is_silence) {
  const std::string out = folder / "rigged.glb", png = folder / "face.png", there = folder / "more";
  for (const std::string& arguments :
       {"inspect " + face, "transfer " + face + " " + face + " -o " + out,
        "render " + face + " --size 32,32 -o " + png, "sample human -o " + there}) {
    SCOPED_TRACE(arguments);
    const auto json = nlohmann::json::parse(succeed(folder, arguments + " --json"), nullptr, false);
    EXPECT_TRUE(json.is_object());
    EXPECT_EQ(succeed(folder, arguments + " --quiet"), "");
    EXPECT_NE(succeed(folder, arguments), "");
  }
}

TEST_F(results, sample_writes_what_it_lists) {
  const auto list = nlohmann::json::parse(succeed(folder, "sample --list --json"));
  for (const auto& sample : list.is_array() ? list : list["samples"]) {
    const std::string name = sample["name"];
    succeed(folder, "sample " + name + " -o " + folder.path().string());
    EXPECT_TRUE(std::filesystem::exists(folder / name + ".glb")) << name;
    EXPECT_TRUE(std::filesystem::exists(folder / name + ".landmarks.json")) << name;
  }
}

TEST_F(results, render_writes_a_png_of_the_size_asked_for) {
  succeed(folder, "render " + face + " --size 48,32 -o " + folder / "face.png");
  const std::string png = text_of(folder / "face.png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png[19], 48);
  EXPECT_EQ(png[23], 32);
}

TEST_F(results, same_bytes_at_one_and_two_threads) {
  for (const std::string& arguments :
       {"transfer " + face + " " + face + " -o OUT.glb", "render " + face + " --size 64,64 -o OUT.png",
        std::string("sample human -o OUT")}) {
    SCOPED_TRACE(arguments);
    std::string bytes[2];
    for (int threads = 1; threads <= 2; ++threads) {
      std::string command = arguments;
      const std::string name = folder / ("threads" + std::to_string(threads));
      command.replace(command.find("OUT"), 3, name);
      succeed(folder, command + " --threads " + std::to_string(threads));
      const std::string extension = arguments.substr(arguments.find("OUT") + 3);
      bytes[threads - 1] = text_of(extension.empty() ? name + "/human.glb" : name + extension);
    }
    EXPECT_FALSE(bytes[0].empty());
    EXPECT_TRUE(bytes[0] == bytes[1]) << bytes[0].size() << " and " << bytes[1].size() << " bytes";
  }
}

}  // namespace
}  // namespace mien::test
