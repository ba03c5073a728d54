#include "mien/character/pose.h"

#include <string>

#include "mien/character/sliders.h"
#include "mien/core/error.h"

namespace mien {

Pose rest_pose(const Character& character) {
  return pose_of(character, rest_rig_pose(character));
}

namespace {

bool at_rest(const Transform& local, const Transform& rest) {
  return local.translation == rest.translation && local.rotation.coeffs() == rest.rotation.coeffs() &&
         local.scale == rest.scale;
}

}  // namespace

Eigen::Matrix4d local_matrix(const Node& node, const Transform& local) {
  return node.has_matrix && at_rest(local, node.rest) ? node.matrix : local.matrix();
}

std::vector<Eigen::Matrix4d> model_matrices(const Character& character, const Pose& pose) {
  if (pose.locals.size() != character.nodes.size())
    throw invalid_input("pose", "has " + std::to_string(pose.locals.size()) + " local transforms",
                        std::to_string(character.nodes.size()) + ", one a node");
  std::vector<Eigen::Matrix4d> locals;
  locals.reserve(character.nodes.size());
  for (std::size_t n = 0; n < character.nodes.size(); ++n)
    locals.push_back(local_matrix(character.nodes[n], pose.locals[n]));
  return model_matrices(character, locals);
}

}  // namespace mien
