#include "mien/sample/sample.h"

#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "mien/core/error.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"

namespace mien::cli {
namespace {

namespace fs = std::filesystem;

struct SampleOptions {
  std::string name;
  std::string directory = ".";
  bool list = false;
};

void print_list(const Common& common) {
  std::string text;
  auto result = nlohmann::json::array();
  for (const SampleInfo& info : sample_list()) {
    text += fmt::format("{:<10} {}\n", info.name, info.description);
    result.push_back({{"name", info.name}, {"description", info.description}, {"target", info.is_target}});
  }
  print_result(common, text, result);
}

/// Writes one character and returns the files.
std::vector<std::string> write_sample(const SampleInfo& info, const fs::path& directory) {
  const Character character = make_sample(info.name);
  const std::string name(info.name);
  std::vector<std::string> files;
  const auto path = [&](const char* extension) {
    files.push_back((directory / (name + extension)).string());
    return fs::path(files.back());
  };
  save(character, path(".glb"));
  if (info.is_target) save(character, path(".obj"));
  write_landmarks({character.landmarks, character.curves, {}}, character, path(".landmarks.json"));
  return files;
}

void run(const SampleOptions& options, const Common& common) {
  if (options.list) return print_list(common);
  std::vector<SampleInfo> chosen;
  for (const SampleInfo& info : sample_list())
    if (options.name == "all" || options.name == info.name) chosen.push_back(info);
  if (chosen.empty()) make_sample(options.name);  // says which names there are
  std::error_code failure;
  fs::create_directories(options.directory, failure);
  if (failure)
    throw io_error(options.directory, "cannot be made: " + failure.message(),
                   "name a folder that can be written");
  std::string text;
  auto result = nlohmann::json::array();
  for (const SampleInfo& info : chosen)
    for (const std::string& file : write_sample(info, options.directory)) {
      text += file + "\n";
      result.push_back(file);
    }
  print_result(common, text, {{"files", result}});
}

}  // namespace

void add_sample(CLI::App& app, Common& common) {
  auto options = std::make_shared<SampleOptions>();
  CLI::App* command = app.add_subcommand("sample", "Write a built-in character");
  auto* name = command->add_option("name", options->name, "Which character; all: every one");
  command->add_option("-o,--output", options->directory, "Folder to write to, made if absent")
      ->capture_default_str();
  auto* list = command->add_flag("--list", options->list, "Print the built-in characters");
  list->excludes(name);
  command->footer(
      "Writes NAME.glb with the landmarks inside, NAME.landmarks.json and, for a bare target, NAME.obj.\n"
      "Example: mien sample human -o characters");
  command->callback([options, list, name, &common] {
    if (!*list && !*name) throw CLI::RequiredError("name or --list");
    run(*options, common);
  });
}

}  // namespace mien::cli
