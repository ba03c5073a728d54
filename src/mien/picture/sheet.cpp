#include "mien/picture/sheet.h"

#include <algorithm>
#include <cmath>

#include "mien/core/error.h"
#include "mien/picture/detail/canvas.h"

namespace mien {
namespace {

constexpr double gap = 6;

struct Layout {
  int columns = 1, rows = 1;
  double cell_width = 0, cell_height = 0;  // of the picture alone
  double text = 11;                        // size of the labels
  double label_height = 0, title_height = 0, footer_height = 0;

  double x(std::size_t cell) const { return gap + (cell % columns) * (cell_width + gap); }
  double y(std::size_t cell) const {
    return gap + title_height + (cell / columns) * (cell_height + label_height + gap);
  }
  int width() const { return static_cast<int>(std::ceil(gap + columns * (cell_width + gap))); }
  int height() const {
    return static_cast<int>(
        std::ceil(gap + title_height + rows * (cell_height + label_height + gap) + footer_height));
  }
};

Layout lay_out(const std::vector<SheetCell>& cells, const SheetOptions& options) {
  Layout layout;
  bool label = false, caption = false;
  for (const SheetCell& cell : cells) {
    layout.cell_width = std::max(layout.cell_width, static_cast<double>(cell.picture.width));
    layout.cell_height = std::max(layout.cell_height, static_cast<double>(cell.picture.height));
    label = label || !cell.label.empty();
    caption = caption || !cell.caption.empty();
  }
  layout.cell_width = std::max(layout.cell_width, 48.0);
  layout.text = std::clamp(layout.cell_width / 18, 9.0, 16.0);
  layout.label_height = (label ? 1.5 * layout.text : 0) + (caption ? 1.4 * layout.text : 0);
  layout.title_height = options.title.empty() ? 0 : 2.4 * layout.text;
  layout.footer_height = options.footer.empty() ? 0 : 2 * layout.text;
  const auto count = static_cast<int>(cells.size());
  const double cell_aspect = layout.cell_width / (layout.cell_height + layout.label_height);
  const int wide = static_cast<int>(std::ceil(std::sqrt(1.5 * count / cell_aspect)));
  layout.columns = std::clamp(options.columns > 0 ? options.columns : wide, 1, count);
  layout.rows = (count + layout.columns - 1) / layout.columns;
  return layout;
}

void draw_cell(const SheetCell& cell, double x, double y, const Layout& layout, detail::Canvas& canvas) {
  if (cell.picture.width > 0)
    canvas.draw(cell.picture, std::floor(x + (layout.cell_width - cell.picture.width) / 2),
                std::floor(y + (layout.cell_height - cell.picture.height) / 2), cell.picture.width,
                cell.picture.height);
  const double middle = x + layout.cell_width / 2;
  const detail::TextStyle bold{.size = layout.text, .align = detail::Align::centre, .bold = true};
  detail::TextStyle plain = bold;
  plain.bold = false;
  plain.color = {0.3f, 0.3f, 0.3f};
  plain.size = 0.92 * layout.text;
  const double line = y + layout.cell_height + 1.2 * layout.text;
  canvas.text(canvas.fitted(cell.label, layout.cell_width, bold), {middle, line}, bold);
  if (!cell.caption.empty())
    canvas.text(canvas.fitted(cell.caption, layout.cell_width, plain), {middle, line + 1.35 * layout.text},
                plain);
}

}  // namespace

Picture contact_sheet(const std::vector<SheetCell>& cells, const SheetOptions& options) {
  if (cells.empty()) throw invalid_input("sheet", "has no pictures", "at least one");
  const Layout layout = lay_out(cells, options);
  Picture sheet = blank_picture(layout.width(), layout.height());
  detail::Canvas canvas(sheet);
  const double inner = layout.width() - 2 * gap;
  const detail::TextStyle title{.size = 1.4 * layout.text, .bold = true};
  const detail::TextStyle footer{.size = layout.text, .color = {0.3f, 0.3f, 0.3f}};
  if (!options.title.empty())
    canvas.text(canvas.fitted(options.title, inner, title), {gap, gap + 1.6 * layout.text}, title);
  for (std::size_t c = 0; c < cells.size(); ++c)
    draw_cell(cells[c], layout.x(c), layout.y(c), layout, canvas);
  if (!options.footer.empty())
    canvas.text(canvas.fitted(options.footer, inner, footer), {gap, layout.height() - 0.8 * layout.text},
                footer);
  canvas.finish();
  return sheet;
}

}  // namespace mien
