#pragma once
/// A flat drawing as a list of strokes, painted as pixels or written as SVG.

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "mien/picture/detail/canvas.h"
#include "mien/picture/picture.h"

namespace mien::detail {

struct LineStroke {
  std::vector<Eigen::Vector2d> points;
  double width = 1;
  Color color;
};
struct BoxStroke {
  double x = 0, y = 0, width = 0, height = 0;
  Color color;
};
struct TextStroke {
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  TextStyle style;
};

struct Drawing {
  int width = 1, height = 1;  ///< pixels
  std::vector<std::variant<LineStroke, BoxStroke, TextStroke>> strokes;
};

Picture paint(const Drawing& drawing);
std::string svg(const Drawing& drawing);

}  // namespace mien::detail
