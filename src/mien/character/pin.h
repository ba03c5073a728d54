#pragma once
/// What a user takes hold of: points pulled to goals, and coordinates that are to stay. Data only.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// The directions along which a point is held, model space; free across them.
struct HeldAxes {
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();  ///< the first `count` rows, orthonormal
  int count = 3;                                             ///< 0 to 3
};

/// The axes named by their letters: "xyz", "y".
///   throws  invalid_input: no letter, another letter, one twice
HeldAxes held_axes(std::string_view letters);

/// All that lies in a plane: what a pointer can say when the camera looks along `normal`.
///   throws  invalid_input: a normal that is zero or not finite
HeldAxes held_in_plane(const Eigen::Vector3d& normal);

/// One direction alone.
///   throws  invalid_input: a direction that is zero or not finite
HeldAxes held_along(const Eigen::Vector3d& direction);

/// The origin of a joint.
struct JointPoint {
  int node = 0;  ///< index into Character::nodes
};

/// A point of the character and where it is wanted. The one being dragged and those that are held are the same thing.
struct Pin {
  std::variant<SurfacePoint, JointPoint> at = SurfacePoint{};
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();  ///< model space
  bool goal_is_move = false;  ///< `goal` counts from where the point is when the drag starts
  HeldAxes axes;
  double weight = 1;         ///< > 0; of the squared distance to the goal
  bool hard = false;         ///< to be met exactly, if the limits allow it
  std::vector<int> sliders;  ///< the only sliders that this pin moves (its region); empty: all
};

/// Coordinates of a surface point that attenuation keeps still.
struct Tag {
  SurfacePoint at;
  HeldAxes axes;
};

}  // namespace mien
