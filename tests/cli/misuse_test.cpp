// What the program says when it is held wrong: exit 2 and a way out; and what its help must hold.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/run_program.h"

namespace mien::test {
namespace {

const std::vector<std::string> commands = {"sample", "inspect", "assemble", "transfer", "render"};

void expect_misuse(const Ran& ran) {
  EXPECT_EQ(ran.exit_code, 2) << ran.err;
  EXPECT_EQ(ran.out, "");
  EXPECT_NE(ran.err.find("--help"), std::string::npos) << "no way out named: " << ran.err;
}

TEST(misuse, no_command) {
  const Folder folder;
  expect_misuse(run_mien(folder, ""));
}

TEST(misuse, unknown_command) {
  const Folder folder;
  expect_misuse(run_mien(folder, "transmogrify a b"));
}

TEST(misuse, unknown_option) {
  const Folder folder;
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    expect_misuse(run_mien(folder, command + " --no-such-option"));
  }
}

TEST(misuse, missing_arguments) {
  const Folder folder;
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    expect_misuse(run_mien(folder, command));
  }
}

TEST(misuse, threads_that_are_no_number) {
  const Folder folder;
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    expect_misuse(run_mien(folder, command + " --threads many"));
    expect_misuse(run_mien(folder, command + " --threads -1"));
  }
}

TEST(help, version_is_a_line) {
  const Folder folder;
  const Ran ran = run_mien(folder, "--version");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_TRUE(ran.out.starts_with("mien 0.")) << ran.out;
}

TEST(help, of_the_program_lists_every_command_with_a_description) {
  const Folder folder;
  const Ran ran = run_mien(folder, "--help");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.err, "");
  for (const std::string& command : commands) {
    const auto at = ran.out.find("\n  " + command + " ");
    ASSERT_NE(at, std::string::npos) << command;
    const std::string line = ran.out.substr(at + 1, ran.out.find('\n', at + 1) - at - 1);
    EXPECT_GT(line.find_last_not_of(' '), command.size() + 2) << "no description: " << line;
  }
}

TEST(help, of_each_command_has_usage_options_and_an_example) {
  const Folder folder;
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    const Ran ran = run_mien(folder, command + " --help");
    EXPECT_EQ(ran.exit_code, 0);
    EXPECT_EQ(ran.err, "");
    EXPECT_NE(ran.out.find("Usage: mien " + command), std::string::npos) << ran.out;
    for (const char* option : {"--help", "--json", "--quiet", "--threads"})
      EXPECT_NE(ran.out.find(option), std::string::npos) << option;
    EXPECT_NE(ran.out.find("mien " + command + " ", ran.out.find("xample")), std::string::npos)
        << "no example";
  }
}

}  // namespace
}  // namespace mien::test
