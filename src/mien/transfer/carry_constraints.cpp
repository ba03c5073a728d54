// Limits are the one part of a constraint with a length in it, and the one that is said along axes. Frames below a joint turn with
// the face; the frame of a node without a parent is model space and does not.
#include "mien/transfer/carry_constraints.h"

#include <algorithm>
#include <cmath>

#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

using Ranges = std::array<ValueRange, 3>;

/// Where the box of these ranges reaches along the axes after a rotation.
Ranges turned(const Ranges& ranges, const Eigen::Matrix3d& rotation) {
  Ranges result;
  for (int i = 0; i < 3; ++i) {
    double low = 0, high = 0;
    for (int j = 0; j < 3; ++j) {
      const double r = rotation(i, j);
      if (std::abs(r) < 1e-9) continue;  // an unlimited axis that has no share in this one
      const ValueRange& range = ranges[at(j)];
      low += r > 0 ? r * range.low : r * range.high;
      high += r > 0 ? r * range.high : r * range.low;
    }
    result[at(i)] = {low, high};
  }
  return result;
}

std::array<bool, 3> turned(const std::array<bool, 3>& axes, const Eigen::Matrix3d& rotation) {
  std::array<bool, 3> result{};
  for (int i = 0; i < 3; ++i) {
    Eigen::Index j = 0;
    rotation.row(i).cwiseAbs().maxCoeff(&j);
    result[at(i)] = axes[static_cast<std::size_t>(j)];
  }
  return result;
}

/// Translation ranges in the target's parent frame.
void carry_translation(const Node& from, const Node& to, double growth, const Eigen::Matrix3d& turn,
                       Constraint& constraint) {
  const auto shifted = [](Ranges ranges, const Eigen::Vector3d& by, double factor) {
    for (int k = 0; k < 3; ++k) {
      ValueRange& range = ranges[at(k)];
      range = {factor * range.low + by[k], factor * range.high + by[k]};
    }
    return ranges;
  };
  const bool absolute = !constraint.relative;
  Ranges ranges = constraint.translation;
  if (absolute) ranges = shifted(ranges, -from.rest.translation, 1);
  ranges = turned(shifted(ranges, Eigen::Vector3d::Zero(), growth), turn);
  if (absolute) ranges = shifted(ranges, to.rest.translation, 1);
  constraint.translation = ranges;
}

bool carry_references(const Character& source, const RigMap& map, Constraint& constraint,
                      std::vector<std::string>& dropped) {
  const auto node_of = [&](int node) {
    if (node >= 0 && map.node_of[at(node)] < 0)
      dropped.push_back("constraint " + constraint.name + ": node " + source.nodes[at(node)].name);
    return node < 0 ? -1 : map.node_of[at(node)];
  };
  const bool limit = constraint.kind == Constraint::Kind::limit;
  constraint.node = node_of(constraint.node);
  for (ConstraintSource& follow : constraint.sources) follow.node = node_of(follow.node);
  std::erase_if(constraint.sources, [](const ConstraintSource& follow) { return follow.node < 0; });
  constraint.up_node = node_of(constraint.up_node);
  return constraint.node >= 0 && (limit || !constraint.sources.empty());
}

}  // namespace

std::vector<Constraint> carry_constraints(const Character& source, const Character& target, const RigMap& map,
                                          std::vector<std::string>& dropped) {
  std::vector<Constraint> carried;
  const auto model = model_matrices(source);
  for (const Constraint& original : source.constraints) {
    Constraint constraint = original;
    if (!carry_references(source, map, constraint, dropped)) continue;
    const Node& from = source.nodes[at(original.node)];
    const Eigen::Vector3d place = model[at(original.node)].topRightCorner<3, 1>();
    const Eigen::Matrix3d rotation = map.space.rotation(place);
    const Eigen::Matrix3d turn = from.parent < 0 ? rotation : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    constraint.up = rotation * original.up;
    constraint.axes = turned(original.axes, turn);
    if (constraint.kind == Constraint::Kind::limit) {
      carry_translation(from, target.nodes[at(constraint.node)], map.space.scale(place), turn, constraint);
      if (!constraint.relative) constraint.rotation = turned(original.rotation, turn);
    }
    carried.push_back(std::move(constraint));
  }
  return carried;
}

std::vector<Control> carry_controls(const Character& source, const std::vector<int>& slider_of,
                                    const std::vector<int>& node_of, std::vector<std::string>& dropped) {
  std::vector<Control> carried;
  std::vector<int> index(source.controls.size(), -1);
  for (std::size_t c = 0; c < source.controls.size(); ++c) {
    Control control = source.controls[c];
    for (int& slider : control.sliders)
      if (slider >= 0) slider = slider_of[at(slider)];
    if (control.node >= 0) control.node = node_of[at(control.node)];
    const bool drives =
        control.kind == Control::Kind::joint
            ? control.node >= 0
            : std::any_of(control.sliders.begin(), control.sliders.end(), [](int s) { return s >= 0; });
    if (!drives) {
      dropped.push_back("control " + control.name);
      continue;
    }
    index[c] = static_cast<int>(carried.size());
    carried.push_back(std::move(control));
  }
  for (Control& control : carried)
    if (control.mirror >= 0) control.mirror = index[at(control.mirror)];
  return carried;
}

}  // namespace mien
