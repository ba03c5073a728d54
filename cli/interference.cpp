#include "interference.h"

#include <fmt/format.h>

#include "mien/core/error.h"
#include "mien/io/file.h"
#include "mien/io/pins_file.h"
#include "mien/picture/matrix_plot.h"
#include "mien/pose/interference.h"

namespace mien::cli {

using nlohmann::json;

json describe_interference(const Character& character, const std::filesystem::path& picture) {
  if (!picture.empty() && picture.extension() != ".png")
    throw invalid_input(picture.string(), "is no picture that mien writes", "a name that ends in .png");
  const Interference found = interference(character);
  json result = {{"sliders", json::array()}, {"overlap", json::array()}, {"pairs", json::array()}};
  std::vector<std::string> names;
  for (const Slider& slider : character.sliders) names.push_back(slider.name);
  result["sliders"] = names;
  for (Eigen::Index r = 0; r < found.overlap.rows(); ++r) {
    result["overlap"].push_back(json::array());
    for (Eigen::Index c = 0; c < found.overlap.cols(); ++c)
      result["overlap"].back().push_back(found.overlap(r, c));
  }
  for (const InterferingPair& pair : found.pairs)
    result["pairs"].push_back({{"first", names[pair.first]},
                               {"second", names[pair.second]},
                               {"overlap", pair.overlap},
                               {"alignment", pair.alignment},
                               {"part", character.parts[pair.where.part].name},
                               {"vertex", pair.where.vertex}});
  if (picture.empty()) return result;
  MatrixPlotOptions options;
  options.title = "Sliders that move the same vertices: 0 none, 1 all in the same proportions";
  options.cell = names.size() > 120 ? 4 : 12;
  const auto png = encode_png(matrix_plot(names, found.overlap, options));
  write_file_atomically(picture, png);
  result["picture"] = picture.string();
  return result;
}

std::string interference_text(const json& interference) {
  std::string text =
      fmt::format("  {:<28} {:<28} {:>8} {:>10}  most at\n", "slider", "and slider", "overlap", "alignment");
  std::size_t shown = 0;
  for (const json& pair : interference["pairs"]) {
    if (++shown > 30) break;
    text += fmt::format("  {:<28} {:<28} {:>8.3f} {:>10.3f}  {}, vertex {}\n",
                        pair["first"].get<std::string>(), pair["second"].get<std::string>(),
                        pair["overlap"].get<double>(), pair["alignment"].get<double>(),
                        pair["part"].get<std::string>(), pair["vertex"].get<int>());
  }
  const std::size_t count = interference["pairs"].size();
  text += fmt::format("  {} pairs overlap by more than 0.1{}\n", count,
                      count > 30 ? "; --json lists them all" : "");
  return text;
}

json describe_rule_breaks(const Character& character, const std::filesystem::path& file,
                          const std::string& clip) {
  const std::vector<RegionRule> rules = read_region_rules(file, character);
  const Clip* chosen = nullptr;
  for (const Clip& other : character.clips)
    if (!chosen && (clip.empty() || other.name == clip)) chosen = &other;
  if (!chosen)
    throw invalid_input(clip.empty() ? "rules" : "clip " + clip,
                        clip.empty() ? "need a clip" : "does not exist",
                        clip.empty() ? "a character with one" : "mien inspect lists the clips");
  json breaks = json::array();
  for (const RuleBreak& found : check_region_rules(character, *chosen, rules)) {
    const SurfacePoint& at = rules[found.rule].region[found.point];
    json entry = {{"rule", rules[found.rule].name}, {"seconds", found.seconds}, {"by", found.by}};
    if (found.slider >= 0) entry["slider"] = character.sliders[found.slider].name;
    entry[at.face < 0 ? "vertex" : "face"] = at.face < 0 ? at.vertex : at.face;
    breaks.push_back(entry);
  }
  return breaks;
}

std::string rule_breaks_text(const json& breaks) {
  std::string text;
  for (const json& found : breaks)
    text +=
        found.contains("slider")
            ? fmt::format("  rule       {}: {} moves it by {:.4g} at {:.3f} s\n",
                          found["rule"].get<std::string>(), found["slider"].get<std::string>(),
                          found["by"].get<double>(), found["seconds"].get<double>())
            : fmt::format("  rule       {}: moves by {:.4g} at {:.3f} s\n", found["rule"].get<std::string>(),
                          found["by"].get<double>(), found["seconds"].get<double>());
  return breaks.empty() ? "  rules      none broken\n" : text;
}

}  // namespace mien::cli
