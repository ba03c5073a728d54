#pragma once
/// A pose: slider values or shape weights, and local joint transforms, at one instant.

#include <vector>

#include "mien/character/character.h"

namespace mien {

/// Shape weights by Character::shapes; 1 is the sculpted shape.
struct ShapeWeights {
  Eigen::VectorXd values;
  explicit ShapeWeights(Eigen::VectorXd v) : values(std::move(v)) {}
  explicit ShapeWeights(std::size_t count)
      : values(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count))) {}
};

/// Slider values by Character::sliders; sliders.h turns them into shape weights.
struct SliderValues {
  Eigen::VectorXd values;
  explicit SliderValues(Eigen::VectorXd v) : values(std::move(v)) {}
  explicit SliderValues(std::size_t count)
      : values(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count))) {}
};

/// What an animator sets.
struct RigPose {
  SliderValues sliders;                  ///< #sliders
  std::vector<Transform> locals;         ///< #N, local transforms of Character::nodes
  std::vector<WireMove> wires = {};      ///< what wires do besides the shapes; several moves of a wire add up
  std::vector<ObjectMove> objects = {};  ///< what influence objects do besides the shapes
};

/// A shape weight on one part alone, in place of the pose's own.
struct PartShapeWeight {
  int part = 0, shape = 0;
  double value = 0;
};

/// What the deformers take.
struct Pose {
  ShapeWeights shape_weights;     ///< #S
  std::vector<Transform> locals;  ///< #N, local transforms of Character::nodes
  std::vector<PartShapeWeight> part_shape_weights =
      {};                                ///< exceptions: a clip may animate one part's shape alone
  std::vector<WireMove> wires = {};      ///< what wires do besides the shapes; several moves of a wire add up
  std::vector<ObjectMove> objects = {};  ///< what influence objects do besides the shapes; they add up too
};

/// The pose when nothing is animated: sliders and nodes at rest.
Pose rest_pose(const Character& character);

/// The node's local matrix when its local transform is `local`: the matrix that its file gave (it may shear) while
/// `local` is its rest, otherwise the transform's.
Eigen::Matrix4d local_matrix(const Node& node, const Transform& local);

/// #N matrices, node space to model space, in `pose`; its constraints are obeyed before. A node at rest keeps the
/// matrix that its file gave (it may shear).
///   throws  invalid_input: a number of locals other than #N; cyclic parents
std::vector<Eigen::Matrix4d> model_matrices(const Character& character, const Pose& pose);

}  // namespace mien
