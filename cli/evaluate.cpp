#include "mien/evaluate/evaluate.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluator.h"
#include "mien/evaluate/posed_character.h"
#include "mien/io/file.h"
#include "mien/io/load.h"
#include "mien/io/npy.h"
#include "mien/io/weights_file.h"

namespace mien::cli {
namespace {

using nlohmann::json;

struct Arguments {
  std::filesystem::path character, weights, output;
  std::string clip;
  double fps = 24;
  bool compact = false;
};

const Clip& clip_named(const Character& character, const std::string& name) {
  for (const Clip& clip : character.clips)
    if (clip.name == name) return clip;
  std::string names;
  for (const Clip& clip : character.clips) names += (names.empty() ? "" : ", ") + clip.name;
  throw invalid_input("clip " + name, "does not exist",
                      names.empty() ? "the character has no clip" : "one of " + names);
}

/// The frames 0, 1/fps, 2/fps ... of a clip, its end included where a frame falls on it.
std::vector<Pose> clip_poses(const Character& character, const Arguments& arguments) {
  const Clip& clip = clip_named(character, arguments.clip);
  const double frames = std::floor(clip.duration() * arguments.fps + 1e-6) + 1;
  const double numbers = frames * 3 * [&] {
    double vertices = 0;
    for (const Part& part : character.parts) vertices += static_cast<double>(part.mesh.vertex_count());
    return vertices;
  }();
  if (!(numbers < 5e8 && frames < 1e6))
    throw invalid_input("clip " + arguments.clip,
                        fmt::format("has {:.0f} frames at {} a second", frames, arguments.fps),
                        "a frame rate at which all positions take less than 2 GB");
  std::vector<Pose> poses;
  for (int f = 0; f < static_cast<int>(frames); ++f)
    poses.push_back(sample_clip(character, clip, f / arguments.fps));
  return poses;
}

std::vector<Pose> poses_of(const Character& character, const Arguments& arguments) {
  if (!arguments.clip.empty()) return clip_poses(character, arguments);
  RigPose rig = rest_rig_pose(character);
  rig.sliders = read_weights(arguments.weights, character);
  rig.wires = read_wire_moves(arguments.weights, character);
  return {pose_of(character, rig)};
}

std::vector<float> baked(const Evaluator& evaluator, const std::vector<Pose>& poses) {
  std::vector<float> frames(poses.size() * 3 * evaluator.vertex_count());
  evaluator.bake(poses, frames);
  return frames;
}

/// One OBJ a frame; the surfaces stay, the positions change.
void write_folder(const Character& character, const std::vector<Pose>& poses,
                  const std::vector<float>& frames, const Arguments& arguments, const Progress& progress) {
  std::error_code failed;
  std::filesystem::create_directories(arguments.output, failed);
  if (failed)
    throw io_error(arguments.output.string(), "cannot be made a folder", "a place that can be written");
  Character still = posed_character(character, poses[0], SurfaceFrames::dropped);
  const float* at = frames.data();
  for (std::size_t f = 0; f < poses.size(); ++f) {
    for (Part& part : still.parts) {
      part.mesh.positions = Eigen::Map<const Points>(at, part.mesh.positions.rows(), 3);
      at += part.mesh.positions.size();
    }
    save(still, arguments.output / fmt::format("frame_{:05}.obj", f));
    report_progress(progress, "write", static_cast<double>(f + 1) / static_cast<double>(poses.size()));
  }
}

/// What was evaluated, as the report prints it.
struct Written {
  std::size_t frames = 0, vertices = 0;
  double seconds = 0, error = 0;  // of evaluating; of compact deltas, in the file's unit
  const char* instructions = "";
};

Written write(const Character& character, const std::vector<Pose>& poses, const Arguments& arguments,
              const Progress& progress) {
  const std::string extension = arguments.output.extension().string();
  if (poses.size() == 1 && extension != ".npy" && !extension.empty()) {
    const Character still = posed_character(character, poses[0]);
    save(still, arguments.output);
    std::size_t vertices = 0;
    for (const Part& part : still.parts) vertices += part.mesh.vertex_count();
    return {1, vertices, 0, 0, "double precision"};
  }
  EvaluatorOptions options;
  if (arguments.compact) options.precision = DeltaPrecision::compact;
  const Evaluator evaluator(character, options);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<float> frames = baked(evaluator, poses);
  Written written{poses.size(), evaluator.vertex_count(),
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0,
                  name_of(evaluator.instructions())};
  for (const Pose& pose : poses)
    written.error = std::max(written.error, evaluator.compact_error(pose.shape_weights));
  if (extension == ".npy")
    write_npy(frames, {poses.size(), evaluator.vertex_count(), 3}, arguments.output);
  else
    write_folder(character, poses, frames, arguments, progress);
  return written;
}

void check(const Arguments& arguments) {
  const std::string extension = arguments.output.extension().string();
  if (arguments.weights.empty() == arguments.clip.empty())
    throw invalid_input("mien evaluate", "is asked for a pose and a clip, or for neither",
                        "--weights or --clip");
  if (!extension.empty() && extension != ".obj" && extension != ".glb" && extension != ".gltf" &&
      extension != ".npy")
    throw invalid_input(arguments.output.string(), "is no file that mien evaluates into",
                        "a name that ends in .obj, .glb or .npy, or a folder");
  if (!arguments.clip.empty() && !extension.empty() && extension != ".npy")
    throw invalid_input(arguments.output.string(), "holds one pose, and a clip has many",
                        "a .npy, or a folder");
  if (!(arguments.fps > 0) || !std::isfinite(arguments.fps))
    throw invalid_input("--fps", fmt::format("is {}", arguments.fps), "a positive number of frames a second");
}

void run(const Arguments& arguments, const Common& common) {
  check(arguments);
  const Character character = load(arguments.character);
  const Progress progress = progress_bar(common);
  const Written written = [&] {
    try {
      return write(character, poses_of(character, arguments), arguments, progress);
    } catch (const Error& error) {
      if (error.kind() == Error::Kind::invalid_input) throw error.in_file(arguments.character.string());
      throw;
    }
  }();
  std::string text = fmt::format("{}: {} frame{} of {} vertices\n", arguments.output.string(), written.frames,
                                 written.frames == 1 ? "" : "s", written.vertices);
  if (written.seconds > 0)
    text += fmt::format("  evaluated in {:.3g} ms ({})\n", 1e3 * written.seconds, written.instructions);
  if (arguments.compact)
    text += fmt::format("  16-bit deltas: no coordinate off by more than {:.2g} before skinning\n",
                        written.error);
  json report{{"output", arguments.output.string()},
              {"frames", written.frames},
              {"vertices", written.vertices},
              {"seconds", written.seconds},
              {"instructions", written.instructions}};
  if (arguments.compact) report["compact_error"] = written.error;
  print_result(common, text, report);
}

}  // namespace

void add_evaluate(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Write where the vertices are in a pose or in every frame of a clip");
  command->footer("Example: mien evaluate head.glb --clip talk --fps 30 -o talk.npy");
  command->add_option("CHARACTER", arguments->character, "The character (.glb, .gltf, .obj)")->required();
  command
      ->add_option(
          "-o,--output", arguments->output,
          "One pose: .obj, .glb or .npy; a clip: .npy (frames, vertices, 3) of float32, or a folder of OBJs. "
          "Vertices in the file's own order, one part after the other")
      ->required();
  auto* weights = command->add_option("--weights", arguments->weights,
                                      "Slider values of a pose: {\"weights\": {NAME: NUMBER}}");
  command->add_option("--clip", arguments->clip, "The clip to evaluate")
      ->type_name("NAME")
      ->excludes(weights);
  command->add_option("--fps", arguments->fps, "Frames a second of the clip")->capture_default_str();
  command->add_flag("--compact", arguments->compact,
                    "16-bit deltas, half the memory; prints their error bound");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
