// The reference form: every step in double, one part after the other, nothing precomputed. Rounded to float
// once, at the end.
#include "mien/evaluate/evaluate.h"

#include <cmath>
#include <string>

#include "mien/core/error.h"
#include "mien/deform/shapes.h"
#include "mien/deform/skin.h"

namespace mien {
namespace {

void check_pose(const Character& character, const Pose& pose) {
  for (std::size_t n = 0; n < pose.locals.size() && n < character.nodes.size(); ++n) {
    const Transform& local = pose.locals[n];
    if (!local.translation.allFinite() || !local.rotation.coeffs().allFinite() || !local.scale.allFinite())
      throw invalid_input("pose of node " + character.nodes[n].name, "is not finite", "finite numbers");
  }
  for (const PartShapeWeight& exception : pose.part_shape_weights)
    if (exception.shape < 0 || exception.shape >= static_cast<int>(character.shapes.size()))
      throw invalid_input(
          "pose", "weighs shape " + std::to_string(exception.shape),
          "a shape from 0 to " + std::to_string(static_cast<int>(character.shapes.size()) - 1));
}

ShapeWeights weights_on_part(const Pose& pose, int part) {
  ShapeWeights weights = pose.shape_weights;
  for (const PartShapeWeight& exception : pose.part_shape_weights)
    if (exception.part == part && exception.shape < weights.values.size())
      weights.values[exception.shape] = exception.value;
  return weights;
}

PointsD carry(const PointsD& positions, const Eigen::Matrix4d& matrix) {
  PointsD moved = positions * matrix.topLeftCorner<3, 3>().transpose();
  moved.rowwise() += matrix.topRightCorner<3, 1>().transpose();
  return moved;
}

PointsD to_model_space(const Character& character, const Part& part, const PointsD& positions,
                       const std::vector<Eigen::Matrix4d>& model) {
  if (part.skin >= static_cast<int>(character.skins.size()))
    throw invalid_input("part " + part.name, "names skin " + std::to_string(part.skin), "a skin that exists");
  if (part.skin >= 0)
    return part.skin_weights.empty()
               ? positions
               : skin_linear(positions, part.skin_weights, joint_matrices(character.skins[part.skin], model));
  if (part.node >= static_cast<int>(model.size()))
    throw invalid_input("part " + part.name, "names node " + std::to_string(part.node), "a node that exists");
  return part.node >= 0 ? carry(positions, model[part.node]) : positions;
}

}  // namespace

std::vector<Points> evaluate(const Character& character, const Pose& pose) {
  check_pose(character, pose);
  const std::vector<Eigen::Matrix4d> model = model_matrices(character, pose);
  std::vector<Points> posed;
  posed.reserve(character.parts.size());
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    const PointsD shaped = add_shapes(character, part, weights_on_part(pose, part));
    posed.push_back(to_model_space(character, character.parts[p], shaped, model).cast<float>());
  }
  return posed;
}

}  // namespace mien
