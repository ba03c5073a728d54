#include "mien/transfer/carry_constraints.h"

#include <algorithm>

#include "mien/geometry/similarity.h"

namespace mien {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Whether `node` was carried; its number becomes the target's.
bool carry_node(const CarriedSkeleton& skeleton, int& node) {
  node = skeleton.node_of[at(node)];
  return node >= 0;
}

/// The ranges of a limit, from what the node is at rest in the source to what it is in the target.
void carry_ranges(const Transform& from, const Transform& to, double growth, Constraint& limit) {
  const auto carry = [](ValueRange& range, double from_value, double factor, double to_value) {
    range.low = factor * (range.low - from_value) + to_value;
    range.high = factor * (range.high - from_value) + to_value;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    if (limit.relative) {
      carry(limit.translation[a], 0, growth, 0);
      continue;
    }
    carry(limit.translation[a], from.translation[axis], growth, to.translation[axis]);
    const double ratio = from.scale[axis] != 0 ? to.scale[axis] / from.scale[axis] : 1;
    if (ratio > 0) carry(limit.scale[a], 0, ratio, 0);
  }
}

/// How the node's rest turned from the one model space into the other.
Eigen::Matrix3d turn_of(const Character& source, int from, const Character& target, int to) {
  const Eigen::Matrix3d before = model_matrices(source)[at(from)].topLeftCorner<3, 3>();
  const Eigen::Matrix3d after = model_matrices(target)[at(to)].topLeftCorner<3, 3>();
  return closest_rotation(after) * closest_rotation(before).transpose();
}

bool carry_nodes(const CarriedSkeleton& skeleton, Constraint& constraint) {
  bool all = carry_node(skeleton, constraint.node);
  for (ConstraintSource& source : constraint.sources) all = carry_node(skeleton, source.node) && all;
  if (constraint.up_node >= 0) all = carry_node(skeleton, constraint.up_node) && all;
  return all;
}

}  // namespace

std::vector<Constraint> carry_constraints(const Character& source, const Character& target,
                                          const CarriedSkeleton& skeleton,
                                          std::vector<std::string>& dropped) {
  std::vector<Constraint> result;
  for (const Constraint& constraint : source.constraints) {
    Constraint carried = constraint;
    if (!carry_nodes(skeleton, carried)) {
      dropped.push_back("constraint " + constraint.name);
      continue;
    }
    if (constraint.kind == Constraint::Kind::limit)
      carry_ranges(source.nodes[at(constraint.node)].rest, target.nodes[at(carried.node)].rest,
                   skeleton.growth[at(constraint.node)], carried);
    if (constraint.kind == Constraint::Kind::aim && constraint.up_node < 0)
      carried.up = turn_of(source, constraint.node, target, carried.node) * constraint.up;
    result.push_back(std::move(carried));
  }
  return result;
}

std::vector<Control> carry_controls(const Character& source, const Character& target,
                                    const CarriedSkeleton& skeleton, std::vector<std::string>& dropped) {
  std::vector<Control> result;
  std::vector<int> index(source.controls.size(), -1);
  const bool has_sliders = target.sliders.size() == source.sliders.size();
  for (std::size_t c = 0; c < source.controls.size(); ++c) {
    Control carried = source.controls[c];
    const bool kept = carried.kind == Control::Kind::joint ? carry_node(skeleton, carried.node) : has_sliders;
    if (!kept) {
      dropped.push_back("control " + carried.name);
      continue;
    }
    index[c] = static_cast<int>(result.size());
    result.push_back(std::move(carried));
  }
  for (Control& control : result)
    if (control.mirror >= 0) control.mirror = index[at(control.mirror)];
  return result;
}

}  // namespace mien
