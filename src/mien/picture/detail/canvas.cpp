#include "mien/picture/detail/canvas.h"

#include <cmath>
#include <numbers>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
/// Cairo refuses text that is not UTF-8 and is then dead for good: names from files are made safe first.
std::string valid_utf8(std::string_view text) {
  std::string valid;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xc2 ? 0
                               : lead < 0xe0 ? 2
                               : lead < 0xf0 ? 3
                               : lead < 0xf5 ? 4
                                             : 0;
    bool good = length > 0 && i + length <= text.size() && lead >= 0x20;
    for (std::size_t k = 1; good && k < length; ++k)
      good = (static_cast<unsigned char>(text[i + k]) & 0xc0) == 0x80;
    // Overlong three- and four-byte forms, surrogates and what lies beyond U+10FFFF.
    const auto second = length > 2 && good ? static_cast<unsigned char>(text[i + 1]) : 0x90;
    if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) ||
        (lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f))
      good = false;
    valid.append(good ? text.substr(i, length) : std::string_view("?"));
    i += good ? length : 1;
  }
  return valid;
}

Surface::Surface(const Picture& picture)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height)) {
  if (cairo_surface_status(surface_) != CAIRO_STATUS_SUCCESS)
    throw invalid_input("picture", "cannot be drawn on: " +
                                       std::string(cairo_status_to_string(cairo_surface_status(surface_))));
  unsigned char* data = cairo_image_surface_get_data(surface_);
  const int stride = cairo_image_surface_get_stride(surface_);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = picture.rgba.data() + 4 * (std::size_t(y) * picture.width + x);
      const std::uint32_t word = std::uint32_t{p[0]} << 16 | std::uint32_t{p[1]} << 8 | p[2];
      reinterpret_cast<std::uint32_t*>(data + std::size_t(y) * stride)[x] = word;
    }
  cairo_surface_mark_dirty(surface_);
}

Surface::~Surface() {
  cairo_surface_destroy(surface_);
}

void Surface::store(Picture& picture) const {
  cairo_surface_flush(surface_);
  const unsigned char* data = cairo_image_surface_get_data(surface_);
  const int stride = cairo_image_surface_get_stride(surface_);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const std::uint32_t word = reinterpret_cast<const std::uint32_t*>(data + std::size_t(y) * stride)[x];
      std::uint8_t* p = picture.rgba.data() + 4 * (std::size_t(y) * picture.width + x);
      p[0] = static_cast<std::uint8_t>(word >> 16);
      p[1] = static_cast<std::uint8_t>(word >> 8);
      p[2] = static_cast<std::uint8_t>(word);
      p[3] = 255;
    }
}

Canvas::Canvas(Picture& picture)
    : picture_(picture), surface_(picture), cairo_(cairo_create(surface_.get())) {}

Canvas::~Canvas() {
  cairo_destroy(cairo_);
}

void Canvas::finish() {
  surface_.store(picture_);
}

void Canvas::fill(double x, double y, double width, double height, Color color, double alpha) {
  cairo_set_source_rgba(cairo_, color.r, color.g, color.b, alpha);
  cairo_rectangle(cairo_, x, y, width, height);
  cairo_fill(cairo_);
}

void Canvas::outline(double x, double y, double width, double height, Color color) {
  cairo_set_source_rgb(cairo_, color.r, color.g, color.b);
  cairo_set_line_width(cairo_, 1);
  cairo_rectangle(cairo_, x + 0.5, y + 0.5, width - 1, height - 1);
  cairo_stroke(cairo_);
}

void Canvas::line(const std::vector<Eigen::Vector2d>& points, double width, Color color) {
  if (points.size() < 2) return;
  cairo_set_source_rgb(cairo_, color.r, color.g, color.b);
  cairo_set_line_width(cairo_, width);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
  cairo_new_path(cairo_);
  for (const Eigen::Vector2d& p : points) cairo_line_to(cairo_, p.x(), p.y());
  cairo_stroke(cairo_);
}

void Canvas::dot(Eigen::Vector2d centre, double radius, Color color) {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x(), centre.y(), radius, 0, 2 * std::numbers::pi);
  cairo_set_source_rgb(cairo_, color.r, color.g, color.b);
  cairo_fill_preserve(cairo_);
  cairo_set_source_rgba(cairo_, 1, 1, 1, 0.9);
  cairo_set_line_width(cairo_, 0.8);
  cairo_stroke(cairo_);
}

void Canvas::select(const TextStyle& style) {
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, style.size);
}

double Canvas::text_width(std::string_view text, const TextStyle& style) {
  select(style);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, valid_utf8(text).c_str(), &extents);
  return extents.x_advance;
}

std::string Canvas::fitted(std::string_view text, double width, const TextStyle& style) {
  std::string kept = valid_utf8(text);
  if (text_width(kept, style) <= width) return kept;
  while (!kept.empty() && text_width(kept + "\u2026", style) > width) {
    while ((static_cast<unsigned char>(kept.back()) & 0xc0) == 0x80) kept.pop_back();
    kept.pop_back();
  }
  return kept + "\u2026";
}

void Canvas::text(std::string_view text, Eigen::Vector2d at, const TextStyle& style) {
  const double width = style.align == Align::left ? 0 : text_width(text, style);
  const double shift = style.align == Align::centre ? width / 2 : width;
  select(style);
  cairo_save(cairo_);
  cairo_translate(cairo_, at.x(), at.y());
  cairo_rotate(cairo_, -style.turn);
  cairo_move_to(cairo_, -shift, 0);
  cairo_set_source_rgb(cairo_, style.color.r, style.color.g, style.color.b);
  cairo_show_text(cairo_, valid_utf8(text).c_str());
  cairo_new_path(cairo_);
  cairo_restore(cairo_);
}

void Canvas::text_on_picture(std::string_view text, Eigen::Vector2d at, const TextStyle& style) {
  select(style);
  const double shift = style.align == Align::left     ? 0
                       : style.align == Align::centre ? text_width(text, style) / 2
                                                      : text_width(text, style);
  cairo_move_to(cairo_, at.x() - shift, at.y());
  cairo_text_path(cairo_, valid_utf8(text).c_str());
  cairo_set_source_rgba(cairo_, 1, 1, 1, 0.85);
  cairo_set_line_width(cairo_, 2.5);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cairo_);
  this->text(text, at, style);
}

void Canvas::draw(const Picture& picture, double x, double y, double width, double height) {
  const Surface source(picture);
  cairo_save(cairo_);
  cairo_translate(cairo_, x, y);
  cairo_scale(cairo_, width / picture.width, height / picture.height);
  cairo_set_source_surface(cairo_, source.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo_), CAIRO_FILTER_GOOD);
  cairo_pattern_set_extend(cairo_get_source(cairo_), CAIRO_EXTEND_PAD);
  cairo_rectangle(cairo_, 0, 0, picture.width, picture.height);
  cairo_fill(cairo_);
  cairo_restore(cairo_);
}

void Canvas::draw(cairo_surface_t* surface) {
  cairo_set_source_surface(cairo_, surface, 0, 0);
  cairo_paint(cairo_);
}

}  // namespace mien::detail
