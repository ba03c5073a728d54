#include "mien/controls/detail/lay_out.h"

#include <algorithm>
#include <set>
#include <string>

namespace mien::detail {
namespace {

constexpr double pad_size = 4, pad_gap = 0.4;  // rows; a pad has its label in one row above its square
constexpr double region_gap = 0.6, column_gap = 1;

/// Fills columns from the top; what does not fit below goes on beside.
class Filler {
 public:
  explicit Filler(const ControlLayout& layout) : layout_(layout) {}

  void start_column() {
    if (y_ > 0) {
      x_ += layout_.width + column_gap;
      y_ = 0;
    }
  }
  void start_region(double first_height) {
    if (y_ > 0) y_ += region_gap;
    if (y_ + heading_rows + first_height > layout_.rows) start_column();
    y_ += heading_rows;
  }
  /// A run of controls in rows of `size`, `gap` apart.
  void place(const std::vector<Control*>& run, const Eigen::Vector2d& size, double gap) {
    double x = 0;
    for (Control* control : run) {
      if (x > 0 && x + size.x() > layout_.width) next_row(size.y() + gap, x);
      if (x == 0 && y_ + size.y() > layout_.rows && y_ > heading_rows) {
        start_column();
        y_ = heading_rows;  // level with the other columns' controls
      }
      control->position = {x_ + x, y_};
      control->size = size;
      x += size.x() + gap;
    }
    if (x > 0) y_ += size.y() + gap;
  }

 private:
  void next_row(double height, double& x) {
    y_ += height;
    x = 0;
  }
  const ControlLayout& layout_;
  double x_ = 0, y_ = 0;
};

std::vector<std::vector<std::string>> all_columns(const ControlConfig& config,
                                                  const std::vector<Control>& controls) {
  std::vector<std::vector<std::string>> columns = config.layout.columns;
  std::set<std::string> placed;
  for (const auto& column : columns) placed.insert(column.begin(), column.end());
  std::vector<std::string> rest;
  for (const Control& control : controls)
    if (placed.insert(control.region).second) rest.push_back(control.region);
  if (!rest.empty()) columns.push_back(rest);
  return columns;
}

}  // namespace

void lay_out(const ControlConfig& config, std::vector<Control>& controls) {
  Filler filler(config.layout);
  const double width = config.layout.width;
  for (const auto& column : all_columns(config, controls)) {
    filler.start_column();
    for (const std::string& region : column) {
      std::vector<Control*> pads, sliders, joints;
      for (Control& control : controls)
        if (control.region == region)
          (control.kind == Control::Kind::pad      ? pads
           : control.kind == Control::Kind::slider ? sliders
                                                   : joints)
              .push_back(&control);
      if (pads.empty() && sliders.empty() && joints.empty()) continue;
      const double pad = std::min(pad_size, (width - pad_gap) / 2);
      filler.start_region(pads.empty() ? 1 : pad + 1);
      filler.place(pads, {pad - pad_gap / 2, pad - pad_gap / 2 + 1}, pad_gap);
      filler.place(sliders, {width, 1}, 0);
      filler.place(joints, {width, 1}, 0);
    }
  }
}

}  // namespace mien::detail
