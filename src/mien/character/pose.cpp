#include "mien/character/pose.h"

namespace mien {

Pose rest_pose(const Character& character) {
  Pose pose{ShapeWeights(character.shapes.size()), {}};
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    pose.shape_weights.values[static_cast<Eigen::Index>(s)] = character.shapes[s].rest;
  pose.locals.reserve(character.nodes.size());
  for (const Node& node : character.nodes) pose.locals.push_back(node.rest);
  return pose;
}

}  // namespace mien
