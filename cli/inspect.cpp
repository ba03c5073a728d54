#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "command.h"
#include "interference.h"
#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/io/load.h"
#include "objects.h"
#include "rigging.h"

namespace mien::cli {
namespace {

using nlohmann::json;

/// The most influences that one vertex of the part has.
int most_influences(const SkinWeights& skin) {
  int most = 0;
  for (std::size_t v = 0; v + 1 < skin.offsets.size(); ++v)
    most = std::max(most, skin.offsets[v + 1] - skin.offsets[v]);
  return most;
}

json describe_part(const Character& character, int index) {
  const Part& part = character.parts[index];
  std::size_t triangles = 0, quads = 0;
  for (std::size_t f = 0; f < part.mesh.faces.size(); ++f) {
    triangles += part.mesh.faces[f].size() == 3;
    quads += part.mesh.faces[f].size() == 4;
  }
  std::size_t shapes = 0;
  for (const Shape& shape : character.shapes)
    shapes += std::any_of(shape.parts.begin(), shape.parts.end(),
                          [&](const PartDelta& d) { return d.part == index; });
  json attributes = json::array();
  for (const VertexAttribute& attribute : part.mesh.attributes) attributes.push_back(attribute.name);
  std::size_t points = 0, lines = 0;
  for (const LooseElements& loose : part.mesh.loose)
    (loose.lines ? lines : points) += loose.vertices.size() / (loose.lines ? 2 : 1);
  const Box box = bounding_box(part.mesh.positions);
  return {{"name", part.name},
          {"shown", part.shown},
          {"attributes", std::move(attributes)},
          {"points", points},
          {"lines", lines},
          {"vertices", part.mesh.vertex_count()},
          {"faces", part.mesh.faces.size()},
          {"triangles", triangles},
          {"quads", quads},
          {"ngons", part.mesh.faces.size() - triangles - quads},
          {"uv_sets", part.mesh.uvs.size()},
          {"groups", part.mesh.groups.size()},
          {"shapes", shapes},
          {"skinned", part.skin >= 0},
          {"influences", most_influences(part.skin_weights)},
          {"box", {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}}}};
}

json describe_clip(const Clip& clip) {
  std::size_t keys = 0;
  for (const Channel& channel : clip.channels) keys += channel.times.size();
  return {
      {"name", clip.name}, {"seconds", clip.duration()}, {"channels", clip.channels.size()}, {"keys", keys}};
}

/// Names of things that may be out of range: inspect also shows what is broken.
template <typename Elements>
std::string name_at(const Elements& elements, int index) {
  return index >= 0 && index < static_cast<int>(elements.size()) ? elements[index].name
                                                                 : fmt::format("number {}", index);
}

json describe_slider(const Character& character, const Slider& slider) {
  json stops = json::array();
  for (const SliderStop& stop : slider.stops)
    stops.push_back({{"at", stop.at}, {"shape", name_at(character.shapes, stop.shape)}});
  return {{"name", slider.name},
          {"minimum", slider.minimum},
          {"maximum", slider.maximum},
          {"rest", slider.rest},
          {"stops", std::move(stops)}};
}

json describe_corrective(const Character& character, const Corrective& corrective) {
  constexpr const char* rules[] = {"product", "smallest", "smooth"};
  json inputs = json::array();
  for (const CorrectiveInput& input : corrective.inputs)
    inputs.push_back({{"slider", name_at(character.sliders, input.slider)}, {"at", input.at}});
  return {{"shape", name_at(character.shapes, corrective.shape)},
          {"rule", rules[static_cast<int>(corrective.rule)]},
          {"inputs", std::move(inputs)}};
}

json describe(const std::string& file, const Character& character) {
  json result = {{"file", file},
                 {"parts", json::array()},
                 {"shapes", json::array()},
                 {"sliders", json::array()},
                 {"correctives", json::array()},
                 {"expressions", json::array()},
                 {"joints", json::array()},
                 {"clips", json::array()},
                 {"materials", json::array()},
                 {"problems", json::array()}};
  std::size_t vertices = 0, faces = 0;
  int influences = 0;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    result["parts"].push_back(describe_part(character, static_cast<int>(p)));
    vertices += character.parts[p].mesh.vertex_count();
    faces += character.parts[p].mesh.faces.size();
    influences = std::max(influences, most_influences(character.parts[p].skin_weights));
  }
  for (const Shape& shape : character.shapes) result["shapes"].push_back(shape.name);
  for (const Slider& slider : character.sliders)
    result["sliders"].push_back(describe_slider(character, slider));
  for (const Corrective& corrective : character.correctives)
    result["correctives"].push_back(describe_corrective(character, corrective));
  for (const Expression& expression : character.expressions)
    result["expressions"].push_back({{"name", expression.name}, {"sliders", expression.values.size()}});
  std::set<int> joints;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      if (joint >= 0 && joint < static_cast<int>(character.nodes.size()) && joints.insert(joint).second)
        result["joints"].push_back(character.nodes[joint].name);
  result["objects"] = describe_objects(character);
  result["constraints"] = describe_constraints(character);
  result["controls"] = describe_controls(character);
  for (const Clip& clip : character.clips) result["clips"].push_back(describe_clip(clip));
  for (const Material& material : character.appearance.materials)
    result["materials"].push_back(material.name);
  for (const Problem& problem : validate(character))
    result["problems"].push_back(
        {{"place", problem.place}, {"text", problem.text}, {"remedy", problem.remedy}});
  result["vertices"] = vertices;
  result["faces"] = faces;
  result["influences"] = influences;
  result["nodes"] = character.nodes.size();
  result["landmarks"] = character.landmarks.size();
  result["curves"] = character.curves.size();
  result["images"] = character.appearance.images.size();
  return result;
}

std::string joined(const json& names) {
  std::string text;
  for (const json& name : names) {
    if (!text.empty()) text += ", ";
    text += name.get<std::string>();
  }
  return text;
}

/// What a part carries that mien does nothing with.
std::string carried_words(const json& part) {
  std::string text;
  if (!part["shown"].get<bool>()) text += "  not shown by any node";
  if (part["points"].get<int>() > 0) text += fmt::format("  {} points", part["points"].get<int>());
  if (part["lines"].get<int>() > 0) text += fmt::format("  {} lines", part["lines"].get<int>());
  if (!part["attributes"].empty()) text += "  " + joined(part["attributes"]);
  return text;
}

/// A table's cell: names of any length, numbers to the right.
std::string part_rows(const json& parts) {
  std::size_t width = 4;
  for (const json& part : parts) width = std::max(width, part["name"].get_ref<const std::string&>().size());
  std::string text = fmt::format("  {:<{}} {:>9} {:>9} {:>8} {:>4} {:>7} {:>11}\n", "part", width, "vertices",
                                 "faces", "n-gons", "UVs", "shapes", "influences");
  for (const json& part : parts)
    text += fmt::format("  {:<{}} {:>9} {:>9} {:>8} {:>4} {:>7} {:>11}{}\n", part["name"].get<std::string>(),
                        width, part["vertices"].get<int>(), part["faces"].get<int>(),
                        part["quads"].get<int>() + part["ngons"].get<int>(), part["uv_sets"].get<int>(),
                        part["shapes"].get<int>(), part["influences"].get<int>(), carried_words(part));
  return text;
}

/// The sliders that are more than a shape's own weight, in words; correctives and expressions.
std::string slider_rows(const json& result) {
  std::string text = fmt::format("  sliders    {}\n", result["sliders"].size());
  for (const json& slider : result["sliders"]) {
    const json& stops = slider["stops"];
    const double low = slider["minimum"], high = slider["maximum"];
    if (stops.size() == 1 && stops[0]["shape"] == slider["name"] && stops[0]["at"] == 1 && low == 0 &&
        high == 1)
      continue;
    std::string shown;
    for (const json& stop : stops)
      shown += fmt::format("{}{} at {:g}", shown.empty() ? "" : ", ", stop["shape"].get<std::string>(),
                           stop["at"].get<double>());
    text += fmt::format("    {} [{:g}, {:g}]: {}\n", slider["name"].get<std::string>(), low, high,
                        shown.empty() ? "no shape" : shown);
  }
  for (const json& corrective : result["correctives"]) {
    std::string inputs;
    for (const json& input : corrective["inputs"])
      inputs += (inputs.empty() ? "" : ", ") + input["slider"].get<std::string>();
    text += fmt::format("  corrective {}: {} of {}\n", corrective["shape"].get<std::string>(),
                        corrective["rule"].get<std::string>(), inputs);
  }
  for (const json& expression : result["expressions"])
    text += fmt::format("  expression {}: {} sliders\n", expression["name"].get<std::string>(),
                        expression["sliders"].get<int>());
  return text;
}

std::string as_text(const json& result) {
  std::string text = result["file"].get<std::string>() + "\n" + part_rows(result["parts"]);
  text += fmt::format("  shapes     {}{}\n", result["shapes"].size(),
                      result["shapes"].empty() ? "" : ": " + joined(result["shapes"]));
  text += slider_rows(result);
  text += fmt::format("  joints     {}{}\n", result["joints"].size(),
                      result["joints"].empty() ? "" : ": " + joined(result["joints"]));
  text += object_rows(result["objects"]);
  text += constraint_rows(result["constraints"]) + control_rows(result["controls"]);
  for (const json& clip : result["clips"])
    text += fmt::format("  clip       {}: {:.3f} s, {} channels, {} keys\n", clip["name"].get<std::string>(),
                        clip["seconds"].get<double>(), clip["channels"].get<int>(), clip["keys"].get<int>());
  text += fmt::format("  landmarks  {}, curves {}\n", result["landmarks"].get<int>(),
                      result["curves"].get<int>());
  text += fmt::format("  materials  {}{}\n", result["materials"].size(),
                      result["materials"].empty() ? "" : ": " + joined(result["materials"]));
  for (const json& problem : result["problems"])
    text += fmt::format("  problem    {}: {}; {}\n", problem["place"].get<std::string>(),
                        problem["text"].get<std::string>(), problem["remedy"].get<std::string>());
  if (result["problems"].empty()) text += "  problems   none\n";
  return text;
}

}  // namespace

void add_inspect(CLI::App& app, Common& common) {
  struct Arguments {
    std::string file, picture, rules, clip;
    bool interference = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("inspect", "Say what is in a file, and what is wrong with it");
  command->add_option("FILE", arguments->file, "A .glb, .gltf or .obj")->required();
  command->add_flag("--interference", arguments->interference,
                    "Which sliders move the same vertices, and where");
  command->add_option("--picture", arguments->picture, "The interference as a matrix (.png)")
      ->needs("--interference");
  command->add_option("--rules", arguments->rules,
                      "Check a clip against rules: which sliders may move a region (.json)");
  command->add_option("--clip", arguments->clip, "The clip to check (default: the first)")->needs("--rules");
  command->footer(
      "Example: mien inspect head.glb --json\n"
      "         mien inspect head.glb --interference --picture matrix.png\n"
      "RULES: {\"rules\": [{\"name\": \"lids\", \"region\": [{\"vertex\": 17}], \"radius\": 0.01,\n"
      "        \"sliders\": [\"eyeBlinkLeft\"], \"at_most\": 0.02}]}");
  command->callback([arguments, &common] {
    LoadOptions options;
    options.validate = arguments->interference || !arguments->rules.empty();
    const Character character = load(arguments->file, options);
    json result = describe(arguments->file, character);
    std::string text = as_text(result);
    try {
      if (arguments->interference) {
        result["interference"] = describe_interference(character, arguments->picture);
        text += interference_text(result["interference"]);
      }
      if (!arguments->rules.empty()) {
        result["rule_breaks"] = describe_rule_breaks(character, arguments->rules, arguments->clip);
        text += rule_breaks_text(result["rule_breaks"]);
      }
    } catch (const Error& error) {
      throw error.in_file(arguments->file);
    }
    print_result(common, text, result);
  });
}

}  // namespace mien::cli
