#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/picture/plot.h"
#include "mien/report/detail/html.h"
#include "mien/report/detail/page.h"
#include "mien/report/thesis_times.h"

namespace mien::detail {
namespace {

/// One curve of the target against the source's.
std::string plot_of(const ClipRows& clip, const CurveRow& curve, const std::vector<double>& target,
                    const char* how) {
  PlotOptions options;
  options.title = curve.name;
  options.x_label = "seconds";
  options.y_label = "\u03b5";
  options.width = 560;
  options.height = 280;
  const std::vector<Series> series{{"source", clip.seconds, curve.source}, {how, clip.seconds, target}};
  return "<div class=\"plot\">" + line_plot_svg(series, options) + "</div>\n";
}

/// As in the thesis's figure: the copied clip left, the transferred one right.
std::string plots_of(const ClipRows& clip, const CurveRow& curve) {
  std::string text;
  if (!curve.copied.empty()) text += plot_of(clip, curve, curve.copied, "target, clip copied unchanged");
  return text + plot_of(clip, curve, curve.target, "target");
}

std::vector<std::string> cells_of(const CurveAgreement& agreement) {
  return {fmt::format("{:.3f}", agreement.correlation), fmt::format("{:.3f}", agreement.rms_difference),
          fmt::format("{:.2f}", agreement.gain)};
}

bool copy_differs(const std::vector<CurveRow>& curves) {
  return std::any_of(curves.begin(), curves.end(),
                     [](const CurveRow& curve) { return !curve.copied.empty(); });
}

std::string curves_of(const ClipRows& clip, const std::vector<CurveRow>& curves, const char* between) {
  if (curves.empty()) return {};
  const bool copied = copy_differs(curves);
  std::string plots;
  std::vector<std::string> head{"distance", "correlation", "rms difference", "gain"};
  if (copied) head.insert(head.end(), {"copied: correlation", "rms difference", "gain"});
  std::vector<std::vector<std::string>> rows;
  for (const CurveRow& curve : curves) {
    plots += plots_of(clip, curve);
    std::vector<std::string> row{escaped(curve.name)};
    for (std::string& cell : cells_of(curve.target_agreement)) row.push_back(std::move(cell));
    if (copied)
      for (std::string& cell : cells_of(curve.copied_agreement)) row.push_back(std::move(cell));
    rows.push_back(std::move(row));
  }
  std::string text =
      fmt::format("<h3>{}, between {}</h3>\n<div class=\"plots\">\n", escaped(clip.name), between);
  text += plots + "</div>\n" + table(head, rows);
  return text;
}

double seconds_of(const TransferReport& report, std::string_view step) {
  for (const StepTime& time : report.steps)
    if (time.step == step) return time.seconds;
  return std::numeric_limits<double>::quiet_NaN();
}

/// Seconds as the thesis counts them: shapes one by one; not a number where there was nothing to do.
double like_thesis(const TransferResult& result, const ThesisStep& step) {
  const Character& character = result.character;
  const bool needs_joints = step.step == "joints" || step.step == "skin weights";
  if ((needs_joints && character.skins.empty()) || (step.step == "clips" && character.clips.empty()) ||
      (step.each_shape && character.shapes.empty()))
    return std::numeric_limits<double>::quiet_NaN();
  const double seconds = seconds_of(result.report, step.step);
  return step.each_shape ? seconds / static_cast<double>(character.shapes.size()) : seconds;
}

std::string time_text(double seconds) {
  if (std::isnan(seconds)) return "&ndash;";
  if (seconds < 1e-4) return "&lt; 0.0001";
  return seconds < 0.0995 ? fmt::format("{:.4f}", seconds) : fmt::format("{:.2f}", seconds);
}

std::string thesis_table(const PageInput& page) {
  std::vector<std::string> head{"step, seconds", "this transfer"};
  if (page.data.thesis) head.push_back("thesis's method,<br>here");
  for (const ThesisCharacter& character : thesis_characters())
    head.push_back(fmt::format("{}<br>5.{}", character.name, character.table));
  std::vector<std::vector<std::string>> rows;
  for (const ThesisStep& step : thesis_steps()) {
    std::vector<std::string> row{std::string(step.name), time_text(like_thesis(page.input.result, step))};
    if (page.data.thesis) row.push_back(time_text(like_thesis(*page.data.thesis, step)));
    for (const double seconds : step.seconds) row.push_back(fmt::format("{:.2f}", seconds));
    rows.push_back(std::move(row));
  }
  return table(head, rows);
}

std::string thesis_chart(const PageInput& page) {
  std::vector<std::string> labels;
  std::vector<double> here, baseline, then;
  for (const ThesisStep& step : thesis_steps()) {
    if (std::isnan(like_thesis(page.input.result, step))) continue;
    labels.push_back(std::string(step.name));
    here.push_back(like_thesis(page.input.result, step));
    if (page.data.thesis) baseline.push_back(like_thesis(*page.data.thesis, step));
    double sum = 0;
    for (const double seconds : step.seconds) sum += seconds;
    then.push_back(sum / static_cast<double>(step.seconds.size()));
  }
  std::vector<BarGroup> groups{{"this transfer", here}};
  if (page.data.thesis) groups.push_back({"thesis's method, here", baseline});
  groups.push_back({"thesis, mean of its six targets", then});
  PlotOptions options;
  options.x_label = "seconds";
  options.width = 760;
  options.height = 420;
  return "<div class=\"plot\">" + bar_chart_svg(labels, groups, options) + "</div>\n";
}

std::string own_steps(const PageInput& page) {
  std::vector<std::vector<std::string>> rows;
  double total = 0;
  for (const StepTime& step : page.input.result.report.steps) {
    rows.push_back({escaped(step.step), time_text(step.seconds)});
    total += step.seconds;
  }
  rows.push_back({"<b>total</b>", "<b>" + time_text(total) + "</b>"});
  return "<h3>All steps of this transfer</h3>\n" + table({"step", "seconds"}, rows);
}

}  // namespace

std::string clips_section(const PageInput& page) {
  std::string curves;
  for (const ClipRows& clip : page.data.clips) {
    const std::string one = curves_of(clip, clip.joints, "joints") +
                            curves_of(clip, clip.objects, "control points of influence objects") +
                            curves_of(clip, clip.surface, "landmarks on the surface");
    curves += one;
    if (!one.empty() && !copy_differs(clip.joints) && !copy_differs(clip.objects) &&
        !copy_differs(clip.surface))
      curves +=
          "<p class=\"soft\">Copying this clip unchanged gives the same: it holds rotations and shape "
          "weights alone, which have no length.</p>\n";
  }
  if (curves.empty()) return {};
  return "<h2 id=\"clips\">Relative deformation</h2>\n<p>How the distance between two points changes in a "
         "clip, &epsilon; = (l<sub>1</sub> &minus; l<sub>0</sub>) / l<sub>0</sub> with l<sub>0</sub> the "
         "distance at rest: the thesis's figure 5.3. A clip that keeps its intensity follows the source's "
         "curve; one that is copied without being transferred comes out weak, strong or bent. Gain is the "
         "factor that brings the source's curve closest. The distances are those that change most.</p>\n" +
         curves;
}

std::string seconds_section(const PageInput& page) {
  return "<h2 id=\"seconds\">Seconds</h2>\n<p>In the form of tables 5.1 and 5.2 of the thesis (V. Costa "
         "Orvalho, Reusable Facial Rigging and Animation, 2007), whose figures were measured on its machines "
         "of the time with targets of 2,702 to 3,412 triangles. Its skin deformation is the spline alone; "
         "here it holds the registration too.</p>\n" +
         thesis_table(page) + thesis_chart(page) + own_steps(page);
}

}  // namespace mien::detail
