#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>

#include "command.h"
#include "mien/core/error.h"
#include "mien/extract/draw_wires.h"
#include "mien/extract/extract_wires.h"
#include "mien/extract/improve_wires.h"
#include "mien/io/curves_file.h"
#include "mien/io/file.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/report/wire_report.h"

namespace mien::cli {
namespace {

namespace fs = std::filesystem;

struct WiresArguments {
  std::string character, curves, landmarks, output, write_curves, reconstruct, report;
  int count = 22, extra = 0;
  bool keep_ranges = false, move_curves = false, varying = false;
  ExtractOptions options;
  SaveOptions save;
};

/// Before anything is read: numbers that no character makes right.
void check_options(const WiresArguments& arguments) {
  const auto require = [](bool right, const char* option, double value, const char* wanted) {
    if (!right) throw invalid_input(option, fmt::format("is {}", value), wanted);
  };
  const ExtractOptions& o = arguments.options;
  require(o.solver.ridge > 0 && std::isfinite(o.solver.ridge), "--ridge", o.solver.ridge,
          "a finite number above 0, as 1e-4");
  require(o.residual >= 0 && std::isfinite(o.residual), "--residual", o.residual,
          "a part of the face's box, 0 or more, as 0.002");
  require(o.residual_vertices >= 0 && o.residual_vertices <= 1, "--residual-vertices", o.residual_vertices,
          "a share of the vertices, 0 to 1, as 0.02");
  require(arguments.count == 15 || arguments.count == 22, "--count", arguments.count, "15 or 22");
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<WireSketch> sketches_of(const WiresArguments& arguments, const Character& character) {
  try {
    return arguments.curves.empty() ? face_wire_sketches(character, arguments.count)
                                    : read_curves(arguments.curves, character);
  } catch (const Error& error) {
    throw error.in_file(arguments.curves.empty() ? arguments.character : arguments.curves);
  }
}

/// The wires as a curves file says them, their longest range among it.
std::vector<WireSketch> sketches_of(const std::vector<Wire>& wires) {
  std::vector<WireSketch> sketches;
  for (const Wire& wire : wires)
    sketches.push_back({wire.name, wire.feature, wire.points, wire.curve.control_count(),
                        *std::max_element(wire.ranges.begin(), wire.ranges.end()), wire.turn_controls,
                        wire.geodesic});
  return sketches;
}

ImproveOptions improve_options(const WiresArguments& arguments) {
  ImproveOptions options;
  options.solver = arguments.options.solver;
  options.varying = arguments.varying;
  options.progress = arguments.options.progress;
  return options;
}

/// Ranges that the file gives stay; the others are looked for.
std::vector<Wire> with_ranges(const WiresArguments& arguments, const Character& character,
                              std::vector<Wire> wires, const std::vector<WireSketch>& sketches) {
  ImproveOptions options = improve_options(arguments);
  for (const WireSketch& sketch : sketches)
    if (sketch.range > 0 && !arguments.curves.empty()) options.fixed.push_back(sketch.name);
  if (arguments.keep_ranges || options.fixed.size() == wires.size()) return wires;
  return improve_wires(character, wires, options).wires;
}

/// One more wire where these leave most over, with a range of its own.
std::vector<Wire> with_another(const WiresArguments& arguments, const Character& character,
                               std::vector<Wire> wires) {
  const WireSketch sketch = propose_wire(character, extract_wires(character, wires, arguments.options));
  ImproveOptions options = improve_options(arguments);
  for (const Wire& wire : wires) options.fixed.push_back(wire.name);
  wires.push_back(draw_wires(character, std::span(&sketch, 1)).front());
  return arguments.keep_ranges ? wires : improve_wires(character, wires, options).wires;
}

/// What counts in the fits. Which vertices are close to a wire does not depend on the ranges that a file gives: wires that were found
/// are judged as when they were looked for.
std::vector<Eigen::VectorXf> seen_weights(const WiresArguments& arguments, const Character& character,
                                          const std::vector<Wire>& wires, std::vector<WireSketch> sketches) {
  if (arguments.curves.empty()) return outer_vertex_weights(character, wires);
  for (WireSketch& sketch : sketches) sketch.range = 0;
  return outer_vertex_weights(character, draw_wires(character, sketches));
}

/// The wires, drawn and improved as the arguments say. Sets what counts in the fits.
std::vector<Wire> wires_of(WiresArguments& arguments, const Character& character) {
  const std::vector<WireSketch> sketches = sketches_of(arguments, character);
  std::vector<Wire> wires;
  try {
    wires = draw_wires(character, sketches);
  } catch (const Error& error) {
    throw error.in_file(arguments.curves.empty() ? arguments.character : arguments.curves);
  }
  arguments.options.solver.vertex_weights = seen_weights(arguments, character, wires, sketches);
  if (arguments.move_curves) wires = move_curves(character, wires, improve_options(arguments)).wires;
  wires = with_ranges(arguments, character, std::move(wires), sketches);
  for (int added = 0; added < arguments.extra; ++added)
    wires = with_another(arguments, character, std::move(wires));
  return wires;
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw io_error("", "the folder cannot be made: " + failure.message()).in_file(folder.string());
}

/// Folders are made and those of files are asked for before anything is written.
void prepare_places(const WiresArguments& arguments) {
  for (const fs::path file : {arguments.output, arguments.write_curves})
    if (file.has_parent_path() && !fs::is_directory(file.parent_path()))
      throw io_error("file", "cannot be written: there is no folder " + file.parent_path().string())
          .in_file(file.string());
  for (const std::string& folder : {arguments.report, arguments.reconstruct})
    if (!folder.empty()) make_folder(folder);
}

std::string file_name_of(const std::string& shape) {
  std::string name = shape.empty() ? "shape" : shape;
  for (char& c : name)
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32) c = '_';
  return name == "." || name == ".." ? "_" + name : name;
}

void write_rebuilt(const Character& original, const ExtractResult& result, const fs::path& folder) {
  for (std::size_t s = 0; s < result.shapes.size(); ++s) {
    Character rebuilt = rebuilt_neutral(original, result, static_cast<int>(s));
    rebuilt.shapes.clear();
    rebuilt.sliders.clear();
    rebuilt.correctives.clear();
    rebuilt.expressions.clear();
    rebuilt.clips.clear();
    save(rebuilt, folder / (file_name_of(result.shapes[s].shape) + ".obj"));
  }
}

/// Of a WireFit or an ExtractResult.
template <typename Fit>
nlohmann::json seen_json(const Fit& fit) {
  return {{"displacement", fit.seen_displacement}, {"error", fit.seen_error}, {"largest", fit.seen_largest}};
}

nlohmann::json as_json(const ExtractResult& result, const WireCompression& compression,
                       double range_seconds) {
  nlohmann::json shapes = nlohmann::json::object(), features = nlohmann::json::object(),
                 wires = nlohmann::json::array();
  double kept = 0;
  for (const WireFit& fit : result.shapes) {
    std::size_t vertices = 0;
    for (const PartDelta& delta : fit.residual) vertices += delta.vertices.size();
    kept += static_cast<double>(vertices);
    shapes[fit.shape] = {{"displacement", fit.displacement},
                         {"error", fit.error},
                         {"kept_error", fit.kept_error},
                         {"largest", fit.largest},
                         {"vertex", fit.vertex},
                         {"residual_vertices", vertices},
                         {"seen", seen_json(fit)}};
  }
  for (const FeatureError& feature : result.features)
    if (!feature.feature.empty())
      features[feature.feature] = {{"displacement", feature.displacement}, {"error", feature.error}};
  for (const Wire& wire : result.character.wires)
    wires.push_back({{"name", wire.name},
                     {"feature", wire.feature},
                     {"ranges", wire.ranges},
                     {"controls", wire.curve.control_count()},
                     {"turns", wire.turn_controls}});
  return {{"wires", wires},
          {"shapes", shapes},
          {"features", features},
          {"displacement", result.displacement},
          {"error", result.error},
          {"kept_error", result.kept_error},
          {"largest", result.largest},
          {"seen", seen_json(result)},
          {"box", result.box},
          {"skin_vertices", result.skin_vertices},
          {"residual_vertices", kept},
          {"compression", {{"dense", compression.dense}, {"sparse", compression.sparse}}},
          {"seconds",
           {{"ranges", range_seconds}, {"setup", result.setup_seconds}, {"shapes", result.solve_seconds}}}};
}

std::string as_text(const ExtractResult& r, const WireCompression& compression, const std::string& output) {
  const auto share = [](double part, double whole) { return whole > 0 ? 100 * part / whole : 0; };
  return fmt::format(
      "{}: {} wires for {} shapes; where it can be seen they leave {:.1f} % of the displacements, at most "
      "{:.2f} % of "
      "the face's box; of all {:.1f} %, {:.1f} % with what is kept beside them\n{:.0f} : 1 against dense "
      "shapes, "
      "{:.0f} : 1 against sparse ones; system {:.0f} ms, {:.2f} ms a shape\n",
      output, r.character.wires.size(), r.shapes.size(), share(r.seen_error, r.seen_displacement),
      share(r.seen_largest, r.box), share(r.error, r.displacement), share(r.kept_error, r.displacement),
      compression.dense, compression.sparse, 1000 * r.setup_seconds,
      r.shapes.empty() ? 0 : 1000 * r.solve_seconds / static_cast<double>(r.shapes.size()));
}

void run(WiresArguments& arguments, const Common& common) {
  check_options(arguments);
  Character character = load(arguments.character);
  if (!arguments.landmarks.empty())
    character.landmarks = read_landmarks(arguments.landmarks, character).landmarks;
  if (character.shapes.empty())
    throw invalid_input("shapes", "are none", "a character with shapes").in_file(arguments.character);
  arguments.options.progress = progress_bar(common);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Wire> wires = wires_of(arguments, character);
  const double range_seconds = seconds_since(start);
  const ExtractResult result = extract_wires(character, wires, arguments.options);
  const WireCompression compression = wire_compression(character, result);
  prepare_places(arguments);
  std::string page;
  if (!arguments.report.empty())
    page = make_wire_report({character, result, fs::path(arguments.character).filename().string(),
                             range_seconds, arguments.options.progress});
  save(result.character, arguments.output, arguments.save);
  if (!arguments.write_curves.empty()) write_curves(sketches_of(wires), character, arguments.write_curves);
  if (!arguments.reconstruct.empty()) write_rebuilt(character, result, arguments.reconstruct);
  const nlohmann::json json = as_json(result, compression, range_seconds);
  if (!arguments.report.empty()) {
    write_file_atomically(fs::path(arguments.report) / "report.html", page);
    write_file_atomically(fs::path(arguments.report) / "report.json", json.dump(1) + "\n");
  }
  print_result(common, as_text(result, compression, arguments.output), json);
}

}  // namespace

void add_wires(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<WiresArguments>();
  CLI::App* command = app.add_subcommand("wires", "Find the wires behind a character's shapes");
  command->add_option("CHARACTER", arguments->character, "A character with shapes")->required();
  command->add_option(
      "--curves", arguments->curves,
      "Reference curves on the neutral: {\"curves\": {NAME: {\"points\": [POINT, ...], \"controls\": 10, "
      "\"range\": 2.5, \"feature\": \"mouth\"}}}; default: through the 68 iBUG landmarks");
  command->add_option("-o,--output", arguments->output, "The character with its wires: .glb or .gltf")
      ->required();
  command->add_option("--landmarks", arguments->landmarks, "Landmarks, where the character has none inside");
  command->add_option("--count", arguments->count, "Wires through the landmarks: 15 or 22")
      ->capture_default_str();
  command->add_option("--extra", arguments->extra, "Wires to add where the others leave most over")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command->add_flag(
      "--move-curves", arguments->move_curves,
      "First move the curves to where they rebuild the shapes best, by at most a quarter of their range");
  command->add_flag("--varying", arguments->varying, "Let ranges vary along the curves: four values each");
  command->add_flag(
      "--keep-ranges", arguments->keep_ranges,
      "Take each wire's length as its range where none is given; otherwise ranges are looked for");
  command
      ->add_option("--ridge", arguments->options.solver.ridge,
                   "Pulls wires towards rest, in units of the mean diagonal entry of the normal equations")
      ->capture_default_str();
  command
      ->add_option("--residual", arguments->options.residual,
                   "Keep what the wires leave over where it exceeds this part of the face's box")
      ->capture_default_str();
  command
      ->add_option("--residual-vertices", arguments->options.residual_vertices,
                   "And on at most this share of the vertices, a shape on average: where it counts most")
      ->capture_default_str();
  command->add_flag("--exact", arguments->options.exact, "Keep the shapes as they are beside their wires");
  command->add_option(
      "--write-curves", arguments->write_curves,
      "A curves file of these wires with the ranges that were found, to edit and give to --curves");
  command->add_option("--reconstruct", arguments->reconstruct,
                      "A folder for OBJ files: each shape as its wires alone rebuild it");
  command->add_option("--report", arguments->report,
                      "A folder for a page with pictures (report.html, report.json)");
  command->add_flag("--compress", arguments->save.compress, "Write EXT_meshopt_compression");
  command->footer("Example: mien wires ict.glb --curves curves.json -o ict_wires.glb --report report");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
