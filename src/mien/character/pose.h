#pragma once
/// A pose: shape weights and local joint transforms at one instant.

#include <vector>

#include "mien/character/character.h"

namespace mien {

/// Shape weights by Character::shapes; 1 is the sculpted shape.
struct ShapeWeights {
  Eigen::VectorXd values;
  explicit ShapeWeights(Eigen::VectorXd v) : values(std::move(v)) {}
  explicit ShapeWeights(std::size_t count) : values(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count))) {}
};

struct Pose {
  ShapeWeights shape_weights;      ///< #S
  std::vector<Transform> locals;   ///< #N, local transforms of Character::nodes
};

/// The pose when nothing is animated: shapes at rest, nodes at rest.
Pose rest_pose(const Character& character);

}  // namespace mien
