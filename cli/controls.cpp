#include <fmt/format.h>

#include <memory>
#include <set>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/controls/make_controls.h"
#include "mien/core/error.h"
#include "mien/io/control_config_file.h"
#include "mien/io/file.h"
#include "mien/io/load.h"
#include "mien/io/weights_file.h"
#include "mien/picture/panel.h"
#include "rigging.h"

namespace mien::cli {
namespace {

struct Request {
  std::string character, config, output, picture, weights, print_config;
};

ControlConfig config_of(const Request& request) {
  return request.config.empty() ? default_control_config()
                                : read_control_config(request.config, default_control_config());
}

void draw(const Request& request, const Character& character) {
  RigPose pose = rest_rig_pose(character);
  if (!request.weights.empty()) pose.sliders = read_weights(request.weights, character);
  write_file_atomically(request.picture, encode_png(draw_panel(character, pose)));
}

std::string list_text(const char* what, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return names.empty() ? "" : fmt::format("  {} {}: {}\n", names.size(), what, text);
}

MadeControls make(const Request& request, const Character& character) {
  try {
    return make_controls(character, config_of(request));
  } catch (const Error& error) {
    throw error.in_file(request.config.empty() ? request.character : request.config);
  }
}

void run(const Request& request, const Common& common) {
  if (!request.print_config.empty())
    write_file_atomically(request.print_config, control_config_text(config_of(request)));
  if (request.character.empty()) return;
  const MadeControls made = make(request, load(request.character));
  const Character& character = made.character;
  if (character.controls.empty())
    throw invalid_input("character", "has neither sliders nor joints", "one that can be moved")
        .in_file(request.character);
  save(character, request.output);
  if (!request.picture.empty()) draw(request, character);
  std::set<std::string> regions;
  for (const Control& control : character.controls) regions.insert(control.region);
  print_result(common,
               fmt::format("{}: {} controls in {} regions\n", request.output, character.controls.size(),
                           regions.size()) +
                   list_text("sliders in no region", made.other_sliders) +
                   list_text("joints in no region", made.other_joints) +
                   list_text("rules that fit nothing", made.unused),
               {{"output", request.output},
                {"controls", describe_controls(character)},
                {"other_sliders", made.other_sliders},
                {"other_joints", made.other_joints},
                {"unused", made.unused}});
}

}  // namespace

void add_controls(CLI::App& app, Common& common) {
  CLI::App* command =
      app.add_subcommand("controls", "Make the control interface: sliders and joints by regions of the face");
  auto request = std::make_shared<Request>();
  auto* character = command->add_option("character", request->character, "A character (.glb, .gltf)");
  command->add_option(
      "--config", request->config,
      "Names, regions, limits, mirrors, pads, layout (.json); what it leaves out is as usual");
  auto* output =
      command->add_option("-o,--output", request->output, "The character with its controls (.glb, .gltf)");
  auto* picture = command->add_option("--picture", request->picture, "The panel (.png)");
  command->add_option("--weights", request->weights, "What the panel's sliders show (.json; default: rest)")
      ->needs(picture);
  auto* print = command->add_option("--print-config", request->print_config,
                                    "Write the whole configuration (.json) to start from");
  character->needs(output);
  output->needs(character);
  picture->needs(output);
  command->footer(
      "Example: mien controls head.glb -o head_controls.glb --picture panel.png\n"
      "         mien controls --print-config usual.json\n"
      "CONFIG: {\"regions\": [{\"name\": \"brows left\", \"match\": [\"*brow*\"], \"side\": \"left\"}],\n"
      "         \"limits\": [{\"match\": \"jaw*\", \"rotation\": {\"x\": [0, 0.5]}}]}; docs/controls.md has "
      "all members.");
  command->callback([request, character, print, &common] {
    if (character->count() + print->count() == 0) throw CLI::RequiredError("character or --print-config");
    run(*request, common);
  });
}

}  // namespace mien::cli
