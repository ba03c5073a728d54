#include "mien/picture/matrix_plot.h"

#include <algorithm>
#include <numbers>

#include "mien/core/error.h"
#include "mien/picture/detail/canvas.h"

namespace mien {

Picture matrix_plot(const std::vector<std::string>& names, const Eigen::MatrixXd& values,
                    const MatrixPlotOptions& options) {
  const int count = static_cast<int>(values.rows());
  if (count == 0 || values.cols() != count || names.size() != static_cast<std::size_t>(count))
    throw invalid_input("matrix",
                        "has " + std::to_string(values.rows()) + " x " + std::to_string(values.cols()) +
                            " values for " + std::to_string(names.size()) + " names",
                        "as many rows and columns as names, one or more");
  const int cell = std::max(1, options.cell);
  const bool named = cell >= 8;
  const int margin = named ? 160 : 10, top = margin + (options.title.empty() ? 0 : 26);
  Picture picture = blank_picture(margin + cell * count + 10, top + cell * count + 10);
  detail::Canvas canvas(picture);
  const double range = options.high - options.low;
  for (int r = 0; r < count; ++r)
    for (int c = 0; c < count; ++c)
      canvas.fill(margin + cell * c, top + cell * r, cell, cell,
                  map_color(options.colors, (values(r, c) - options.low) / range));
  detail::TextStyle across{std::min(11.0, 0.85 * cell)}, up = across;
  across.align = detail::Align::right;
  up.turn = std::numbers::pi / 2;
  for (int k = 0; named && k < count; ++k) {
    const std::string name = canvas.fitted(names[static_cast<std::size_t>(k)], margin - 14, across);
    canvas.text(name, {margin - 5.0, top + cell * (k + 0.78)}, across);
    canvas.text(name, {margin + cell * (k + 0.78), top - 5.0}, up);
  }
  if (!options.title.empty())
    canvas.text(options.title, {10, 20}, {14, {0.1f, 0.1f, 0.1f}, detail::Align::left, true});
  canvas.finish();
  return picture;
}

}  // namespace mien
