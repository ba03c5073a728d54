#include "mien/evaluate/detail/check_pose.h"

#include <cmath>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

void check_locals(const Character& character, const Pose& pose) {
  if (pose.locals.size() != character.nodes.size())
    throw invalid_input("pose", "has " + std::to_string(pose.locals.size()) + " local transforms",
                        std::to_string(character.nodes.size()) + ", one a node");
  for (std::size_t n = 0; n < pose.locals.size(); ++n) {
    const Transform& local = pose.locals[n];
    if (!local.translation.allFinite() || !local.rotation.coeffs().allFinite() || !local.scale.allFinite())
      throw invalid_input("pose of node " + character.nodes[n].name, "is not finite", "finite numbers");
  }
}

void check_weights(const Character& character, const Pose& pose) {
  if (pose.shape_weights.values.size() != static_cast<Eigen::Index>(character.shapes.size()))
    throw invalid_input("shape weights", "number " + std::to_string(pose.shape_weights.values.size()),
                        std::to_string(character.shapes.size()) + ", one a shape");
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    if (!std::isfinite(pose.shape_weights.values[static_cast<Eigen::Index>(s)]))
      throw invalid_input("shape weight of " + character.shapes[s].name, "is not finite", "a finite number");
}

void check_exception(const Character& character, const PartShapeWeight& exception) {
  if (exception.shape < 0 || exception.shape >= static_cast<int>(character.shapes.size()))
    throw invalid_input("pose", "weighs shape " + std::to_string(exception.shape),
                        "a shape from 0 to " + std::to_string(static_cast<int>(character.shapes.size()) - 1));
  if (!std::isfinite(exception.value))
    throw invalid_input("shape weight of " + character.shapes[static_cast<std::size_t>(exception.shape)].name,
                        "is not finite", "a finite number");
}

}  // namespace

void check_pose(const Character& character, const Pose& pose) {
  check_locals(character, pose);
  check_weights(character, pose);
  for (const PartShapeWeight& exception : pose.part_shape_weights) check_exception(character, exception);
}

void weights_on_part(const Pose& pose, int part, Eigen::Ref<Eigen::VectorXd> weights) {
  weights = pose.shape_weights.values;
  for (const PartShapeWeight& exception : pose.part_shape_weights)
    if (exception.part == part) weights[exception.shape] = exception.value;
}

void check_freedoms(const Character& character, const Freedoms& freedoms) {
  for (const int shape : freedoms.shapes)
    if (shape < 0 || shape >= static_cast<int>(character.shapes.size()))
      throw invalid_input(
          "freedoms", "name shape " + std::to_string(shape),
          "a shape from 0 to " + std::to_string(static_cast<int>(character.shapes.size()) - 1));
  for (const int slider : freedoms.sliders)
    if (slider < 0 || slider >= static_cast<int>(character.sliders.size()))
      throw invalid_input(
          "freedoms", "name slider " + std::to_string(slider),
          "a slider from 0 to " + std::to_string(static_cast<int>(character.sliders.size()) - 1));
  for (const JointFreedom& joint : freedoms.joints)
    if (joint.node < 0 || joint.node >= static_cast<int>(character.nodes.size()))
      throw invalid_input("freedoms", "name node " + std::to_string(joint.node),
                          "a node from 0 to " + std::to_string(static_cast<int>(character.nodes.size()) - 1));
}

}  // namespace mien::detail
