#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "mien/report/detail/html.h"
#include "mien/report/detail/page.h"

namespace mien::detail {
namespace {

std::string fact(const std::string& name, const std::string& value) {
  return "<div><dt>" + name + "</dt><dd>" + value + "</dd></div>\n";
}

std::string facts(const PageInput& page) {
  const Character& character = page.input.result.character;
  const TransferReport& report = page.input.result.report;
  std::size_t vertices = 0, source_vertices = 0;
  for (const Part& part : character.parts) vertices += part.mesh.vertex_count();
  for (const Part& part : page.input.source.parts) source_vertices += part.mesh.vertex_count();
  double seconds = 0;
  for (const StepTime& step : report.steps) seconds += step.seconds;
  std::string text = "<dl class=\"facts\">\n";
  text += fact("method", page.input.options.method == TransferMethod::thesis ? "thesis" : "register");
  text += fact("correspondence", std::string(name_of(report.correspondence)));
  text += fact("landmarks", std::to_string(report.pairs.names.size()));
  text += fact("vertices, source / target", fmt::format("{} / {}", source_vertices, vertices));
  text += fact("shapes", std::to_string(character.shapes.size()));
  text += fact("joints", std::to_string(character.skins.empty() ? 0 : character.skins[0].joints.size()));
  text += fact("clips", std::to_string(character.clips.size()));
  text += fact("scale, source to target", fmt::format("{:.4g}", report.similarity.scale));
  text += fact("guide to landmarks, mean", fmt::format("{:.2f} %", 100 * page.data.landmark_mean));
  text += fact("guide to target, median", fmt::format("{:.2f} %", 100 * page.data.distance_median));
  text += fact("vertices filled in", fmt::format("{:.1f} %", 100 * page.data.filled_share));
  text += fact("seconds", fmt::format("{:.2f}", seconds));
  return text +
         "</dl>\n<p class=\"soft\">Percentages of length are of the face's size: the diagonal of its "
         "landmarks' box.</p>\n";
}

std::string decision(const DeltaDecision& deltas) {
  std::string text =
      "<h3>How displacements are carried</h3>\n<p><b>" + escaped(name_of(deltas.model)) + "</b>";
  if (deltas.model == DeltaModel::automatic)
    text += fmt::format(", {:.0f} % by the warp", 100 * deltas.warp_share);
  text += ": " + escaped(deltas.reason) + ".</p>\n";
  if (deltas.model != DeltaModel::automatic) return text;
  return text + fmt::format(
                    "<p class=\"soft\">{} shapes of the source close a gap; a local map misses these "
                    "contacts {:.2f} times as far as raw displacements do; the map stretches by {:.3f} (rms, "
                    "logarithm).</p>\n",
                    deltas.contact_shapes, deltas.contact_ratio, deltas.stretch);
}

/// "3 shapes (jawOpen, mouthClose, tongueOut)": those that `is` picks out, the first few by name; empty: none.
std::string shapes_that(const std::vector<ShapeRow>& shapes, bool (*is)(const ShapeRow&)) {
  std::string names;
  int count = 0;
  for (const ShapeRow& shape : shapes) {
    if (!is(shape)) continue;
    if (++count <= 6) names += (count > 1 ? ", " : "") + shape.name;
  }
  if (count == 0) return {};
  return fmt::format("{} shape{} ({}{})", count, count > 1 ? "s" : "", names, count > 6 ? ", ..." : "");
}

std::vector<TransferWarning> warnings_of(const PageInput& page) {
  std::vector<TransferWarning> all = page.input.result.report.warnings;
  if (!page.data.thesis_problem.empty())
    all.push_back({"the thesis's method cannot be compared with: " + page.data.thesis_problem,
                   "nothing, if this result looks right"});
  if (page.data.landmark_worst > 0.05)
    all.push_back({fmt::format("the guide misses landmark {} by {:.1f} % of the face",
                               page.data.worst_landmark, 100 * page.data.landmark_worst),
                   "look whether it is the same place on both faces"});
  const std::string folded = shapes_that(page.data.shapes, folds_more);
  if (!folded.empty())
    all.push_back({folded + ": many more triangles turn over than on the source",
                   "look at the pictures; more landmarks there, or a smaller --exaggerate"});
  const std::string stretched = shapes_that(page.data.shapes, stretches_more);
  if (!stretched.empty())
    all.push_back(
        {stretched + ": an edge is stretched much more than on the source",
         "look whether lips or lids are stuck together; landmarks on both sides of the gap part them"});
  return all;
}

std::string warnings(const PageInput& page) {
  const std::vector<TransferWarning> all = warnings_of(page);
  if (all.empty()) return "<p>No warnings.</p>\n";
  std::string text = "<ul class=\"warnings\">\n";
  for (const TransferWarning& warning : all)
    text += "<li>" + escaped(warning.what) + "<span>" + escaped(warning.remedy) + "</span></li>\n";
  return text + "</ul>\n";
}

/// Links to the sections that there are.
std::string navigation(const std::string& sections) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 8> names{
      {{"surfaces", "Surfaces"},
       {"maps", "Maps"},
       {"shapes", "Shapes"},
       {"baseline", "Baseline"},
       {"weights", "Skin weights"},
       {"clips", "Clips"},
       {"pieces", "Pieces"},
       {"seconds", "Seconds"}}};
  std::string text = "<nav>";
  for (const auto& [id, name] : names)
    if (sections.find(fmt::format("<h2 id=\"{}\"", id)) != std::string::npos)
      text += fmt::format("<a href=\"#{}\">{}</a>", id, name);
  return text + "</nav>\n";
}

}  // namespace

std::string overview_section(const PageInput& page, const std::string& sections) {
  std::string text =
      "<h1>" + escaped(page.input.source_name) + " on " + escaped(page.input.target_name) + "</h1>\n";
  text += "<p class=\"soft\">The rig of the first on the second, written to " +
          escaped(page.input.output_name) + ".</p>\n";
  text += navigation(sections);
  return text + warnings(page) + facts(page) + decision(page.input.result.report.deltas);
}

std::string pieces_section(const PageInput& page) {
  const auto& pieces = page.input.result.report.pieces;
  if (pieces.empty()) return {};
  std::string text =
      "<h2 id=\"pieces\">Pieces beside the skin</h2>\n<p>What is in or on the head without being its skin, "
      "and what each moves with.</p>\n";
  std::vector<std::vector<std::string>> rows;
  for (const PieceReport& piece : pieces) {
    std::vector<std::string> row{escaped(piece.piece), escaped(piece.kind), escaped(piece.way)};
    if (std::find(rows.begin(), rows.end(), row) == rows.end()) rows.push_back(std::move(row));
  }
  return text + "<div class=\"text\">" + table({"piece", "kind", "moves with"}, rows) + "</div>\n";
}

}  // namespace mien::detail
