#pragma once
/// Cairo, held safely: a drawing surface over a Picture.

#include <cairo.h>

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "mien/picture/picture.h"

namespace mien::detail {

/// Owns a Cairo image surface with a picture's pixels.
class Surface {
 public:
  explicit Surface(const Picture& picture);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  cairo_surface_t* get() const { return surface_; }
  /// Copies the pixels back.
  void store(Picture& picture) const;

 private:
  cairo_surface_t* surface_;
};

enum class Align { left, centre, right };

struct TextStyle {
  double size = 12;  ///< pixels
  Color color = {0.1f, 0.1f, 0.1f};
  Align align = Align::left;
  bool bold = false;
  double turn = 0;  ///< radians, counter-clockwise
};

/// The text with '?' for every byte that is not UTF-8 or is a control character.
std::string valid_utf8(std::string_view text);

/// Draws on a picture; `finish` writes the pixels back into it. Pixels, origin at the upper left, y down.
class Canvas {
 public:
  explicit Canvas(Picture& picture);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  void finish();

  void fill(double x, double y, double width, double height, Color color, double alpha = 1);
  void outline(double x, double y, double width, double height, Color color);
  void line(const std::vector<Eigen::Vector2d>& points, double width, Color color);
  void dot(Eigen::Vector2d centre, double radius, Color color);
  /// `at` is on the baseline. Bytes that are not UTF-8 are drawn as '?'.
  void text(std::string_view text, Eigen::Vector2d at, const TextStyle& style);
  /// The text on a light halo, readable on any ground.
  void text_on_picture(std::string_view text, Eigen::Vector2d at, const TextStyle& style);
  double text_width(std::string_view text, const TextStyle& style);
  /// The text, shortened with an ellipsis to at most `width` pixels.
  std::string fitted(std::string_view text, double width, const TextStyle& style);
  void draw(const Picture& picture, double x, double y, double width, double height);
  void draw(cairo_surface_t* surface);

 private:
  void select(const TextStyle& style);
  Picture& picture_;
  Surface surface_;
  cairo_t* cairo_;
};

}  // namespace mien::detail
