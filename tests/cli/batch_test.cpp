// Batches: shared sources, failures that stop nothing, resuming, shards.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

class batch : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"human", "cartoon"})
      ASSERT_EQ(
          run_mien(folder, std::string("sample ") + name + " --quiet -o " + folder.path().string()).exit_code,
          0);
    folder.write("crowd.json", R"({"jobs": [
      {"source": "human.glb", "target": "cartoon.glb", "output": "out/a.glb"},
      {"source": "human.glb", "target": "nobody.glb", "output": "out/b.glb"},
      {"source": "human.glb", "target": "human.glb", "output": "out/c.glb"}]})");
  }
  nlohmann::json run(const std::string& flags, int exit_code) {
    const Ran ran = run_mien(folder, "batch " + folder / "crowd.json" + " --json " + flags);
    EXPECT_EQ(ran.exit_code, exit_code) << ran.err;
    return nlohmann::json::parse(ran.out);
  }
  static std::string states(const nlohmann::json& result) {
    std::string text;
    for (const auto& job : result["jobs"]) text += job["state"].get<std::string>() + ". ";
    return text;
  }
  const Folder folder;
};

TEST_F(batch, one_bad_job_stops_no_other_and_a_second_run_skips_what_is_done) {
  const auto first = run("", 1);
  EXPECT_EQ(states(first), "done. failed. done. ");
  const std::string a = text_of(folder / "out/a.glb"), c = text_of(folder / "out/c.glb");
  EXPECT_EQ(states(run("", 1)), "skipped. failed. skipped. ");

  // Side by side or alone, resumed or not, in shards or not: the same bytes.
  std::filesystem::remove(folder / "out/a.glb");
  EXPECT_EQ(states(run("--shard 1/2 --threads 1", 0)), "done. of another shard. skipped. ");
  EXPECT_EQ(text_of(folder / "out/a.glb"), a);
  std::filesystem::remove_all(folder / "out");
  EXPECT_EQ(states(run("--threads 2 --shard 2/2", 1)), "of another shard. failed. of another shard. ");
  EXPECT_EQ(states(run("--shard 1/2", 0)), "done. of another shard. done. ");
  EXPECT_EQ(text_of(folder / "out/a.glb"), a);
  EXPECT_EQ(text_of(folder / "out/c.glb"), c);

  // An input that changed is done again.
  std::filesystem::copy_file(folder / "cartoon.glb", folder / "nobody.glb");
  EXPECT_EQ(states(run("", 0)), "skipped. done. skipped. ");
  const auto report = nlohmann::json::parse(text_of(folder / "crowd.report.json"));
  EXPECT_EQ(states(report), "skipped. done. skipped. ");
}

TEST_F(batch, bad_manifests_are_named) {
  const std::pair<const char*, const char*> table[] = {
      {"{}", "m.json: file: has no \"jobs\""},
      {R"({"jobs": [{"source": "a.glb", "target": "b.glb"}]})", "m.json: jobs[0]: has no"},
      {R"({"jobs": [{"source": "a", "target": "b", "output": "c", "sauce": 1}]})", "sauce"},
      {R"({"jobs": [{"source": "a", "target": "b", "output": "c"}, {"source": "a", "target": "b", "output": "./c"}]})",
       "give each job its own output"},
  };
  for (const auto& [text, expected] : table) {
    folder.write("m.json", text);
    expect_failure(run_mien(folder, "batch " + folder / "m.json"), expected);
  }
  for (const char* shard : {"0/2", "3/2", "x", "1/", "-1/2"})
    expect_failure(run_mien(folder, "batch " + folder / "crowd.json" + " --shard " + shard), "is not I/N");
}

}  // namespace
}  // namespace mien::test
