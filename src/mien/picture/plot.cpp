#include "mien/picture/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>

#include "mien/core/error.h"
#include "mien/picture/detail/drawing.h"

namespace mien {
namespace {

using detail::Align;
using detail::Drawing;
using detail::TextStyle;

constexpr double text_size = 11;
constexpr Color ink{0.15f, 0.15f, 0.15f}, soft_ink{0.35f, 0.35f, 0.35f}, grid{0.88f, 0.88f, 0.88f};
constexpr std::array<Color, 8> palette{{{0.12f, 0.47f, 0.71f},
                                        {0.89f, 0.42f, 0.04f},
                                        {0.17f, 0.63f, 0.17f},
                                        {0.78f, 0.15f, 0.19f},
                                        {0.52f, 0.36f, 0.70f},
                                        {0.50f, 0.33f, 0.28f},
                                        {0.85f, 0.43f, 0.72f},
                                        {0.35f, 0.35f, 0.35f}}};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value == 0 ? 0.0 : value);
  return text;
}

/// A value axis: the range, widened to whole ticks 1, 2 or 5 x 10^k apart.
struct Axis {
  double low = 0, high = 1, step = 1;
  double share(double value) const { return (value - low) / (high - low); }
  int ticks() const { return static_cast<int>(std::lround((high - low) / step)); }
};

Axis make_axis(double low, double high, int wanted) {
  if (!(low <= high)) low = 0, high = 1;
  if (high - low <= 1e-12 * std::max(std::abs(low), std::abs(high)) || high == low) {
    const double room = low == 0 ? 1 : 0.5 * std::abs(low);
    low -= low == 0 ? 0 : room;
    high += room;
  }
  const double rough = (high - low) / wanted;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double factor = rough / power <= 1 ? 1 : rough / power <= 2 ? 2 : rough / power <= 5 ? 5 : 10;
  const double step = factor * power;
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step};
}

void add_text(Drawing& drawing, std::string text, double x, double y, const TextStyle& style) {
  drawing.strokes.push_back(detail::TextStroke{std::move(text), {x, y}, style});
}

void add_line(Drawing& drawing, std::vector<Eigen::Vector2d> points, double width, Color color) {
  drawing.strokes.push_back(detail::LineStroke{std::move(points), width, color});
}

double width_of(const std::string& text, const TextStyle& style) {
  Picture scratch = blank_picture(1, 1);
  return detail::Canvas(scratch).text_width(text, style);
}

struct Frame {
  double left = 0, top = 0, right = 0, bottom = 0;
  double x(double share) const { return left + share * (right - left); }
  double y(double share) const { return bottom - share * (bottom - top); }
};

/// Title and legend in the rows above the frame; gives the y below them.
double add_head(Drawing& drawing, const PlotOptions& options, const std::vector<std::string>& names,
                double left) {
  double y = 8;
  if (!options.title.empty()) {
    y += 14;
    add_text(drawing, options.title, left, y, {.size = 13, .color = ink, .bold = true});
  }
  if (std::all_of(names.begin(), names.end(), [](const std::string& name) { return name.empty(); }))
    return y + 8;
  const TextStyle style{.size = text_size, .color = ink};
  double x = left;
  y += 17;
  for (std::size_t s = 0; s < names.size(); ++s) {
    if (names[s].empty()) continue;
    const double width = 24 + width_of(names[s], style) + 14;
    if (x > left && x + width > options.width - 8) {
      x = left;
      y += 15;
    }
    add_line(drawing, {{x, y - 4}, {x + 18, y - 4}}, 3, palette[s % palette.size()]);
    add_text(drawing, names[s], x + 24, y, style);
    x += width;
  }
  return y + 10;
}

void check_series(const std::vector<Series>& series) {
  if (series.empty()) throw invalid_input("plot", "has no series", "at least one");
  for (const Series& one : series) {
    if (one.x.size() != one.y.size())
      throw invalid_input(
          "series " + one.name,
          "has " + std::to_string(one.x.size()) + " x and " + std::to_string(one.y.size()) + " y",
          "as many of both");
    if (!std::all_of(one.x.begin(), one.x.end(), [](double x) { return std::isfinite(x); }))
      throw invalid_input("series " + one.name, "has an x that is not finite", "finite numbers");
  }
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

void add_grid(Drawing& drawing, const Frame& frame, const Axis& x_axis, const Axis& y_axis) {
  const TextStyle right{.size = text_size, .color = soft_ink, .align = Align::right};
  const TextStyle centre{.size = text_size, .color = soft_ink, .align = Align::centre};
  for (int k = 0; k <= y_axis.ticks(); ++k) {
    const double value = y_axis.low + k * y_axis.step, y = frame.y(y_axis.share(value));
    add_line(drawing, {{frame.left, y}, {frame.right, y}}, std::abs(value) < 1e-9 * y_axis.step ? 1.2 : 0.8,
             std::abs(value) < 1e-9 * y_axis.step ? soft_ink : grid);
    add_text(drawing, number(std::abs(value) < 1e-9 * y_axis.step ? 0 : value), frame.left - 6, y + 4, right);
  }
  for (int k = 0; k <= x_axis.ticks(); ++k) {
    const double value = x_axis.low + k * x_axis.step, x = frame.x(x_axis.share(value));
    add_line(drawing, {{x, frame.top}, {x, frame.bottom}}, 0.8, grid);
    add_text(drawing, number(std::abs(value) < 1e-9 * x_axis.step ? 0 : value), x, frame.bottom + 15, centre);
  }
}

void add_curve(Drawing& drawing, const Series& series, Color color,
               const std::function<Eigen::Vector2d(double, double)>& place) {
  std::vector<Eigen::Vector2d> run;
  const auto flush = [&] {
    if (run.size() == 1) run.push_back(run[0] + Eigen::Vector2d(1.5, 0));
    if (!run.empty()) add_line(drawing, run, 1.6, color);
    run.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (std::isfinite(series.y[i]))
      run.push_back(place(series.x[i], series.y[i]));
    else
      flush();
  }
  flush();
}

Drawing draw_lines(const std::vector<Series>& series, const PlotOptions& options) {
  check_series(series);
  Drawing drawing{options.width, options.height, {}};
  Range xs, ys;
  std::vector<std::string> names;
  for (const Series& one : series) {
    for (const double x : one.x) xs.add(x);
    for (const double y : one.y) ys.add(y);
    names.push_back(one.name);
  }
  if (options.zero) ys.add(0);
  const Axis y_axis = make_axis(ys.low, ys.high, std::max(2, options.height / 60));
  Axis x_axis = make_axis(xs.low, xs.high, std::max(2, options.width / 90));
  const double tick_width = std::max(width_of(number(y_axis.low), {.size = text_size}),
                                     width_of(number(y_axis.high - y_axis.step), {.size = text_size}));
  Frame frame;
  frame.left = 14 + tick_width + (options.y_label.empty() ? 0 : 18);
  frame.top = add_head(drawing, options, names, frame.left);
  frame.right = options.width - 16;
  frame.bottom = options.height - (options.x_label.empty() ? 26 : 42);
  add_grid(drawing, frame, x_axis, y_axis);
  if (!options.x_label.empty())
    add_text(drawing, options.x_label, (frame.left + frame.right) / 2, options.height - 8,
             {.size = text_size, .color = ink, .align = Align::centre});
  if (!options.y_label.empty())
    add_text(drawing, options.y_label, 15, (frame.top + frame.bottom) / 2,
             {.size = text_size, .color = ink, .align = Align::centre, .turn = std::numbers::pi / 2});
  for (std::size_t s = 0; s < series.size(); ++s)
    add_curve(drawing, series[s], palette[s % palette.size()], [&](double x, double y) {
      return Eigen::Vector2d(frame.x(x_axis.share(x)), frame.y(y_axis.share(y)));
    });
  return drawing;
}

void check_bars(const std::vector<std::string>& labels, const std::vector<BarGroup>& groups) {
  if (labels.empty()) throw invalid_input("bar chart", "has no labels", "at least one");
  if (groups.empty()) throw invalid_input("bar chart", "has no groups", "at least one");
  for (const BarGroup& group : groups)
    if (group.values.size() != labels.size())
      throw invalid_input("bars " + group.name, "have " + std::to_string(group.values.size()) + " values",
                          std::to_string(labels.size()) + ", one a label");
}

Drawing draw_bars(const std::vector<std::string>& labels, const std::vector<BarGroup>& groups,
                  const PlotOptions& options) {
  check_bars(labels, groups);
  Drawing drawing{options.width, options.height, {}};
  const TextStyle right{.size = text_size, .color = ink, .align = Align::right};
  Frame frame;
  for (const std::string& label : labels) frame.left = std::max(frame.left, width_of(label, right));
  frame.left = std::min(frame.left + 16, options.width * 0.5);
  std::vector<std::string> names;
  for (const BarGroup& group : groups) names.push_back(groups.size() > 1 ? group.name : std::string());
  frame.top = add_head(drawing, options, names, 8);
  frame.right = options.width - 64;
  frame.bottom = options.height - (options.x_label.empty() ? 10 : 28);
  Range range;
  range.add(0);
  for (const BarGroup& group : groups)
    for (const double value : group.values) range.add(value);
  const double most = range.high > 0 ? range.high : 1;
  const double row = (frame.bottom - frame.top) / static_cast<double>(labels.size());
  const double bar = 0.78 * row / static_cast<double>(groups.size());
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const double top = frame.top + static_cast<double>(k) * row + 0.11 * row;
    add_text(drawing, labels[k], frame.left - 8, top + 0.39 * row + 4, right);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double given = groups[g].values[k];
      const double value = std::isfinite(given) ? std::max(given, 0.0) : 0.0;
      const double y = top + static_cast<double>(g) * bar, length = (frame.right - frame.left) * value / most;
      drawing.strokes.push_back(
          detail::BoxStroke{frame.left, y, length, 0.9 * bar, palette[g % palette.size()]});
      add_text(drawing, number(given), frame.left + length + 5, y + 0.45 * bar + 4,
               {.size = std::min(text_size, std::max(7.0, bar)), .color = soft_ink});
    }
  }
  add_line(drawing, {{frame.left, frame.top}, {frame.left, frame.bottom}}, 1, soft_ink);
  if (!options.x_label.empty())
    add_text(drawing, options.x_label, (frame.left + frame.right) / 2, options.height - 9,
             {.size = text_size, .color = ink, .align = Align::centre});
  return drawing;
}

}  // namespace

Picture line_plot(const std::vector<Series>& series, const PlotOptions& options) {
  return paint(draw_lines(series, options));
}

std::string line_plot_svg(const std::vector<Series>& series, const PlotOptions& options) {
  return svg(draw_lines(series, options));
}

Picture bar_chart(const std::vector<std::string>& labels, const std::vector<BarGroup>& groups,
                  const PlotOptions& options) {
  return paint(draw_bars(labels, groups, options));
}

std::string bar_chart_svg(const std::vector<std::string>& labels, const std::vector<BarGroup>& groups,
                          const PlotOptions& options) {
  return svg(draw_bars(labels, groups, options));
}

}  // namespace mien
