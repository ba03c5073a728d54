#include "mien/naming/rename.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/io/load.h"
#include "mien/io/name_map_file.h"
#include "mien/naming/joint.h"

namespace mien::cli {
namespace {

struct Request {
  std::string character, convention, joints, map, output;
};

std::string known_conventions() {
  std::string names;
  for (int c = 0; c < convention_count; ++c)
    names += (c == 0 ? "" : ", ") + std::string(name_of(static_cast<Convention>(c)));
  return names;
}

std::string known_joint_conventions() {
  std::string names;
  for (int c = 0; c < joint_convention_count; ++c)
    names += (c == 0 ? "" : ", ") + std::string(name_of(static_cast<JointConvention>(c)));
  return names;
}

nlohmann::json as_json(const NamePairs& pairs) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [from, to] : pairs) json[from] = to;
  return json;
}

/// What the request calls otherwise: sliders and shapes, joints.
struct Renaming {
  NamePairs sliders, joints;
};

Renaming renaming_of(const Request& request, const Character& character) {
  Renaming renaming;
  if (!request.convention.empty())
    renaming.sliders = names_for(character, convention_of_name(request.convention));
  if (!request.joints.empty())
    renaming.joints = joint_names_for(character, joint_convention_of_name(request.joints));
  if (request.map.empty()) return renaming;
  for (const MappedName& name : read_name_map(request.map)) {
    const bool is_slider = find_slider(character, name.from) >= 0 || find_shape(character, name.from) >= 0;
    const bool is_joint = !is_slider && find_node(character, name.from) >= 0;
    (is_joint ? renaming.joints : renaming.sliders).emplace_back(name.from, name.to);
  }
  return renaming;
}

void run_rename(const Request& request, const Common& common) {
  const Character character = load(request.character);
  const Renaming renaming = renaming_of(request, character);
  Character renamed;
  try {
    renamed = rename_joints(rename(character, renaming.sliders), renaming.joints);
  } catch (const Error& error) {
    throw error.in_file(request.map.empty() ? request.character : request.map);
  }
  save(renamed, request.output);
  std::string text = fmt::format("{}: {} of {} sliders renamed\n", request.output, renaming.sliders.size(),
                                 character.sliders.size());
  if (!renaming.joints.empty()) text += fmt::format("  {} joints renamed\n", renaming.joints.size());
  print_result(common, text,
               {{"output", request.output},
                {"renamed", as_json(renaming.sliders)},
                {"joints", as_json(renaming.joints)}});
}

/// The joints' names beside a convention's; nothing for a character without joints.
std::string map_joints(const Character& character, nlohmann::json& result) {
  std::vector<std::string> own;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints) own.push_back(character.nodes[static_cast<std::size_t>(joint)].name);
  const FoundJointConvention found = find_joint_convention(own);
  const std::vector<int> joints = joints_of(own);
  result["joint_convention"] = name_of(found.convention);
  result["joints"] = nlohmann::json::object();
  std::string text;
  if (!own.empty())
    text = fmt::format("{} of {} joints are named as in {}\n", found.known, own.size(),
                       name_of(found.convention));
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (joints[k] < 0) continue;
    const std::string& name = joint_names()[static_cast<std::size_t>(joints[k])];
    result["joints"][own[k]] = name;
    text += fmt::format("  {} is {}\n", own[k], name);
  }
  return text;
}

void run_map(const Request& request, const Common& common) {
  const Character character = load(request.character);
  std::vector<std::string> own;
  for (const Slider& slider : character.sliders) own.push_back(slider.name);
  const FoundConvention found = find_convention(own);
  const NamePairs pairs = names_for(character, convention_of_name(request.convention));
  std::string text = fmt::format("{}: {} of {} sliders are named as in {}\n", request.character, found.known,
                                 own.size(), name_of(found.convention));
  for (const auto& [from, to] : pairs) text += fmt::format("  {} -> {}\n", from, to);
  text += fmt::format("{} sliders have no name of their own in {}\n", own.size() - pairs.size(),
                      request.convention);
  nlohmann::json result = {
      {"convention", name_of(found.convention)}, {"known", found.known}, {"map", as_json(pairs)}};
  text += map_joints(character, result);
  print_result(common, text, result);
}

}  // namespace

void add_rename(CLI::App& app, Common& common) {
  CLI::App* command =
      app.add_subcommand("rename", "Call sliders, shapes and joints as another convention does");
  auto request = std::make_shared<Request>();
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  auto* convention = command->add_option("--to", request->convention, "One of: " + known_conventions());
  auto* joints =
      command->add_option("--joints-to", request->joints, "Joints, one of: " + known_joint_conventions());
  auto* map = command->add_option("--map", request->map, "A file of names: {\"map\": {FROM: TO}}");
  convention->excludes(map);
  joints->excludes(map);
  command->add_option("-o,--output", request->output, "The renamed character (.glb, .gltf)")->required();
  command->footer(
      "Example: mien rename ict.glb --to arkit -o arkit.glb\n"
      "         mien rename head.glb --joints-to rigify -o head_rigify.glb");
  command->callback([request, &common] {
    if (request->convention.empty() && request->joints.empty() && request->map.empty())
      throw CLI::RequiredError("--to, --joints-to or --map");
    run_rename(*request, common);
  });
}

void add_map(CLI::App& app, Common& common) {
  CLI::App* command =
      app.add_subcommand("map", "Say which convention the sliders follow, and their names in another");
  auto request = std::make_shared<Request>();
  request->convention = "arkit";
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  command->add_option("--to", request->convention, "One of: " + known_conventions())->capture_default_str();
  command->footer("Example: mien map makehuman.glb --to arkit");
  command->callback([request, &common] { run_map(*request, common); });
}

}  // namespace mien::cli
