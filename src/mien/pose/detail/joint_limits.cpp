#include "mien/pose/detail/joint_limits.h"

#include <algorithm>

namespace mien::detail {
namespace {

void narrow(const Constraint& limit, const std::array<ValueRange, 3>& ranges, Eigen::Vector3d& low,
            Eigen::Vector3d& high) {
  for (int a = 0; a < 3; ++a) {
    const ValueRange& range = ranges[static_cast<std::size_t>(a)];
    if (!limit.axes[static_cast<std::size_t>(a)] || !(range.low <= range.high)) continue;
    low[a] = std::clamp(low[a], range.low, range.high);
    high[a] = std::clamp(high[a], range.low, range.high);
  }
}

}  // namespace

std::vector<DraggedJoint> within_limits(const Character& character, std::vector<DraggedJoint> joints) {
  for (DraggedJoint& joint : joints)
    for (const Constraint& constraint : character.constraints) {
      const bool holds = constraint.kind == Constraint::Kind::limit && constraint.node == joint.node &&
                         constraint.relative && constraint.influence == 1;
      if (!holds) continue;
      narrow(constraint, constraint.rotation, joint.turn_low, joint.turn_high);
      narrow(constraint, constraint.translation, joint.shift_low, joint.shift_high);
    }
  return joints;
}

}  // namespace mien::detail
