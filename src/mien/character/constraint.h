#pragma once
/// Constraints: what nodes must obey after they are posed. Data only; evaluate applies them.

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace mien {

/// A node that others follow, and how much of it.
struct ConstraintSource {
  int node = 0;      ///< index into Character::nodes
  double share = 1;  ///< >= 0; relative to the other sources' shares
  bool operator==(const ConstraintSource&) const = default;
};

struct ValueRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool operator==(const ValueRange&) const = default;
};

/// One relation or limit on a node. Constraints are applied in their order, each on what the ones before it left.
struct Constraint {
  enum class Kind {
    limit,   ///< keep translation, rotation and scale within ranges
    parent,  ///< follow position and orientation of the sources as their child would
    point,   ///< follow their position
    orient,  ///< follow their orientation
    scale,   ///< follow their scale
    aim,     ///< turn `aim_axis` towards them
  };
  std::string name;  ///< unique
  Kind kind = Kind::limit;
  int node = 0;                           ///< the node that obeys
  std::vector<ConstraintSource> sources;  ///< none for a limit, one or more otherwise
  /// Relations: true keeps what lies between node and sources at rest, false gives the node the sources' own value. Limits: true
  /// counts from the node's rest, false from its parent's frame.
  bool relative = true;
  std::array<bool, 3> axes{true, true,
                           true};  ///< x, y, z of the node's parent frame that obey (not for parent and aim)
  double influence = 1;            ///< [0, 1]: how far the node obeys
  std::array<ValueRange, 3> translation, rotation, scale;  ///< limits; rotation as x, then y, then z, radians
  Eigen::Vector3d aim_axis = Eigen::Vector3d::UnitZ();     ///< unit, the node's own frame
  Eigen::Vector3d up_axis = Eigen::Vector3d::UnitY();      ///< unit, not along aim_axis, the node's own frame
  Eigen::Vector3d up =
      Eigen::Vector3d::UnitY();  ///< where up_axis points, model space, when there is no up_node
  int up_node = -1;              ///< towards this node instead
};

}  // namespace mien
