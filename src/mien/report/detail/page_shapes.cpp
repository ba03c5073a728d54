#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "mien/core/parallel.h"
#include "mien/report/detail/html.h"
#include "mien/report/detail/page.h"
#include "mien/report/detail/poses.h"

namespace mien::detail {
namespace {

constexpr int cell_width = 190, cell_height = 210, wide_width = 320, wide_height = 350;
constexpr std::size_t telling_count = 4;
/// Pictures are small: several are drawn side by side, between two looks at the progress.
constexpr std::size_t shapes_at_once = 8;

/// Marked where the target folds more than the source does.
std::string flips_of(int flips, int source_flips) {
  const std::string number = std::to_string(flips);
  return flips > source_flips + 3 ? "<span class=\"bad\">" + number + "</span>" : number;
}

/// Marked where an edge is stretched much more than on the source.
std::string stretch_of(const ShapeRow& shape) {
  const std::string number = fmt::format("{:.1f}", shape.stretch);
  return stretches_more(shape) ? "<span class=\"bad\">" + number + "</span>" : number;
}

bool name_holds(std::string name, std::string_view word) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name.find(word) != std::string::npos;
}

/// A jaw and a blink where names tell them, then the shapes that differ most.
std::vector<std::size_t> telling_shapes(const std::vector<ShapeRow>& shapes) {
  std::vector<std::size_t> order(shapes.size()), chosen;
  for (std::size_t s = 0; s < order.size(); ++s) order[s] = s;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return shapes[a].difference * shapes[a].moved > shapes[b].difference * shapes[b].moved;
  });
  const auto add = [&](std::size_t s) {
    if (std::find(chosen.begin(), chosen.end(), s) == chosen.end()) chosen.push_back(s);
  };
  const auto add_named = [&](std::initializer_list<std::string_view> words) {
    for (const std::string_view word : words)
      for (const std::size_t s : order)
        if (name_holds(shapes[s].name, word)) return add(s);
  };
  add_named({"jawopen", "jaw_open", "mouth-open", "mouth_open", "mouthopen", "jaw"});
  add_named({"blink", "eye-left-closure", "eyesclosed", "eye_close"});
  for (const std::size_t s : order)
    if (chosen.size() < telling_count) add(s);
  return chosen;
}

std::string shape_table(const PageInput& page) {
  const bool compared = page.data.thesis.has_value();
  std::vector<std::string> head{"shape",         "moves, %",        "flips, source",
                                "flips, target", "stretch, source", "stretch, target"};
  if (compared) head.insert(head.end(), {"thesis: difference", "thesis: flips", "thesis: torn edges"});
  std::vector<std::vector<std::string>> rows;
  for (const ShapeRow& shape : page.data.shapes) {
    std::vector<std::string> row{escaped(shape.name),
                                 fmt::format("{:.2f}", 100 * shape.moved),
                                 std::to_string(shape.source_flips),
                                 flips_of(shape.flips, shape.source_flips),
                                 fmt::format("{:.1f}", shape.source_stretch),
                                 stretch_of(shape)};
    if (compared)
      row.insert(row.end(), {fmt::format("{:.0f} %", 100 * shape.difference),
                             std::to_string(shape.thesis_flips), std::to_string(shape.thesis_torn)});
    rows.push_back(std::move(row));
  }
  return "<details><summary>All shapes in figures</summary>\n" + table(head, rows) + "</details>\n";
}

std::string shape_card(const PageInput& page, std::size_t s) {
  const ShapeRow& shape = page.data.shapes[s];
  const RenderOptions options = sized(cell_width, cell_height);
  return "<div class=\"card\"><div class=\"pair\">" +
         image(page.source.face(in_shape(page.input.source, s), options), shape.name + " on the source") +
         image(page.target.face(in_shape(page.input.result.character, s), options),
               shape.name + " on the target") +
         "</div><h4>" + escaped(shape.name) + "</h4><p>" +
         fmt::format("flips {} / {} &middot; stretch {:.1f} / {}", shape.source_flips,
                     flips_of(shape.flips, shape.source_flips), shape.source_stretch, stretch_of(shape)) +
         "</p></div>\n";
}

}  // namespace

std::string shapes_section(const PageInput& page) {
  if (page.data.shapes.empty()) return {};
  std::string text = fmt::format(
      "<h2 id=\"shapes\">Shapes</h2>\n<p>All {} at weight 1; source left, target right. Flips are triangles "
      "of the skin that turn over, source / target; stretch is the worst edge, times its length at "
      "rest.</p>\n<div class=\"cards\">\n",
      page.data.shapes.size());
  std::vector<std::string> cards(page.data.shapes.size());
  for (std::size_t first = 0; first < cards.size(); first += shapes_at_once) {
    const double done = static_cast<double>(first) / static_cast<double>(cards.size());
    report_progress(page.input.progress, "report: shapes", 0.4 + 0.45 * done);
    parallel_for(std::min(shapes_at_once, cards.size() - first), 1,
                 [&](std::size_t k, std::size_t) { cards[first + k] = shape_card(page, first + k); });
  }
  for (const std::string& card : cards) text += card;
  return text + "</div>\n" + shape_table(page);
}

std::string baseline_section(const PageInput& page) {
  if (!page.thesis || page.data.shapes.empty()) return {};
  double difference = 0;
  int flips = 0, thesis_flips = 0;
  for (const ShapeRow& shape : page.data.shapes) {
    difference += shape.difference;
    flips += shape.flips;
    thesis_flips += shape.thesis_flips;
  }
  const auto count = static_cast<double>(page.data.shapes.size());
  std::string text = "<h2 id=\"baseline\">Beside the thesis's method</h2>\n";
  text += fmt::format(
      "<p>The same inputs through the method of Orvalho's thesis (2007) to the letter: thin-plate spline, "
      "closest point, T(x + d) &minus; T(x). On average its shapes differ from these by {:.0f} % of the "
      "displacement (rms). It turns over {:.1f} triangles a shape, this result {:.1f}; it stretches {:.2f} % "
      "of the edges to more than twice their length here in some shape.</p>\n",
      100 * difference / count, thesis_flips / count, flips / count, 100 * page.data.torn_share);
  const RenderOptions options = sized(wide_width, wide_height);
  for (const std::size_t s : telling_shapes(page.data.shapes)) {
    const ShapeRow& shape = page.data.shapes[s];
    text += "<h3>" + escaped(shape.name) + "</h3>\n<div class=\"three\">\n";
    text += figure(page.source.face(in_shape(page.input.source, s), options), shape.name + " on the source",
                   fmt::format("<b>Source</b>, {} flips", shape.source_flips));
    text += figure(page.thesis->face(in_shape(page.data.thesis->character, s), options),
                   shape.name + " by the thesis's method",
                   fmt::format("<b>Thesis's method</b>, {} flips, {} torn edges, {:.0f} % different",
                               shape.thesis_flips, shape.thesis_torn, 100 * shape.difference));
    text += figure(page.target.face(in_shape(page.input.result.character, s), options),
                   shape.name + " in this result", fmt::format("<b>This result</b>, {} flips", shape.flips)) +
            "</div>\n";
  }
  return text;
}

}  // namespace mien::detail
