// The reference form: every step in double, one part after the other, nothing precomputed. Rounded to float
// once, at the end.
#include "mien/evaluate/evaluate.h"

#include <optional>
#include <string>

#include "mien/core/error.h"
#include "mien/deform/influence.h"
#include "mien/deform/shapes.h"
#include "mien/deform/skin.h"
#include "mien/deform/wires.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/check_pose.h"

namespace mien {
namespace {

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
    return part.skin_weights.empty() ? positions
                                     : skin_points(positions, part.skin_weights, character.skins[part.skin],
                                                   joint_matrices(character.skins[part.skin], model));
  if (part.node >= static_cast<int>(model.size()))
    throw invalid_input("part " + part.name, "names node " + std::to_string(part.node), "a node that exists");
  return part.node >= 0 ? carry(positions, model[part.node]) : positions;
}

/// Where the nodes rest: constraints may act there too.
std::vector<Eigen::Matrix4d> rest_matrices(const Character& character) {
  return character.constraints.empty() ? std::vector<Eigen::Matrix4d>()
                                       : posed_matrices(character, rest_pose(character));
}

}  // namespace

std::vector<Points> evaluate(const Character& character, const Pose& pose) {
  detail::check_pose(character, pose);
  const std::vector<Eigen::Matrix4d> model = posed_matrices(character, pose);
  std::optional<WireField> wires;
  if (!pose.wires.empty()) wires.emplace(character, character.wires);
  std::optional<InfluenceField> objects;
  if (!character.objects.empty() || !pose.objects.empty())
    objects.emplace(character, rest_matrices(character));
  ShapeWeights weights(character.shapes.size());
  std::vector<Points> posed;
  posed.reserve(character.parts.size());
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    detail::weights_on_part(pose, part, weights.values);
    PointsD shaped = add_shapes(character, part, weights);
    if (wires) wires->add(part, pose.wires, shaped);
    if (objects) objects->add(part, objects->pose(model, weights, pose.objects), shaped);
    posed.push_back(to_model_space(character, character.parts[p], shaped, model).cast<float>());
  }
  return posed;
}

}  // namespace mien
