#include "mien/picture/render.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/file.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/io/weights_file.h"
#include "mien/picture/object_lines.h"
#include "mien/picture/region.h"
#include "mien/picture/sheet.h"

namespace mien::cli {
namespace {

struct Arguments {
  std::filesystem::path character, output, weights, landmarks_file;
  std::vector<std::string> shapes;  // NAME=WEIGHT
  std::string clip, view = std::string(name_of(View::front)), zoom;
  std::vector<int> size;
  double time = 0;
  bool sheet = false, wireframe = false, landmarks = false, objects = false, plain = false, textured = false;
  /// A still shows the face as it looks; a sheet is there to judge shapes by, which images hide.
  Surfaces surfaces() const { return plain || (sheet && !textured) ? Surfaces::clay : Surfaces::painted; }
};

void set_shape(const Character& character, const std::string& argument, ShapeWeights& weights) {
  const std::size_t equals = argument.rfind('=');
  const std::string name = argument.substr(0, equals);
  double weight = 1;
  if (equals != std::string::npos) {
    const std::string number = argument.substr(equals + 1);
    char* end = nullptr;
    weight = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(weight))
      throw invalid_input("--shape " + argument, "has no number after =", "--shape jawOpen=0.4");
  }
  weights.values[shape_index(character, name)] = weight;
}

const Clip& clip_of_name(const Character& character, const std::string& name) {
  for (const Clip& clip : character.clips)
    if (clip.name == name) return clip;
  std::string known;
  for (const Clip& clip : character.clips) known += (known.empty() ? "one of: " : ", ") + clip.name;
  throw invalid_input("clip " + name, "does not exist", known.empty() ? "the character has no clips" : known);
}

Pose pose_of(const Character& character, const Arguments& arguments) {
  Pose pose = rest_pose(character);
  if (!arguments.clip.empty())
    pose = sample_clip(character, clip_of_name(character, arguments.clip), arguments.time);
  if (!arguments.weights.empty()) {
    pose.shape_weights = shape_weights(character, read_weights(arguments.weights, character));
    pose.wires = read_wire_moves(arguments.weights, character);
  }
  for (const std::string& shape : arguments.shapes) set_shape(character, shape, pose.shape_weights);
  return pose;
}

RenderOptions options_of(const Character& character, const Arguments& arguments) {
  RenderOptions options;
  options.view = view_of_name(arguments.view);
  options.width = arguments.sheet ? 240 : 1024;
  options.height = arguments.sheet ? 280 : 1024;
  if (!arguments.size.empty()) {
    options.width = arguments.size[0];
    options.height = arguments.size[1];
  }
  options.wireframe = arguments.wireframe;
  const std::vector<Points> rest = evaluate(character, rest_pose(character));
  if (!arguments.zoom.empty()) {
    options.zoom = find_region(character, rest, region_of_name(arguments.zoom));
    if (!options.zoom)
      throw invalid_input("--zoom " + arguments.zoom, "finds nothing named like it",
                          "landmarks, shapes or parts with such names");
  }
  FrameOptions frame;
  frame.view = options.view;
  frame.aspect = static_cast<double>(options.width) / options.height;
  if (!options.zoom) options.camera = frame_head(character, rest, frame);
  return options;
}

void add_landmarks(const Character& character, const std::vector<Points>& posed, RenderOptions& options) {
  const auto at = [&](const SurfacePoint& point) {
    return position_of(character.parts[point.part].mesh, posed[point.part], point);
  };
  for (const Landmark& landmark : character.landmarks)
    options.markers.push_back({at(landmark.at), landmark.name, {0.85f, 0.1f, 0.1f}});
  for (const LandmarkCurve& curve : character.curves) {
    Polyline line;
    for (const SurfacePoint& point : curve.points) line.points.push_back(at(point));
    options.polylines.push_back(std::move(line));
  }
}

/// A picture, and what could not be drawn on it.
struct Drawn {
  Picture picture;
  std::vector<std::string> warnings;
};

/// What is drawn over the face in this pose.
void add_overlay(const Character& character, const Arguments& arguments, const Pose& pose,
                 const std::vector<Points>& posed, RenderOptions& options) {
  options.markers.clear();
  options.polylines.clear();
  if (arguments.objects) options.polylines = object_lines(character, pose);
  if (arguments.landmarks) add_landmarks(character, posed, options);
}

Drawn draw_still(const Character& character, const Arguments& arguments, const Progress& progress) {
  RenderOptions options = options_of(character, arguments);
  const Pose pose = pose_of(character, arguments);
  const std::vector<Points> posed = evaluate(character, pose);
  add_overlay(character, arguments, pose, posed, options);
  report_progress(progress, "render", 0);
  const Renderer renderer(character, arguments.surfaces());
  Drawn drawn{renderer.render(posed, options), renderer.warnings()};
  report_progress(progress, "render", 1);
  return drawn;
}

/// The neutral, then every shape at weight 1, in the character's order.
Drawn draw_sheet(const Character& character, const Arguments& arguments, const Progress& progress) {
  RenderOptions options = options_of(character, arguments);
  const Renderer renderer(character, arguments.surfaces());
  const std::size_t count = character.shapes.size();
  std::vector<SheetCell> cells;
  for (std::size_t s = 0; s <= count; ++s) {
    Pose pose = pose_of(character, arguments);
    if (s > 0) pose.shape_weights.values[static_cast<Eigen::Index>(s - 1)] = 1;
    const std::vector<Points> posed = evaluate(character, pose);
    add_overlay(character, arguments, pose, posed, options);
    cells.push_back({s == 0 ? "neutral" : character.shapes[s - 1].name, renderer.render(posed, options), {}});
    report_progress(progress, "render", static_cast<double>(s + 1) / static_cast<double>(count + 1));
  }
  SheetOptions sheet;
  sheet.title = arguments.character.filename().string();
  sheet.footer = fmt::format("{} shapes at weight 1", count);
  return {contact_sheet(cells, sheet), renderer.warnings()};
}

void run(const Arguments& arguments, const Common& common) {
  const auto start = std::chrono::steady_clock::now();
  if (arguments.output.extension() != ".png")
    throw invalid_input(arguments.output.string(), "is not a picture that mien writes",
                        "a name that ends in .png");
  Character character = load(arguments.character);
  if (!arguments.landmarks_file.empty()) {
    LandmarkSet set = read_landmarks(arguments.landmarks_file, character);
    character.landmarks = std::move(set.landmarks);
    character.curves = std::move(set.curves);
  }
  const Progress progress = progress_bar(common);
  Drawn drawn;
  try {
    drawn = arguments.sheet ? draw_sheet(character, arguments, progress)
                            : draw_still(character, arguments, progress);
  } catch (const Error& error) {
    throw error.in_file(arguments.character.string());
  }
  const Picture& picture = drawn.picture;
  write_file_atomically(arguments.output, encode_png(picture));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string text = fmt::format("{}: {} x {} pixels, {:.2f} s\n", arguments.output.string(), picture.width,
                                 picture.height, seconds);
  for (const std::string& warning : drawn.warnings) text += fmt::format("warning: {}\n", warning);
  print_result(common, text,
               {{"output", arguments.output.string()},
                {"warnings", drawn.warnings},
                {"width", picture.width},
                {"height", picture.height},
                {"seconds", seconds}});
}

}  // namespace

void add_render(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("render", "Draw a character: a still, or a contact sheet of its shapes");
  command->footer("Example: mien render head.glb -o smile.png --shape mouthSmileLeft=1 --view three-quarter");
  command->add_option("CHARACTER", arguments->character, "The character (.glb, .gltf, .obj)")->required();
  command->add_option("-o,--output", arguments->output, "The picture to write (.png)")->required();
  command->add_option("--weights", arguments->weights,
                      "Shape weights to pose with: {\"weights\": {NAME: NUMBER}}");
  command
      ->add_option("--shape", arguments->shapes,
                   "NAME=WEIGHT: one shape weight (1 without =WEIGHT); repeatable")
      ->type_name("NAME=WEIGHT")
      ->allow_extra_args(false);
  command->add_option("--clip", arguments->clip, "The clip to pose by")->type_name("NAME");
  command->add_option("--time", arguments->time, "Time in the clip, seconds")->capture_default_str();
  command->add_flag("--sheet", arguments->sheet,
                    "A labelled contact sheet: the neutral and every shape at weight 1");
  command->add_option("--view", arguments->view, "front, left, right or three-quarter")
      ->capture_default_str();
  command
      ->add_option("--size", arguments->size,
                   "W,H in pixels; of a cell with --sheet (default: 1024,1024; 240,280 with --sheet)")
      ->delimiter(',')
      ->expected(2)
      ->type_name("W,H");
  command->add_option("--zoom", arguments->zoom, "Frame the mouth or the eyes alone (default: the head)")
      ->type_name("mouth|eyes");
  auto* plain =
      command->add_flag("--plain", arguments->plain,
                        "Clay, without images and vertex colours, to judge shape by (default with --sheet)");
  command->add_flag("--textured", arguments->textured, "Draw images and vertex colours on a sheet too")
      ->excludes(plain);
  command->add_flag("--wireframe", arguments->wireframe, "Draw the edges of the polygons");
  command->add_flag("--landmarks", arguments->landmarks, "Draw the character's landmarks and curves");
  command->add_flag("--objects", arguments->objects,
                    "Draw the influence objects: curves green, surfaces red, lattices blue, meshes brown, "
                    "clusters and locators violet");
  command->add_option("--landmarks-file", arguments->landmarks_file, "Draw the landmarks of this file")
      ->each([arguments](const std::string&) { arguments->landmarks = true; });
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
