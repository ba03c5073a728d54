#pragma once
/// Line plots and bar charts, as a Picture or as SVG text for a page.

#include <string>
#include <vector>

#include "mien/picture/picture.h"

namespace mien {

/// One curve. A y that is not finite leaves a gap.
struct Series {
  std::string name;  ///< in the legend; none: not listed
  std::vector<double> x, y;
};

/// One value a group: `BarGroup{"thesis", {0.1, 0.4}}` beside `BarGroup{"default", {0.2, 0.5}}`.
struct BarGroup {
  std::string name;            ///< in the legend
  std::vector<double> values;  ///< one a bar label; negative and not finite ones are drawn as 0
};

struct PlotOptions {
  std::string title, x_label, y_label;  ///< with units; none: left out
  int width = 640, height = 320;        ///< pixels
  bool zero = true;                     ///< the y axis holds 0
};

/// Curves over a common x axis with ticks, a light grid and a legend.
///   throws  invalid_input: no series, a series whose x and y differ in number, an x that is not finite, a
///           picture side out of range
Picture line_plot(const std::vector<Series>& series, const PlotOptions& options = {});
std::string line_plot_svg(const std::vector<Series>& series, const PlotOptions& options = {});

/// Horizontal bars: for each label one bar of every group, with its value at its end. `y_label` is unused.
///   throws  invalid_input: no labels, no groups, a group with another number of values than labels
Picture bar_chart(const std::vector<std::string>& labels, const std::vector<BarGroup>& groups,
                  const PlotOptions& options = {});
std::string bar_chart_svg(const std::vector<std::string>& labels, const std::vector<BarGroup>& groups,
                          const PlotOptions& options = {});

}  // namespace mien
