#pragma once
/// What the commands share: one file a command, each adding itself to the application.

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "mien/core/progress.h"

namespace mien::cli {

/// Flags that every command understands.
struct Common {
  bool json = false;   ///< print the result as one JSON object on stdout
  bool quiet = false;  ///< print nothing but errors
  int threads = 0;     ///< 0: all cores
};

/// A progress bar on stderr when it is a terminal and the user did not ask for quiet or JSON; otherwise none.
/// Ctrl-C cancels.
Progress progress_bar(const Common& common);

/// Prints `text` for people or, with --json, `result` for programs.
void print_result(const Common& common, const std::string& text, const nlohmann::json& result);

// One function a command, in the file of its name: declares the command's options on `app` and what runs.
void add_inspect(CLI::App& app, Common& common);
void add_assemble(CLI::App& app, Common& common);
void add_transfer(CLI::App& app, Common& common);
void add_render(CLI::App& app, Common& common);
void add_evaluate(CLI::App& app, Common& common);
void add_landmarks(CLI::App& app, Common& common);
void add_retarget(CLI::App& app, Common& common);
void add_constrain(CLI::App& app, Common& common);
void add_vrm(CLI::App& app, Common& common);
void add_controls(CLI::App& app, Common& common);
void add_rename(CLI::App& app, Common& common);
void add_map(CLI::App& app, Common& common);
void add_batch(CLI::App& app, Common& common);
void add_propagate(CLI::App& app, Common& common);
void add_split(CLI::App& app, Common& common);
void add_mirror(CLI::App& app, Common& common);
void add_sample(CLI::App& app, Common& common);
void add_wires(CLI::App& app, Common& common);
void add_objects(CLI::App& app, Common& common);
void add_blend(CLI::App& app, Common& common);
void add_pose(CLI::App& app, Common& common);
void add_attenuate(CLI::App& app, Common& common);

}  // namespace mien::cli
