// The page that `mien transfer --report` writes.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"
#include "mien/character/sliders.h"
#include "mien/io/load.h"
#include "mien/sample/sample.h"

namespace mien::test {
namespace {

/// The human with one shape and no clip, and the bare cartoon: a page of few pictures.
std::string small_transfer(const Folder& folder) {
  Character human = make_sample("human");
  human.shapes.resize(1);
  human.sliders.clear();
  complete_sliders(human);
  human.clips.clear();
  save(human, folder / "human.glb", {});
  save(make_sample("cartoon"), folder / "cartoon.glb", {});
  return "transfer " + folder / "human.glb" + " " + folder / "cartoon.glb" + " -o " + folder / "out.glb";
}

TEST(report, is_written_into_a_new_folder) {
  const Folder folder;
  const std::string pages = folder / "some/pages";
  const Ran ran = run_mien(folder, small_transfer(folder) + " --json --report " + pages);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  EXPECT_EQ(nlohmann::json::parse(ran.out)["report"], pages + "/report.html");
  EXPECT_EQ(text_of(pages + "/report.html").substr(0, 15), "<!doctype html>");
  const auto json = nlohmann::json::parse(text_of(pages + "/report.json"));
  EXPECT_EQ(json["source"], "human.glb");
  EXPECT_EQ(json["output"], "out.glb");
}

TEST(report, a_folder_that_cannot_be_made_is_one_line_and_no_output) {
  const Folder folder;
  folder.write("file", "");
  const Ran ran = run_mien(folder, small_transfer(folder) + " --report " + folder / "file/pages");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("the report's folder cannot be made"), std::string::npos) << ran.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
}

}  // namespace
}  // namespace mien::test
