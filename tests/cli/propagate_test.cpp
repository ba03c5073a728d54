// A changed source brought to targets that were worked on.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"
#include "mien/io/load.h"

namespace mien::test {
namespace {

class propagate : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"human", "cartoon"})
      ASSERT_EQ(
          run_mien(folder, std::string("sample ") + name + " --quiet -o " + folder.path().string()).exit_code,
          0);
    ASSERT_EQ(transfer("human.glb", "plain.glb"), 0);
    folder.write("cast.json", R"({"source_before": "human.glb", "source_after": "after.glb", "targets": [
      {"target": "plain.glb", "output": "out/plain.glb"},
      {"target": "worked.glb", "output": "out/worked.glb"}]})");
    // By hand: jawOpen goes further, and there is a shape more.
    Character worked = load(folder / "plain.glb");
    Shape& jaw = worked.shapes[static_cast<std::size_t>(find_shape(worked, "jawOpen"))];
    jaw.parts[0].deltas *= 1.25f;
    Shape own = jaw;
    own.name = "ownShape";
    worked.shapes.push_back(own);
    Slider slider;
    slider.name = "ownShape";
    slider.stops = {{1, static_cast<int>(worked.shapes.size()) - 1}};
    worked.sliders.push_back(slider);
    save(worked, folder / "worked.glb");
    // The source: a weaker smile.
    Character after = load(folder / "human.glb");
    after.shapes[static_cast<std::size_t>(find_shape(after, "mouthSmileLeft"))].parts[0].deltas *= 0.95f;
    save(after, folder / "after.glb");
  }
  int transfer(const std::string& source, const std::string& output) {
    return run_mien(folder, "transfer " + folder / source + " " + folder / "cartoon.glb" + " --quiet -o " +
                                folder / output)
        .exit_code;
  }
  nlohmann::json run(const std::string& flags, int exit_code) {
    const Ran ran = run_mien(folder, "propagate " + folder / "cast.json" + " --json " + flags);
    EXPECT_EQ(ran.exit_code, exit_code) << ran.err;
    return nlohmann::json::parse(ran.out);
  }
  static const Shape& shape(const Character& character, const char* name) {
    return character.shapes.at(static_cast<std::size_t>(find_shape(character, name)));
  }
  static double difference(const Shape& a, const Shape& b) {
    if (a.parts.size() != b.parts.size() || a.parts[0].vertices != b.parts[0].vertices) return 1e9;
    return (a.parts[0].deltas - b.parts[0].deltas).norm() / b.parts[0].deltas.norm();
  }
  const Folder folder;
};

TEST_F(propagate, an_unedited_target_equals_a_fresh_transfer_and_an_edited_one_keeps_its_edits) {
  const auto result = run("", 0);
  ASSERT_EQ(transfer("after.glb", "fresh.glb"), 0);
  const Character fresh = load(folder / "fresh.glb"), plain = load(folder / "out/plain.glb"),
                  worked = load(folder / "out/worked.glb"), edited = load(folder / "worked.glb");
  ASSERT_EQ(plain.shapes.size(), fresh.shapes.size());
  for (std::size_t s = 0; s < fresh.shapes.size(); ++s)
    EXPECT_EQ(difference(plain.shapes[s], fresh.shapes[s]), 0) << fresh.shapes[s].name;
  EXPECT_EQ(difference(shape(worked, "mouthSmileLeft"), shape(fresh, "mouthSmileLeft")), 0);
  EXPECT_EQ(difference(shape(worked, "jawOpen"), shape(edited, "jawOpen")), 0);
  EXPECT_EQ(difference(shape(worked, "ownShape"), shape(edited, "ownShape")), 0);
  EXPECT_EQ(result["jobs"][0]["kept"].size(), 0u);
  EXPECT_EQ(result["jobs"][1]["kept"],
            (nlohmann::json{"shape jawOpen", "shape ownShape", "slider ownShape"}));
  EXPECT_EQ(result["jobs"][1]["updated"], nlohmann::json{"shape mouthSmileLeft"});
  EXPECT_EQ(result["jobs"][1]["conflicts"].size(), 0u);
  const auto again = run("", 0);
  EXPECT_EQ(again["skipped"], 2);
}

TEST_F(propagate, a_source_that_did_not_change_leaves_the_target_as_it_is) {
  std::filesystem::copy_file(folder / "human.glb", folder / "after.glb",
                             std::filesystem::copy_options::overwrite_existing);
  run("", 0);
  EXPECT_EQ(text_of(folder / "out/worked.glb"), text_of(folder / "worked.glb"));
}

TEST_F(propagate, bad_manifests_are_named) {
  const std::pair<const char*, const char*> table[] = {
      {"{}", "source_before"},
      {R"({"source_before": "a", "source_after": "b", "targets": []})", "m.json: file: has no \"targets\""},
      {R"({"source_before": "", "source_after": "b", "targets": []})", "is empty"},
      {R"({"source_before": "a", "source_after": "b", "targets": [{"target": "c"}]})", "targets[0]: has no"},
      {R"({"source_before": "a", "source_after": "b", "targets": [{"target": "c", "output": "d"},
          {"target": "e", "output": "./d"}]})",
       "give each target its own output"},
      {R"({"source_before": "a", "source_after": "b", "sauce": 1, "targets": []})", "sauce"},
  };
  for (const auto& [text, expected] : table) {
    folder.write("m.json", text);
    expect_failure(run_mien(folder, "propagate " + folder / "m.json"), expected);
  }
}

}  // namespace
}  // namespace mien::test
