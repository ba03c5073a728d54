#include "mien/extract/blend.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/extract/edit_wires.h"
#include "mien/io/load.h"
#include "mien/io/weights_file.h"

namespace mien::cli {
namespace {

struct BlendArguments {
  std::string character, from, to, output, uniform = "linear";
  std::vector<std::string> features;
  BlendOptions options;
  SaveOptions save;
};

FeatureFunction feature_function(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw invalid_input("--feature " + text, "names no function", "NAME=FUNCTION, as eyes=sqrt");
  return {text.substr(0, equals), blend_function(std::string_view(text).substr(equals + 1))};
}

void run(BlendArguments& arguments, const Common& common) {
  const Character character = load(arguments.character);
  for (const std::string& text : arguments.features)
    arguments.options.functions.push_back(feature_function(text));
  arguments.options.uniform = blend_function(arguments.uniform);
  const auto expression = [&](const std::string& file) {
    return shape_weights(character, read_weights(file, character));
  };
  const ShapeWeights from = expression(arguments.from), to = expression(arguments.to);
  Character blended;
  try {
    blended = blend(character, from, to, arguments.options);
  } catch (const Error& error) {
    throw error.in_file(arguments.character);
  }
  save(blended, arguments.output, arguments.save);
  nlohmann::json features = nlohmann::json::array();
  for (const std::string& feature : wire_features(character)) features.push_back(feature);
  print_result(common,
               fmt::format("{}: clip {}, {} frames, {:.2f} s\n", arguments.output, arguments.options.name,
                           arguments.options.frames, blended.clips.back().duration()),
               {{"output", arguments.output},
                {"clip", arguments.options.name},
                {"frames", arguments.options.frames},
                {"seconds", blended.clips.back().duration()},
                {"features", features}});
}

}  // namespace

void add_blend(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<BlendArguments>();
  CLI::App* command =
      app.add_subcommand("blend", "Make a clip from one expression to another, each feature at its own pace");
  command->add_option("CHARACTER", arguments->character, "A character with wires (mien wires)")->required();
  command->add_option("--from", arguments->from, "The first expression: {\"weights\": {NAME: NUMBER}}")
      ->required();
  command->add_option("--to", arguments->to, "The last expression: {\"weights\": {NAME: NUMBER}}")
      ->required();
  command
      ->add_option("--feature", arguments->features,
                   "NAME=FUNCTION, repeatable: linear, sqrt, cube, or points t,g as 0,0;0.3,0.9;1,1")
      ->allow_extra_args(false);
  command->add_option("--uniform", arguments->uniform, "The function of all that --feature does not name")
      ->capture_default_str();
  command->add_option("--frames", arguments->options.frames, "Frames, both ends included")
      ->capture_default_str();
  command->add_option("--fps", arguments->options.frames_per_second, "Frames a second")
      ->capture_default_str();
  command->add_option("--name", arguments->options.name, "The clip's name")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "The character with the clip: .glb or .gltf")
      ->required();
  command->add_flag("--compress", arguments->save.compress, "Write EXT_meshopt_compression");
  command->footer(
      "Example: mien blend ict_wires.glb --from sad.json --to happy.json --feature eyes=sqrt --feature "
      "mouth=cube "
      "--frames 60 -o blend.glb");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
