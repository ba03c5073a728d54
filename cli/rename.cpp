#include "mien/naming/rename.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "mien/core/error.h"
#include "mien/io/load.h"
#include "mien/io/name_map_file.h"

namespace mien::cli {
namespace {

struct Request {
  std::string character, convention, map, output;
};

std::string known_conventions() {
  std::string names;
  for (int c = 0; c < convention_count; ++c)
    names += (c == 0 ? "" : ", ") + std::string(name_of(static_cast<Convention>(c)));
  return names;
}

nlohmann::json as_json(const NamePairs& pairs) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [from, to] : pairs) json[from] = to;
  return json;
}

void run_rename(const Request& request, const Common& common) {
  const Character character = load(request.character);
  NamePairs pairs;
  if (!request.map.empty())
    for (const MappedName& name : read_name_map(request.map)) pairs.emplace_back(name.from, name.to);
  else
    pairs = names_for(character, convention_of_name(request.convention));
  Character renamed;
  try {
    renamed = rename(character, pairs);
  } catch (const Error& error) {
    throw error.in_file(request.map.empty() ? request.character : request.map);
  }
  save(renamed, request.output);
  print_result(
      common,
      fmt::format("{}: {} of {} sliders renamed\n", request.output, pairs.size(), character.sliders.size()),
      {{"output", request.output}, {"renamed", as_json(pairs)}});
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
  print_result(common, text,
               {{"convention", name_of(found.convention)}, {"known", found.known}, {"map", as_json(pairs)}});
}

}  // namespace

void add_rename(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("rename", "Call sliders and shapes as another convention does");
  auto request = std::make_shared<Request>();
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  auto* convention = command->add_option("--to", request->convention, "One of: " + known_conventions());
  auto* map = command->add_option("--map", request->map, "A file of names: {\"map\": {FROM: TO}}");
  convention->excludes(map);
  command->add_option("-o,--output", request->output, "The renamed character (.glb, .gltf)")->required();
  command->footer("Example: mien rename ict.glb --to arkit -o arkit.glb");
  command->callback([request, &common] {
    if (request->convention.empty() && request->map.empty()) throw CLI::RequiredError("--to or --map");
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
