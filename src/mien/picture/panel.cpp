#include "mien/picture/panel.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/picture/detail/canvas.h"

namespace mien {
namespace {

using Eigen::Vector2d;

constexpr Color ground{0.97f, 0.97f, 0.965f}, track{0.86f, 0.87f, 0.88f}, edge{0.72f, 0.73f, 0.75f},
    label_ink{0.16f, 0.17f, 0.19f}, pale{0.45f, 0.47f, 0.5f}, right_side{0.78f, 0.34f, 0.26f},
    left_side{0.2f, 0.45f, 0.75f}, middle{0.32f, 0.52f, 0.36f};

/// How far a full turn of a joint's mark goes: this many radians.
constexpr double widest_turn = 1;

class PanelPainter {
 public:
  PanelPainter(const Character& character, const RigPose& pose, double row, Picture& picture)
      : character_(character), pose_(pose), row_(row), canvas_(picture) {}
  void run();

 private:
  Vector2d at(const Vector2d& rows) const { return row_ * (rows + Vector2d(1, 0.6)); }
  bool heads_region(const Control& control) const;
  void draw_headings();
  void draw_slider(const Control& control);
  void draw_pad(const Control& control);
  void draw_joint(const Control& control);
  void label(const Control& control, double x, double y, double width);
  Color color_of(const Control& control) const;
  double value_of(int slider) const { return slider < 0 ? 0 : pose_.sliders.values[slider]; }

  const Character& character_;
  const RigPose& pose_;
  double row_;
  detail::Canvas canvas_;
};

/// Sides as on the panel: red for what lies left of its mirror, blue for what lies right.
Color PanelPainter::color_of(const Control& control) const {
  if (control.mirror < 0) return middle;
  const double other = character_.controls[static_cast<std::size_t>(control.mirror)].position.x();
  if (control.position.x() == other) return middle;
  return control.position.x() < other ? right_side : left_side;
}

void PanelPainter::label(const Control& control, double x, double y, double width) {
  const detail::TextStyle style{0.56 * row_, label_ink};
  canvas_.text(canvas_.fitted(control.label.empty() ? control.name : control.label, width, style), {x, y},
               style);
}

/// Whether nothing of its region lies above it or close to its left: the region's name goes over it.
bool PanelPainter::heads_region(const Control& control) const {
  constexpr double close = 0.75;  // rows; columns lie farther apart
  return std::none_of(character_.controls.begin(), character_.controls.end(), [&](const Control& other) {
    if (&other == &control || other.region != control.region) return false;
    const double right = other.position.x() + other.size.x();
    const bool above = other.position.y() < control.position.y() &&
                       other.position.x() < control.position.x() + control.size.x() &&
                       control.position.x() < right;
    const bool beside = other.position.y() == control.position.y() &&
                        other.position.x() < control.position.x() && control.position.x() - right < close;
    return above || beside;
  });
}

void PanelPainter::draw_headings() {
  const detail::TextStyle style{0.62 * row_, pale, detail::Align::left, true};
  for (const Control& control : character_.controls)
    if (heads_region(control))
      canvas_.text(control.region, at(control.position) - Vector2d(0, 0.35 * row_), style);
}

void PanelPainter::draw_slider(const Control& control) {
  const Slider& slider = character_.sliders[static_cast<std::size_t>(control.sliders[0])];
  const Vector2d corner = at(control.position), size = row_ * control.size;
  const double name_width = 0.6 * size.x(), x = corner.x() + name_width, width = size.x() - name_width;
  label(control, corner.x(), corner.y() + 0.7 * size.y(), name_width - 0.3 * row_);
  const double middle_y = corner.y() + 0.5 * size.y(), thick = 0.22 * row_;
  const auto place = [&](double value) {
    const double share = (value - slider.minimum) / (slider.maximum - slider.minimum);
    return x + width * std::clamp(share, 0.0, 1.0);
  };
  canvas_.fill(x, middle_y - thick / 2, width, thick, track);
  const double zero = place(0), value = place(value_of(control.sliders[0]));
  canvas_.fill(std::min(zero, value), middle_y - thick / 2, std::abs(value - zero), thick, color_of(control),
               0.55);
  canvas_.fill(zero - 0.5, middle_y - 0.28 * row_, 1, 0.56 * row_, edge);
  canvas_.dot({value, middle_y}, 0.24 * row_, color_of(control));
}

void PanelPainter::draw_pad(const Control& control) {
  const Vector2d corner = at(control.position), size = row_ * control.size;
  const double side = std::min(size.x(), size.y() - row_), x = corner.x(), y = corner.y() + row_;
  label(control, x, corner.y() + 0.7 * row_, size.x());
  canvas_.fill(x, y, side, side, track);
  canvas_.outline(x, y, side, side, edge);
  canvas_.line({{x, y + side / 2}, {x + side, y + side / 2}}, 1, edge);
  canvas_.line({{x + side / 2, y}, {x + side / 2, y + side}}, 1, edge);
  const auto share = [&](std::size_t direction) {
    const int slider = control.sliders[direction];
    if (slider < 0) return 0.;
    const double most = character_.sliders[static_cast<std::size_t>(slider)].maximum;
    return std::clamp(most > 0 ? value_of(slider) / most : 0.0, 0.0, 1.0);
  };
  const Vector2d ends[] = {
      {x + side, y + side / 2}, {x, y + side / 2}, {x + side / 2, y}, {x + side / 2, y + side}};
  for (std::size_t d = 0; d < 4; ++d)
    if (control.sliders[d] >= 0) canvas_.dot(ends[d], 0.1 * row_, pale);
  canvas_.dot({x + side / 2 * (1 + share(0) - share(1)), y + side / 2 * (1 - share(2) + share(3))},
              0.26 * row_, color_of(control));
}

void PanelPainter::draw_joint(const Control& control) {
  const Vector2d corner = at(control.position), size = row_ * control.size;
  const double name_width = 0.6 * size.x(), width = size.x() - name_width, gap = 0.2 * row_;
  label(control, corner.x(), corner.y() + 0.7 * size.y(), name_width - 0.3 * row_);
  const auto node = static_cast<std::size_t>(control.node);
  const Eigen::AngleAxisd turn(character_.nodes[node].rest.rotation.conjugate() *
                               pose_.locals[node].rotation);
  const double angle = turn.angle() > EIGEN_PI ? turn.angle() - 2 * EIGEN_PI : turn.angle();
  const double box = (width - 2 * gap) / 3, height = 0.6 * row_;
  for (int a = 0; a < 3; ++a) {
    const double x = corner.x() + name_width + a * (box + gap), y = corner.y() + (size.y() - height) / 2;
    canvas_.fill(x, y, box, height, track);
    if (control.moves) canvas_.outline(x, y, box, height, edge);
    const double share = std::clamp(angle * turn.axis()[a] / widest_turn, -1.0, 1.0);
    canvas_.fill(x + box / 2 * (1 + share) - 1, y, 2, height, color_of(control));
  }
}

void PanelPainter::run() {
  draw_headings();
  for (const Control& control : character_.controls) {
    if (control.kind == Control::Kind::slider) draw_slider(control);
    if (control.kind == Control::Kind::pad) draw_pad(control);
    if (control.kind == Control::Kind::joint) draw_joint(control);
  }
  canvas_.finish();
}

void check(const Character& character, const RigPose& pose) {
  if (character.controls.empty())
    throw invalid_input("character", "has no controls", "make them with `mien controls`");
  const std::vector<Problem> problems = control_problems(character);
  if (!problems.empty()) throw problems.front().error();
  if (pose.sliders.values.size() != static_cast<Eigen::Index>(character.sliders.size()) ||
      pose.locals.size() != character.nodes.size())
    throw invalid_input("pose", "is of another character", "one value a slider and one transform a node");
}

}  // namespace

Picture draw_panel(const Character& character, const RigPose& pose, const PanelOptions& options) {
  check(character, pose);
  Vector2d corner = Vector2d::Zero();
  for (const Control& control : character.controls) corner = corner.cwiseMax(control.position + control.size);
  const Vector2d pixels = options.row * (corner + Vector2d(2, 1.2));
  if (!(pixels.maxCoeff() <= max_picture_side))
    throw invalid_input("panel", "is larger than a picture may be", "fewer pixels a row, or another layout");
  Picture picture = blank_picture(static_cast<int>(pixels.x()), static_cast<int>(pixels.y()), ground);
  PanelPainter(character, pose, options.row, picture).run();
  return picture;
}

}  // namespace mien
