#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "find_landmarks.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/file.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/picture/render.h"
#include "mien/sample/sample.h"

namespace mien::cli {

FoundLandmarks find_landmarks_of(const std::string& file, const Character& target, const Character& like,
                                 const FindLandmarksOptions& options) {
  try {
    FoundLandmarks found = find_landmarks(target, like, options);
    if (found.verdict == Verdict::refuse)
      throw invalid_input("landmarks",
                          fmt::format("no face was found: {} (score {:.3f}, likeness {:.2f})", found.reason,
                                      found.score, found.likeness),
                          "a head with a face, or three or more given landmarks");
    return found;
  } catch (const Error& error) {
    throw error.in_file(file);
  }
}

std::string text_of(const FoundLandmarks& found) {
  std::string text = fmt::format("{}: {} (score {:.3f}, likeness {:.2f})\n", name_of(found.verdict),
                                 found.reason, found.score, found.likeness);
  for (const DoubtfulPoint& point : found.doubtful)
    text += fmt::format("doubtful: {} is {:.1f} % of the face from where the others put it{}\n", point.name,
                        100 * point.distance,
                        point.looks_like.empty() ? "" : "; it looks like " + point.looks_like);
  return text;
}

nlohmann::json json_of(const FoundLandmarks& found) {
  nlohmann::json confidence = nlohmann::json::object(), curves = nlohmann::json::array(),
                 doubtful = nlohmann::json::array();
  for (const FoundLandmark& one : found.landmarks) confidence[one.landmark.name] = one.confidence;
  for (const LandmarkCurve& curve : found.curves) curves.push_back(curve.name);
  for (const DoubtfulPoint& point : found.doubtful)
    doubtful.push_back({{"name", point.name},
                        {"distance", point.distance},
                        {"expected", {point.expected.x(), point.expected.y(), point.expected.z()}},
                        {"looks_like", point.looks_like}});
  return {{"verdict", name_of(found.verdict)},
          {"reason", found.reason},
          {"score", found.score},
          {"likeness", found.likeness},
          {"stretch", found.stretch},
          {"confidence", confidence},
          {"curves", curves},
          {"doubtful", doubtful}};
}

namespace {

struct Request {
  std::string mesh, given, like, output, picture;
  std::vector<int> size{1024, 1024};
};

/// Green: sure; yellow: less so; red: not; blue: given.
Color color_of(const FoundLandmark& found) {
  if (found.given) return {0.1f, 0.3f, 0.85f};
  const float c = static_cast<float>(found.confidence);
  return {std::min(1.f, 2 - 2 * c) * 0.85f, std::min(1.f, 2 * c) * 0.65f, 0.1f};
}

void draw(const Request& request, const Character& target, const FoundLandmarks& found) {
  RenderOptions options;
  options.width = request.size[0];
  options.height = request.size[1];
  options.facing = found.facing;
  for (const FoundLandmark& one : found.landmarks)
    options.markers.push_back({one.position, one.landmark.name, color_of(one)});
  write_file_atomically(request.picture,
                        encode_png(render(target, evaluate(target, rest_pose(target)), options)));
}

void run(const Request& request, const Common& common) {
  if (!request.picture.empty() && !request.picture.ends_with(".png"))
    throw invalid_input(request.picture, "is not a picture that mien writes", "a name that ends in .png");
  const Character target = load(request.mesh);
  const Character like = request.like.empty() ? make_sample("human") : load(request.like);
  FindLandmarksOptions options;
  options.progress = progress_bar(common);
  if (!request.given.empty()) options.given = read_landmarks(request.given, target).landmarks;
  const FoundLandmarks found = find_landmarks_of(request.mesh, target, like, options);
  LandmarkSet set{found.points(), found.curves, {}};
  for (const FoundLandmark& one : found.landmarks) set.confidence[one.landmark.name] = one.confidence;
  if (!request.picture.empty()) draw(request, target, found);
  write_landmarks(set, target, request.output);
  nlohmann::json json = json_of(found);
  json["output"] = request.output;
  print_result(common,
               fmt::format("{}: {} landmarks, {} curves\n{}", request.output, found.landmarks.size(),
                           found.curves.size(), text_of(found)),
               json);
}

}  // namespace

void add_landmarks(CLI::App& app, Common& common) {
  CLI::App* command =
      app.add_subcommand("landmarks", "Find the landmarks of a head, from a few given points or none");
  auto request = std::make_shared<Request>();
  command->add_option("mesh", request->mesh, "A head of any unit and orientation (.obj, .glb, .gltf)")
      ->required();
  command->add_option("-o,--output", request->output, "The landmark file to write (.json)")->required();
  command->add_option("--given", request->given,
                      "Landmark file of points that are known: they stay, the others follow");
  command->add_option("--like", request->like,
                      "A character whose landmarks are to be found (default: the built-in human)");
  command->add_option("--picture", request->picture,
                      "Draw the points (.png): green sure, yellow less, red not, blue given");
  command->add_option("--size", request->size, "Of the picture, W,H in pixels")
      ->delimiter(',')
      ->expected(2)
      ->type_name("W,H")
      ->capture_default_str();
  command->footer(
      "Says accept, check or refuse (exit 1, no file), and which given point the others contradict.\n"
      "Example: mien landmarks head.obj -o head.landmarks.json --picture head.png");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
