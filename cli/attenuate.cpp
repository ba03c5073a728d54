#include "mien/pose/attenuate.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/load.h"
#include "mien/io/pins_file.h"
#include "mien/io/weights_file.h"

namespace mien::cli {
namespace {

struct Arguments {
  std::filesystem::path character, tags, from, to, output;
  std::optional<double> alpha;
  bool by_motion = false, open = false;
};

void run(const Arguments& arguments, const Common& common) {
  if (arguments.output.extension() != ".json")
    throw invalid_input(arguments.output.string(), "is no weights file", "a name that ends in .json");
  const Character character = load(arguments.character);
  const std::vector<Tag> tags = read_tags(arguments.tags, character);
  RigPose tagging = rest_rig_pose(character);
  tagging.sliders = read_weights(arguments.from, character);
  const SliderValues wished = read_weights(arguments.to, character);
  AttenuateOptions options;
  options.alpha = arguments.alpha;
  options.rule = arguments.by_motion ? AlphaRule::motion : AlphaRule::coordinates;
  options.within_limits = !arguments.open;
  const AttenuateResult result = attenuate(character, tags, tagging, wished, options);
  write_weights(result.sliders, character, arguments.output);
  nlohmann::json changed = nlohmann::json::object();
  std::string text =
      fmt::format("{}\n  alpha {:.4g}; tagged coordinates move by {:.4g} (rms) instead of {:.4g}\n",
                  arguments.output.string(), result.alpha, result.drift, result.unattenuated_drift);
  for (std::size_t s = 0; s < character.sliders.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    const double asked = wished.values[row], got = result.sliders.values[row];
    if (std::abs(asked - got) <= 1e-6) continue;
    changed[character.sliders[s].name] = {{"asked", asked}, {"attenuated", got}};
    text += fmt::format("  {:<28} {:>8.4f} -> {:.4f}\n", character.sliders[s].name, asked, got);
  }
  print_result(common, text,
               {{"output", arguments.output.string()},
                {"alpha", result.alpha},
                {"drift", result.drift},
                {"unattenuated_drift", result.unattenuated_drift},
                {"changed", changed}});
}

}  // namespace

void add_attenuate(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("attenuate", "Move sliders while tagged points stay still");
  command->footer(
      "Example: mien attenuate head.glb --tags lids.json --from blink.json --to browUp.json -o kept.json\n"
      "TAGS: {\"tags\": [{\"at\": {\"vertex\": 17}, \"axes\": \"xyz\"}]}");
  command->add_option("CHARACTER", arguments->character, "The character (.glb, .gltf)")->required();
  command->add_option("--tags", arguments->tags, "The coordinates that are to stay (.json)")->required();
  command->add_option("--from", arguments->from, "Slider values when they were tagged (.json)")->required();
  command->add_option("--to", arguments->to, "Slider values now (.json)")->required();
  command->add_option("-o,--output", arguments->output, "The attenuated slider values (.json)")->required();
  command->add_option("--alpha", arguments->alpha,
                      "How still, 0 or more, no unit (default: untagged over tagged coordinates)");
  command->add_flag("--by-motion", arguments->by_motion,
                    "Default alpha by the shapes' motion (tr P / tr Q) instead of counts");
  command->add_flag("--open", arguments->open, "Let slider values leave their ranges");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
