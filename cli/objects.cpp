#include "objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "command.h"
#include "mien/character/object_problems.h"
#include "mien/core/error.h"
#include "mien/deform/draw_object.h"
#include "mien/io/load.h"
#include "mien/io/objects_file.h"

namespace mien::cli {

using nlohmann::json;

namespace {

struct Arguments {
  std::string character, add, output;
  SaveOptions save;
};

/// Names of things that may be out of range: broken files are listed too.
template <typename Elements>
json name_at(const Elements& elements, int index) {
  if (index < 0) return nullptr;
  return index < static_cast<int>(elements.size()) ? elements[index].name : fmt::format("number {}", index);
}

/// What the form says besides its control points: "degree 3", "4 x 4 x 4".
std::string form_text(const InfluenceForm& form) {
  if (const auto* curve = std::get_if<NurbsCurve>(&form))
    return fmt::format("degree {}{}", curve->degree, curve->weights.empty() ? "" : ", rational");
  if (const auto* surface = std::get_if<NurbsSurface>(&form))
    return fmt::format("{} x {}, degree {} x {}{}", surface->count_u, surface->count_v, surface->degree_u,
                       surface->degree_v, surface->weights.empty() ? "" : ", rational");
  if (const auto* lattice = std::get_if<Lattice>(&form))
    return fmt::format("{} x {} x {}, degree {} x {} x {}", lattice->count[0], lattice->count[1],
                       lattice->count[2], lattice->degree[0], lattice->degree[1], lattice->degree[2]);
  if (const auto* mesh = std::get_if<WrapMesh>(&form)) return fmt::format("{} faces", mesh->faces.size());
  return {};
}

json describe_object(const Character& character, int index) {
  const InfluenceObject& object = character.objects[index];
  json bindings = json::array();
  for (const InfluenceBinding& binding : object.bindings) {
    const auto heaviest = std::max_element(binding.weights.begin(), binding.weights.end());
    bindings.push_back({{"part", name_at(character.parts, binding.part)},
                        {"vertices", binding.vertices.size()},
                        {"entries", binding.controls.size()},
                        {"largest_weight", heaviest == binding.weights.end() ? 0.f : *heaviest}});
  }
  json shapes = json::array();
  for (const Shape& shape : character.shapes)
    if (std::any_of(shape.objects.begin(), shape.objects.end(),
                    [&](const ObjectMove& move) { return move.object == index; }))
      shapes.push_back(shape.name);
  std::vector<int> used(object.skin_weights.joints);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  json joints = json::array();
  for (const int joint : used)
    if (object.skin >= 0 && object.skin < static_cast<int>(character.skins.size()) &&
        joint < static_cast<int>(character.skins[object.skin].joints.size()))
      joints.push_back(name_at(character.nodes, character.skins[object.skin].joints[joint]));
  return {{"name", object.name},
          {"kind", name_of(object.form)},
          {"form", form_text(object.form)},
          {"controls", object.controls.rows()},
          {"carrier", name_at(character.nodes, object.carrier)},
          {"node", name_at(character.nodes, object.node)},
          {"joints", std::move(joints)},
          {"shapes", std::move(shapes)},
          {"bindings", std::move(bindings)}};
}

void run(const Arguments& arguments, const Common& common) {
  const auto start = std::chrono::steady_clock::now();
  Character character = load(arguments.character);
  if (!arguments.add.empty()) {
    const std::vector<ObjectSketch> sketches = read_objects(arguments.add, character);
    try {
      for (const ObjectSketch& sketch : sketches) character.objects.push_back(draw_object(character, sketch));
    } catch (const Error& error) {
      throw error.in_file(arguments.add);
    }
    save(character, arguments.output, arguments.save);
  }
  json result = {{"file", arguments.add.empty() ? arguments.character : arguments.output},
                 {"objects", describe_objects(character)}};
  std::string text = result["file"].get<std::string>() + "\n" + object_rows(result["objects"]);
  if (!arguments.add.empty()) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result["seconds"] = seconds;
    text += fmt::format("  {:.2f} s\n", seconds);
  }
  print_result(common, text, result);
}

}  // namespace

json describe_objects(const Character& character) {
  json objects = json::array();
  for (std::size_t o = 0; o < character.objects.size(); ++o)
    objects.push_back(describe_object(character, static_cast<int>(o)));
  return objects;
}

std::string object_rows(const json& objects) {
  std::string text = fmt::format("  objects    {}\n", objects.size());
  const auto words = [](const json& names) {
    std::string all;
    for (const json& name : names) all += (all.empty() ? "" : ", ") + name.get<std::string>();
    return all;
  };
  for (const json& object : objects) {
    text += fmt::format("    {}: {}", object["name"].get<std::string>(), object["kind"].get<std::string>());
    if (!object["form"].get<std::string>().empty()) text += " " + object["form"].get<std::string>();
    const int controls = object["controls"];
    if (controls > 1) text += fmt::format(", {} control points", controls);
    if (!object["carrier"].is_null()) text += fmt::format(", on {}", object["carrier"].get<std::string>());
    if (!object["node"].is_null()) text += fmt::format(", moved by {}", object["node"].get<std::string>());
    if (!object["joints"].empty()) text += ", joints " + words(object["joints"]);
    if (!object["shapes"].empty()) text += ", in shapes " + words(object["shapes"]);
    if (object["bindings"].empty()) text += "; reaches nothing";
    for (const json& binding : object["bindings"])
      text += fmt::format("; {} vertices of {}, weights up to {:.3g}", binding["vertices"].get<int>(),
                          binding["part"].is_null() ? "nothing" : binding["part"].get<std::string>(),
                          binding["largest_weight"].get<double>());
    text += "\n";
  }
  return text;
}

void add_objects(CLI::App& app, Common& common) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "objects", "List a character's influence objects, or add curves, surfaces, lattices, meshes, clusters");
  command->add_option("CHARACTER", arguments->character, "The character (.glb, .gltf)")->required();
  CLI::Option* add = command->add_option(
      "--add", arguments->add,
      "The objects to add: {\"objects\": {NAME: {\"kind\": \"curve\", \"points\": [POINT, ...], \"range\": "
      "0.02}}}; lengths in the character's unit");
  CLI::Option* output =
      command->add_option("-o,--output", arguments->output, "The character with them: .glb or .gltf");
  add->needs(output);
  output->needs(add);
  command->add_flag("--compress", arguments->save.compress, "Write EXT_meshopt_compression")->needs(add);
  command->footer("Example: mien objects head.glb --add lips.json -o head_lips.glb");
  command->callback([arguments, &common] { run(*arguments, common); });
}

}  // namespace mien::cli
