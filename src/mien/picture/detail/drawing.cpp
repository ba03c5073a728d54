#include "mien/picture/detail/drawing.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace mien::detail {
namespace {

/// A number with at most two decimals, without a locale.
std::string number(double value) {
  char text[32];
  const long long hundredths = std::llround(value * 100), size = std::llabs(hundredths);
  const char* sign = hundredths < 0 ? "-" : "";
  if (size % 100 == 0)
    std::snprintf(text, sizeof text, "%s%lld", sign, size / 100);
  else
    std::snprintf(text, sizeof text, "%s%lld.%02lld", sign, size / 100, size % 100);
  return text;
}

std::string hex(Color color) {
  char text[8];
  const auto byte = [](float v) { return static_cast<int>(std::lround(255 * v)); };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(color.r), byte(color.g), byte(color.b));
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else
      safe += c;
  }
  return safe;
}

struct Painter {
  Canvas& canvas;
  void operator()(const LineStroke& line) const { canvas.line(line.points, line.width, line.color); }
  void operator()(const BoxStroke& box) const { canvas.fill(box.x, box.y, box.width, box.height, box.color); }
  void operator()(const TextStroke& text) const { canvas.text(text.text, text.at, text.style); }
};

struct Writer {
  std::string& out;

  void operator()(const LineStroke& line) const {
    out += "<polyline fill=\"none\" stroke-linejoin=\"round\" stroke=\"" + hex(line.color) +
           "\" stroke-width=\"" + number(line.width) + "\" points=\"";
    for (const Eigen::Vector2d& p : line.points) out += number(p.x()) + "," + number(p.y()) + " ";
    out += "\"/>\n";
  }

  void operator()(const BoxStroke& box) const {
    out += "<rect x=\"" + number(box.x) + "\" y=\"" + number(box.y) + "\" width=\"" + number(box.width) +
           "\" height=\"" + number(box.height) + "\" fill=\"" + hex(box.color) + "\"/>\n";
  }

  void operator()(const TextStroke& text) const {
    const TextStyle& style = text.style;
    const char* anchor = style.align == Align::left     ? "start"
                         : style.align == Align::centre ? "middle"
                                                        : "end";
    out += "<text x=\"" + number(text.at.x()) + "\" y=\"" + number(text.at.y()) + "\" font-size=\"" +
           number(style.size) + "\" fill=\"" + hex(style.color) + "\" text-anchor=\"" + anchor + "\"";
    if (style.bold) out += " font-weight=\"bold\"";
    if (style.turn != 0)
      out += " transform=\"rotate(" + number(-style.turn * 180 / std::numbers::pi) + " " +
             number(text.at.x()) + " " + number(text.at.y()) + ")\"";
    out += '>';
    out += escaped(valid_utf8(text.text));
    out += "</text>\n";
  }
};

}  // namespace

Picture paint(const Drawing& drawing) {
  Picture picture = blank_picture(drawing.width, drawing.height);
  Canvas canvas(picture);
  for (const auto& stroke : drawing.strokes) std::visit(Painter{canvas}, stroke);
  canvas.finish();
  return picture;
}

std::string svg(const Drawing& drawing) {
  const std::string width = std::to_string(drawing.width), height = std::to_string(drawing.height);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                    "\" viewBox=\"0 0 " + width + " " + height +
                    "\" font-family=\"DejaVu Sans, Verdana, sans-serif\">\n";
  for (const auto& stroke : drawing.strokes) std::visit(Writer{out}, stroke);
  return out + "</svg>\n";
}

}  // namespace mien::detail
