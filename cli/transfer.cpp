#include "mien/transfer/transfer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include "command.h"
#include "find_landmarks.h"
#include "load_face.h"
#include "mien/core/error.h"
#include "mien/io/file.h"
#include "mien/io/load.h"
#include "mien/report/report.h"
#include "mien/transfer/bake_textures.h"

namespace mien::cli {
namespace {

struct Request {
  std::string source, target, output, source_landmarks, target_landmarks, report;
  TransferOptions options;
  std::vector<std::string> exaggerate;
  bool compress = false;
  int bake = 0;  // pixels, 0: no images
};

/// "PCT" for all shapes, "NAME=PCT" for one.
void read_exaggeration(const std::vector<std::string>& texts, TransferOptions& options) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
    std::size_t used = 0;
    double percent = 0;
    try {
      percent = std::stod(number, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != number.size())
      throw invalid_input("--exaggerate " + text, "is not a percentage",
                          "PCT or NAME=PCT, such as 150 or jawOpen=120");
    if (equals == std::string::npos)
      options.exaggeration = percent / 100;
    else
      options.shape_exaggeration[text.substr(0, equals)] = percent / 100;
  }
}

nlohmann::json as_json(const TransferReport& report, const std::string& output) {
  nlohmann::json steps = nlohmann::json::object(), pieces = nlohmann::json::array();
  for (const StepTime& step : report.steps) steps[step.step] = step.seconds;
  for (const PieceReport& piece : report.pieces)
    pieces.push_back({{"piece", piece.piece}, {"kind", piece.kind}, {"moves_with", piece.way}});
  nlohmann::json warnings = nlohmann::json::array();
  for (const TransferWarning& warning : report.warnings)
    warnings.push_back({{"what", warning.what}, {"remedy", warning.remedy}});
  return {{"output", output},
          {"landmarks", report.pairs.names.size()},
          {"scale", report.similarity.scale},
          {"correspondence", name_of(report.correspondence)},
          {"deltas",
           {{"model", name_of(report.deltas.model)},
            {"warp_share", report.deltas.warp_share},
            {"contact_ratio", report.deltas.contact_ratio},
            {"stretch", report.deltas.stretch},
            {"contact_shapes", report.deltas.contact_shapes},
            {"reason", report.deltas.reason}}},
          {"pieces", pieces},
          {"seconds", steps},
          {"warnings", warnings}};
}

std::string as_text(const TransferResult& result, const std::string& output) {
  const TransferReport& report = result.report;
  double seconds = 0;
  for (const StepTime& step : report.steps) seconds += step.seconds;
  std::string text = fmt::format("{}: {} shapes, {} joints, {} clips on {} parts by {} landmarks, {:.2f} s\n",
                                 output, result.character.shapes.size(),
                                 result.character.skins.empty() ? 0 : result.character.skins[0].joints.size(),
                                 result.character.clips.size(), result.character.parts.size(),
                                 report.pairs.names.size(), seconds);
  if (report.correspondence == Correspondence::shared_uvs)
    text += "correspondence: uvs: source and target share a UV layout\n";
  text +=
      fmt::format("deltas: {} ({:.0f} % warp; contacts {:.2f} over {} shapes, stretch {:.3f}): {}\n",
                  name_of(report.deltas.model), 100 * report.deltas.warp_share, report.deltas.contact_ratio,
                  report.deltas.contact_shapes, report.deltas.stretch, report.deltas.reason);
  std::map<std::string, int> pieces;
  for (const PieceReport& piece : report.pieces)
    ++pieces[fmt::format("{} ({}): moves with {}", piece.piece, piece.kind, piece.way)];
  for (const auto& [piece, count] : pieces)
    text += count == 1 ? fmt::format("piece {}\n", piece) : fmt::format("{} pieces of {}\n", count, piece);
  for (const TransferWarning& warning : report.warnings)
    text += fmt::format("warning: {}; {}\n", warning.what, warning.remedy);
  return text;
}

/// Bakes the source's images and says what came of it.
void bake(const Request& request, const Character& source, TransferResult& result, std::string& text,
          nlohmann::json& json) {
  BakeOptions options;
  options.size = request.bake;
  options.padding = std::max(4, request.bake / 64);
  BakeResult baked = bake_textures(source, result.report.guide, result.character, options);
  result.character = std::move(baked.character);
  for (const BakedImage& image : baked.images) {
    text +=
        fmt::format("baked {} of material {} onto {}: charts cover {:.0f} %\n", fmt::join(image.slots, ", "),
                    image.material, fmt::join(image.parts, ", "), 100 * image.covered);
    json["baked"].push_back({{"material", image.material},
                             {"parts", image.parts},
                             {"slots", image.slots},
                             {"covered", image.covered},
                             {"overlap", image.overlap},
                             {"doubtful", image.doubtful}});
  }
  for (const TransferWarning& warning : baked.warnings) {
    text += fmt::format("warning: {}; {}\n", warning.what, warning.remedy);
    json["warnings"].push_back({{"what", warning.what}, {"remedy", warning.remedy}});
  }
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw io_error("", "the report's folder cannot be made: " + failure.message()).in_file(folder.string());
}

void run(Request& request, const Common& common) {
  read_exaggeration(request.exaggerate, request.options);
  Character source = load_face(request.source, request.source_landmarks);
  Character target = load_face(request.target, request.target_landmarks);
  const std::filesystem::path folder = request.report;
  if (!folder.empty()) make_folder(folder);
  request.options.progress = progress_bar(common);
  const std::vector<FoundSide> found =
      find_missing({request.source, source}, {request.target, target}, request.options);
  TransferResult result = transfer(source, target, request.options);
  std::optional<Report> report;
  if (!folder.empty())
    report = make_report({source, target, result, request.options, file_name(request.source),
                          file_name(request.target), file_name(request.output), request.options.progress});
  std::string text = as_text(result, request.output);
  nlohmann::json json = as_json(result.report, request.output);
  if (request.bake > 0) bake(request, source, result, text, json);
  save(result.character, request.output, {request.compress});
  if (report) {
    write_file_atomically(folder / "report.html", report->html);
    write_file_atomically(folder / "report.json", report->json);
    json["report"] = (folder / "report.html").string();
    text += fmt::format("report: {}\n", json["report"].get<std::string>());
  }
  for (const FoundSide& side : found) {
    json["found_landmarks"][side.file] = json_of(side.found);
    text += fmt::format("landmarks of {} found, {}", side.file, text_of(side.found));
  }
  print_result(common, text, json);
}

}  // namespace

void add_transfer(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("transfer", "Put the rig of SOURCE on TARGET");
  auto request = std::make_shared<Request>();
  TransferOptions& options = request->options;
  command->add_option("source", request->source, "A character: shapes, joints or both (.glb, .gltf)")
      ->required();
  command
      ->add_option("target", request->target,
                   "A mesh or a character, whose rig is replaced (.obj, .glb, .gltf)")
      ->required();
  command->add_option("-o,--output", request->output, "The target with the source's rig (.glb, .gltf)")
      ->required();
  command->add_option("--source-landmarks", request->source_landmarks,
                      "Landmark file of the source (default: those inside the file, else found)");
  command->add_option("--target-landmarks", request->target_landmarks,
                      "Landmark file of the target (default: those inside the file, else found)");
  const std::map<std::string, TransferMethod> methods{{"register", TransferMethod::registration},
                                                      {"thesis", TransferMethod::thesis}};
  command->add_option("--method", options.method, "register: no folds, no glued lips; thesis: the baseline")
      ->transform(CLI::CheckedTransformer(methods).description(""))
      ->type_name("NAME")
      ->default_str("register");
  std::map<std::string, Correspondence> correspondences;
  for (const Correspondence c :
       {Correspondence::automatic, Correspondence::shared_uvs, Correspondence::surfaces})
    correspondences[std::string(name_of(c))] = c;
  command
      ->add_option("--correspondence", options.correspondence,
                   "What says which place is which: uvs (a UV layout that both share), surfaces "
                   "(registration) or auto: "
                   "uvs where they are shared")
      ->transform(CLI::CheckedTransformer(correspondences).description(""))
      ->type_name("NAME")
      ->default_str("auto");
  std::map<std::string, DeltaModel> models;
  for (const DeltaModel model : {DeltaModel::automatic, DeltaModel::local, DeltaModel::raw, DeltaModel::copy,
                                 DeltaModel::warp, DeltaModel::thesis})
    models[std::string(name_of(model))] = model;
  command
      ->add_option("--deltas", options.deltas,
                   "How displacements are carried: auto, local, raw, copy, warp or thesis")
      ->transform(CLI::CheckedTransformer(models).description(""))
      ->type_name("NAME")
      ->default_str("auto");
  command->add_option("--exaggerate", request->exaggerate,
                      "PCT for all shapes or NAME=PCT for one, in percent; repeatable (default: 100)");
  command
      ->add_option("--max-influences", options.max_influences, "Most joints a vertex; 0: as many as needed")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--replace-uvs", options.replace_uvs,
                    "Take the source's UVs even where the target has its own");
  command
      ->add_flag("--bake{1024}", request->bake,
                 "Carry the source's images into the target's own UVs; --bake=SIZE: pixels a side")
      ->check(CLI::Range(16, 8192));
  command->add_flag("--compress", request->compress, "Write quantised, meshopt-compressed glTF");
  command->add_option("--report", request->report, "Folder for a page with pictures and the same as JSON");
  command->footer("Example:\n  mien transfer human.glb cartoon.glb -o cartoon-rigged.glb --report report");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
