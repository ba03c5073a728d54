#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/posed_character.h"
#include "mien/io/load.h"
#include "mien/io/pins_file.h"
#include "mien/io/weights_file.h"
#include "mien/pose/solve_pins.h"

namespace mien::cli {
namespace {

using nlohmann::json;

struct Arguments {
  std::filesystem::path character, pins, start, output;
  SolvePinsOptions options;
  std::optional<double> alpha, mu;
  std::string prior_clip;
};

SolvePinsOptions options_of(const Character& character, const Arguments& arguments, const PinSet& set) {
  SolvePinsOptions options = arguments.options;
  if (arguments.alpha || arguments.mu)
    options.file_units = FileUnitWeights{arguments.alpha.value_or(0), arguments.mu.value_or(0)};
  options.locked = set.locked;
  options.exclusive = set.exclusive;
  options.stiffness = set.stiffness;
  for (const NamedLimits& limits : set.limits)
    options.limits.push_back({limits.slider, limits.low, limits.high});
  for (const int wire : set.wires) options.wires.push_back({wire});
  for (const NamedJoint& joint : set.joints)
    options.joints.push_back(
        {joint.node, joint.turn_low, joint.turn_high, joint.shift_low, joint.shift_high});
  if (arguments.prior_clip.empty()) return options;
  std::vector<Clip> clips;
  for (const Clip& clip : character.clips)
    if (clip.name == arguments.prior_clip) clips.push_back(clip);
  if (clips.empty())
    throw invalid_input("clip " + arguments.prior_clip, "does not exist", "mien inspect lists the clips");
  options.prior = learn_prior(character, clips);
  return options;
}

/// Wires that the drag added a move to.
std::vector<int> moved_wires(const RigPose& start, const SolvePinsResult& result) {
  std::vector<int> wires;
  for (std::size_t m = start.wires.size(); m < result.pose.wires.size(); ++m)
    wires.push_back(result.pose.wires[m].wire);
  return wires;
}

json as_json(const Character& character, const SolvePinsResult& result, const RigPose& start) {
  json moved = json::object();
  for (const int s : result.moved)
    moved[character.sliders[s].name] = {{"from", start.sliders.values[s]},
                                        {"to", result.pose.sliders.values[s]}};
  json wires = json::array();
  for (const int w : moved_wires(start, result)) wires.push_back(character.wires[w].name);
  return {{"misses", result.misses},
          {"moved", moved},
          {"wires", wires},
          {"hard_met", result.hard_met},
          {"converged", result.converged},
          {"solves", result.solves},
          {"objective", result.objective}};
}

std::string as_text(const Character& character, const SolvePinsResult& result, const RigPose& start) {
  std::string text;
  for (std::size_t p = 0; p < result.misses.size(); ++p)
    text += fmt::format("  pin {:<3} misses its goal by {:.4g}\n", p + 1, result.misses[p]);
  if (!result.hard_met) text += "  hard pins cannot be met within the limits: this is the nearest pose\n";
  for (const int s : result.moved)
    text += fmt::format("  {:<28} {:>8.4f} -> {:.4f}\n", character.sliders[s].name, start.sliders.values[s],
                        result.pose.sliders.values[s]);
  for (const int w : moved_wires(start, result)) text += "  wire " + character.wires[w].name + " moves\n";
  if (result.moved.empty()) text += "  no slider moves\n";
  return text;
}

void write_pose(const Character& character, const RigPose& pose, const std::filesystem::path& output) {
  if (output.extension() == ".json") return write_weights(pose.sliders, character, output, pose.wires);
  save(posed_character(character, pose_of(character, pose)), output);
}

void run(const Arguments& arguments, const Common& common) {
  const std::string extension = arguments.output.extension().string();
  if (extension != ".json" && extension != ".obj" && extension != ".glb" && extension != ".gltf")
    throw invalid_input(arguments.output.string(), "is no file that mien poses into",
                        "a name that ends in .json, .obj or .glb");
  const Character character = load(arguments.character);
  const PinSet set = read_pins(arguments.pins, character);
  RigPose start = rest_rig_pose(character);
  if (!arguments.start.empty()) {
    start.sliders = read_weights(arguments.start, character);
    start.wires = read_wire_moves(arguments.start, character);
  }
  const auto begin = std::chrono::steady_clock::now();
  const SolvePinsResult result = [&] {
    try {
      return solve_pins(character, set.pins, start, options_of(character, arguments, set));
    } catch (const Error& error) {
      throw error.in_file(arguments.pins.string());
    }
  }();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_pose(character, result.pose, arguments.output);
  json report = as_json(character, result, start);
  report["output"] = arguments.output.string();
  report["seconds"] = seconds;
  print_result(common, fmt::format("{}\n{}", arguments.output.string(), as_text(character, result, start)),
               report);
}

}  // namespace

void add_pose(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("pose", "Pull on points of the face: the sliders follow");
  command->footer(
      "Example: mien pose head.glb --pins pins.json --start smile.json -o pulled.json\n"
      "PINS: {\"pins\": [{\"at\": {\"vertex\": 17}, \"move\": [0, 0.01, 0], \"axes\": \"xyz\", \"weight\": "
      "1, \"hard\": false}],\n"
      "       \"locked\": [\"eyeBlinkLeft\"], \"limits\": {\"jawOpen\": [0, 1.2]}, \"wires\": "
      "[\"lipUpperOuter\"]}");
  command->add_option("CHARACTER", arguments->character, "The character (.glb, .gltf)")->required();
  command->add_option("--pins", arguments->pins, "What is pulled where (.json)")->required();
  command->add_option("--start", arguments->start,
                      "Slider values and moves of wires to start from (.json) (default: the rest pose)");
  command
      ->add_option("-o,--output", arguments->output,
                   ".json: slider values and moves of wires; .obj, .glb: the posed face")
      ->required();
  SolvePinsOptions& options = arguments->options;
  command->add_option("--rho", options.rho, "How soft the pins are, without unit: alpha = rho |B|^2 / 3")
      ->capture_default_str();
  command->add_option("--alpha", arguments->alpha,
                      "Cost of changing sliders, in the file's unit squared, instead of --rho");
  command->add_option("--mu", arguments->mu,
                      "Pull of sliders to 0, in the file's unit squared, with --alpha");
  command->add_option("--decay", options.decay, "Pull of sliders to 0 as a share of alpha, with --rho")
      ->capture_default_str();
  command->add_option("--sparse", options.sparsity, "Few sliders move: 0 all may, towards 1 ever fewer")
      ->capture_default_str();
  command
      ->add_option("--prior", arguments->prior_clip, "Prefer changes that this clip of the character knows")
      ->type_name("CLIP");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
