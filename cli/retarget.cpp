#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "command.h"
#include "mien/core/error.h"
#include "mien/io/capture_file.h"
#include "mien/io/load.h"
#include "mien/io/name_map_file.h"
#include "mien/motion/fit_markers.h"
#include "mien/motion/retarget_joints.h"
#include "mien/motion/retarget_sliders.h"
#include "mien/transfer/retarget_clips.h"

namespace mien::cli {
namespace {

struct Request {
  std::string capture, character, output, map, name;
  std::vector<std::string> gains;
  double rate = 30, neutral = -1;
  bool partial = false;
  RetargetOptions options;
};

/// What a take became on the character, whatever kind it was.
struct Retargeted {
  Clip clip;
  std::vector<std::string> mapped, unmapped, still;
};

void read_gains(const std::vector<std::string>& texts, RetargetOptions& options) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
    char* end = nullptr;
    const double gain = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(gain))
      throw invalid_input("--gain " + text, "is not NAME=FACTOR",
                          "give a slider and a factor: --gain jawOpen=1.2");
    options.gains[text.substr(0, equals)] = gain;
  }
}

Retargeted retarget_slider_take(Request& request, const Character& character) {
  if (request.neutral >= 0) request.options.neutral_at = request.neutral;
  if (!request.map.empty())
    for (const MappedName& name : read_name_map(request.map))
      request.options.links.push_back({name.from, name.to, name.gain});
  const SliderTake take = read_slider_csv(request.capture, request.rate);
  RetargetResult result = retarget(take, character, request.options);
  Retargeted retargeted{std::move(result.clip), {}, std::move(result.unmapped), std::move(result.still)};
  for (const SliderLink& link : result.links) retargeted.mapped.push_back(link.from + " -> " + link.to);
  return retargeted;
}

Retargeted retarget_skeleton(const Request& request, const Character& character) {
  const Character skeleton = read_bvh(request.capture);
  if (skeleton.clips.empty())
    throw invalid_input("motion", "has no frames", "give a take with frames").in_file(request.capture);
  std::map<std::string, std::string> names;
  if (!request.map.empty())
    for (const MappedName& name : read_name_map(request.map)) names[name.from] = name.to;
  RetargetJointsResult result = retarget_joints(skeleton, skeleton.clips[0], character, names);
  return {std::move(result.clip), std::move(result.mapped), std::move(result.unmapped), {}};
}

Retargeted retarget_markers(const Request& request, const Character& character, const Progress& progress) {
  FitMarkersOptions options;
  options.progress = progress;
  options.smooth = request.options.smooth;
  options.neutral_at = std::max(0.0, request.neutral);
  if (!request.map.empty())
    for (const MappedName& name : read_name_map(request.map)) options.landmarks[name.from] = name.to;
  FitMarkersResult result = fit_markers(read_marker_csv(request.capture, request.rate), character, options);
  return {std::move(result.clip), std::move(result.matched), std::move(result.unmapped), {}};
}

Retargeted retarget_capture(Request& request, const Character& character, const Progress& progress) {
  switch (capture_kind(request.capture)) {
    case CaptureKind::skeleton:
      return retarget_skeleton(request, character);
    case CaptureKind::markers:
      return retarget_markers(request, character, progress);
    default:
      return retarget_slider_take(request, character);
  }
}

std::string list(const char* heading, const std::vector<std::string>& names) {
  if (names.empty()) return {};
  std::string text = fmt::format("{} {}:", heading, names.size());
  for (const std::string& name : names) text += " " + name;
  return text + "\n";
}

bool is_character(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".glb" || extension == ".gltf";
}

/// The clips of a rigged character on another that has the same rig.
void run_clips(const Request& request, const Common& common) {
  const Character source = load(request.capture);
  Character character = load(request.character);
  RetargetedClips result = [&] {
    try {
      return retarget_clips(source, character);
    } catch (const Error& error) {
      throw error.in_file(request.capture);
    }
  }();
  if (!result.dropped.empty() && !request.partial)
    throw invalid_input("rig",
                        fmt::format("{} channels move what {} does not have, first: {}",
                                    result.dropped.size(), request.character, result.dropped.front()),
                        "two characters of one rig, or --partial to leave these channels out")
        .in_file(request.capture);
  std::string text;
  nlohmann::json clips = nlohmann::json::array();
  for (Clip& clip : result.clips) {
    if (!request.name.empty() && result.clips.size() == 1) clip.name = request.name;
    std::erase_if(character.clips, [&](const Clip& other) { return other.name == clip.name; });
    text += fmt::format("{}: clip {}, {:.2f} s, {} channels\n", request.output, clip.name, clip.duration(),
                        clip.channels.size());
    clips.push_back({{"name", clip.name}, {"seconds", clip.duration()}, {"channels", clip.channels.size()}});
    character.clips.push_back(std::move(clip));
  }
  save(character, request.output);
  for (const std::string& line : result.differences) text += "the rigs differ: " + line + "\n";
  for (const std::string& line : result.dropped) text += "left out: " + line + "\n";
  print_result(common, text,
               {{"output", request.output},
                {"clips", clips},
                {"differences", result.differences},
                {"dropped", result.dropped}});
}

void run(Request& request, const Common& common) {
  if (is_character(request.capture)) return run_clips(request, common);
  read_gains(request.gains, request.options);
  Character character = load(request.character);
  Retargeted retargeted;
  try {
    retargeted = retarget_capture(request, character, progress_bar(common));
  } catch (const Error& error) {
    throw error.in_file(request.capture);
  }
  if (!request.name.empty()) retargeted.clip.name = request.name;
  std::erase_if(character.clips, [&](const Clip& clip) { return clip.name == retargeted.clip.name; });
  const double seconds = retargeted.clip.duration();
  const std::size_t channels = retargeted.clip.channels.size();
  character.clips.push_back(std::move(retargeted.clip));
  save(character, request.output);
  const std::string& name = character.clips.back().name;
  print_result(common,
               fmt::format("{}: clip {}, {:.2f} s, {} channels\n", request.output, name, seconds, channels) +
                   list("not mapped", retargeted.unmapped) + list("not moved", retargeted.still),
               {{"output", request.output},
                {"clip", name},
                {"seconds", seconds},
                {"channels", channels},
                {"mapped", retargeted.mapped},
                {"unmapped", retargeted.unmapped},
                {"still", retargeted.still}});
}

}  // namespace

void add_retarget(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("retarget", "Put a captured performance on CHARACTER as a clip");
  auto request = std::make_shared<Request>();
  RetargetOptions& options = request->options;
  command
      ->add_option(
          "capture", request->capture,
          "Live Link Face or other slider CSV, marker CSV (NAME.x, NAME.y, NAME.z), BVH skeleton, or a "
          "character (.glb, .gltf) of the same rig, whose clips are adapted to CHARACTER's proportions")
      ->required();
  command->add_option("character", request->character, "A character with sliders or joints (.glb, .gltf)")
      ->required();
  command->add_option("-o,--output", request->output, "The character with the clip (.glb, .gltf)")
      ->required();
  command->add_option("--map", request->map,
                      "Names of the capture to names of the character, instead of the usual ones "
                      "({\"map\": {FROM: TO or {\"to\": TO, \"gain\": G}}})");
  command->add_option("--name", request->name,
                      "Name of the clip; one of this name is replaced (default: capture, or the take's)");
  command
      ->add_option(
          "--neutral", request->neutral,
          "Second at which the actor's face is neutral (default: sliders are not calibrated, markers at 0)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag(
      "--partial", request->partial,
      "From a character: leave out what moves joints, shapes or objects that CHARACTER does not have");
  command->add_option("--gain", request->gains, "SLIDER=FACTOR, as often as needed");
  command->add_flag("--overdrive", options.overdrive, "Keep values beyond a slider's range");
  command
      ->add_option("--smooth", options.smooth,
                   "Smooth noise over this many seconds; blinks stay quick; 0: not")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--rate", request->rate, "Frames a second of a CSV without times")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_flag("!--no-joints", options.joints, "Leave head and eye joints alone");
  command->footer("Example: mien retarget take.csv face.glb -o talking.glb --neutral 0.5");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
