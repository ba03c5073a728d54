#pragma once
/// A character at rest and in each shape.

#include <vector>

#include "mien/character/pose.h"
#include "mien/evaluate/evaluate.h"

namespace mien::detail {

inline std::vector<Points> at_rest(const Character& character) {
  return evaluate(character, rest_pose(character));
}

inline std::vector<Points> in_shape(const Character& character, std::size_t shape) {
  Pose pose = rest_pose(character);
  pose.shape_weights.values.setZero();
  pose.shape_weights.values[static_cast<Eigen::Index>(shape)] = 1;
  return evaluate(character, pose);
}

}  // namespace mien::detail
