#include "mien/io/vrm.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "mien/core/error.h"
#include "mien/io/load.h"
#include "mien/naming/plan_vrm.h"

namespace mien::cli {
namespace {

struct Request {
  std::string character, meta, name, license, output;
  std::vector<std::string> authors;
};

VrmMeta meta_of(const Request& request, const Character& character) {
  VrmMeta meta = request.meta.empty() ? VrmMeta{} : read_vrm_meta(request.meta);
  if (!request.name.empty()) meta.name = request.name;
  if (meta.name.empty())
    meta.name =
        character.name.empty() ? std::filesystem::path(request.character).stem().string() : character.name;
  if (!request.authors.empty()) meta.authors = request.authors;
  if (!request.license.empty()) meta.license_url = request.license;
  if (meta.authors.empty())
    throw invalid_input("VRM meta", "has no author", "--author NAME, or \"authors\" in --meta")
        .in_file(request.meta.empty() ? request.character : request.meta);
  return meta;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void run(const Request& request, const Common& common) {
  const Character character = load(request.character);
  const VrmMeta meta = meta_of(request, character);
  VrmPlan plan;
  try {
    plan = plan_vrm(character, meta);
  } catch (const Error& error) {
    throw error.in_file(request.character);
  }
  write_vrm(plan.character, plan.avatar, request.output);
  std::vector<std::string> presets, custom;
  for (const VrmExpression& expression : plan.avatar.expressions)
    (expression.is_preset ? presets : custom).push_back(expression.name);
  nlohmann::json bones = nlohmann::json::object();
  for (const VrmBone& bone : plan.avatar.bones)
    bones[bone.name] = plan.character.nodes[static_cast<std::size_t>(bone.node)].name;
  std::string text = fmt::format("{}: {} preset expressions, {} custom ones, {} bones\n", request.output,
                                 presets.size(), custom.size(), plan.avatar.bones.size());
  if (!plan.missing_presets.empty())
    text += fmt::format("  no shapes for {}\n", joined(plan.missing_presets));
  if (!plan.made_bones.empty())
    text += fmt::format("  bones made because VRM requires them: {}\n", joined(plan.made_bones));
  print_result(common, text,
               {{"output", request.output},
                {"presets", presets},
                {"custom", custom},
                {"missing_presets", plan.missing_presets},
                {"bones", bones},
                {"made_bones", plan.made_bones}});
}

}  // namespace

void add_vrm(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("vrm", "Write a VRM 1.0 avatar: bones and expressions by names");
  auto request = std::make_shared<Request>();
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  command->add_option("-o,--output", request->output, "The avatar (.vrm)")
      ->required()
      ->check([](const std::string& path) {
        return std::filesystem::path(path).extension() == ".vrm" ? "" : "name a .vrm";
      });
  command->add_option("--meta", request->meta, "Who made it, under which licence (.json)");
  command->add_option("--name", request->name,
                      "The avatar's name (default: the character's, else the file's)");
  command->add_option("--author", request->authors, "Who made it; may be given again");
  command->add_option("--license", request->license, "Licence URL (default: https://vrm.dev/licenses/1.0/)");
  command->footer(
      "Example: mien vrm head.glb --author \"Ada L.\" -o head.vrm\n"
      "META: {\"name\": \"Ada\", \"authors\": [\"Ada L.\"], \"licenseUrl\": "
      "\"https://vrm.dev/licenses/1.0/\", \"version\": \"1.2\"}");
  command->callback([request, &common] { run(*request, common); });
}

}  // namespace mien::cli
