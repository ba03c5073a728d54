#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "command.h"
#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/io/constraints_file.h"
#include "mien/io/load.h"

namespace mien::cli {
namespace {

struct Request {
  std::string character, add, output;
  std::vector<std::string> remove;
};

void remove_named(Character& character, const std::string& name) {
  const auto found = std::find_if(character.constraints.begin(), character.constraints.end(),
                                  [&](const Constraint& constraint) { return constraint.name == name; });
  if (found == character.constraints.end())
    throw invalid_input("--remove " + name, "names no constraint", "one that `mien inspect` lists");
  character.constraints.erase(found);
}

void run(const Request& request, const Common& common) {
  Character character = load(request.character);
  try {
    for (const std::string& name : request.remove) remove_named(character, name);
  } catch (const Error& error) {
    throw error.in_file(request.character);
  }
  std::size_t added = 0;
  if (!request.add.empty()) {
    const ConstraintSet set = read_constraint_set(request.add, character);
    character.nodes.insert(character.nodes.end(), set.nodes.begin(), set.nodes.end());
    character.constraints.insert(character.constraints.end(), set.constraints.begin(), set.constraints.end());
    added = set.constraints.size();
    const std::vector<Problem> problems = constraint_problems(character);
    if (!problems.empty()) throw problems.front().error().in_file(request.add);
  }
  save(character, request.output);
  nlohmann::json names = nlohmann::json::array();
  for (const Constraint& constraint : character.constraints) names.push_back(constraint.name);
  print_result(common,
               fmt::format("{}: {} constraints, {} added, {} removed\n", request.output,
                           character.constraints.size(), added, request.remove.size()),
               {{"output", request.output}, {"constraints", names}, {"added", added}});
}

}  // namespace

void add_constrain(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("constrain", "Give nodes limits, and others to follow or look at");
  auto request = std::make_shared<Request>();
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  auto* add =
      command->add_option("--add", request->add, "Constraints by names (.json); applied after those there");
  auto* remove = command->add_option("--remove", request->remove, "Take away the constraint of this name");
  command->add_option("-o,--output", request->output, "The constrained character (.glb, .gltf)")->required();
  command->footer(
      "Example: mien constrain head.glb --add looks.json -o head2.glb\n"
      "CONSTRAINTS: {\"nodes\": [{\"name\": \"lookAt\", \"parent\": \"head\", \"at\": [0, 1.6, 1]}],\n"
      "  \"constraints\": [{\"name\": \"left eye\", \"kind\": \"aim\", \"node\": \"eyeL\", \"sources\": "
      "[{\"node\": \"lookAt\"}]},\n"
      "    {\"name\": \"jaw range\", \"kind\": \"limit\", \"node\": \"jaw\", \"rotation\": {\"x\": [0, "
      "0.5]}}]}\n"
      "Kinds: limit, parent, point, orient, scale, aim; angles in radians from rest. docs/io.md has all "
      "members.");
  command->callback([request, add, remove, &common] {
    if (add->count() + remove->count() == 0) throw CLI::RequiredError("--add or --remove");
    run(*request, common);
  });
}

}  // namespace mien::cli
