#pragma once
/// Joints and their bind poses, placed in the target by a map of space.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// What the skeleton is carried by.
struct SpaceMap {
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)>
      position;  ///< source model space to target model space
  std::function<Eigen::Matrix3d(const Eigen::Vector3d&)> rotation;  ///< how directions turn there
  std::function<double(const Eigen::Vector3d&)> scale;              ///< how lengths grow there
};

/// All skins' joints in one list.
struct JointList {
  std::vector<int> nodes;                    ///< #J source nodes
  std::vector<std::vector<int>> skin_joint;  ///< per source skin, per joint: index into `nodes`
  std::vector<int> joint_of_node;            ///< per source node: index into `nodes`, -1: not a joint
};
/// Skins in order, then joints that hold parts without a skin.
JointList list_joints(const Character& source);

struct CarriedSkeleton {
  std::vector<Node> nodes;     ///< to be appended to the target's nodes; parents count from `first_node`
  std::vector<int> node_of;    ///< per source node: its index in the target, -1: not carried
  Skin skin;                   ///< all source joints, inverse bind matrices for the target's model space
  std::vector<double> growth;  ///< per source node: how much longer its translations become
};

/// Places every joint of every skin, their ancestors and the nodes that hold no part. Hierarchy, names and local
/// rotations stay (thesis 4.7.2 and the errata: positions by the map, orientations by its rotation); lengths between
/// joints follow the positions. Parts that hang below a joint without a skin make that joint part of the skin.
///   first_node  the number of nodes that the target keeps of its own
///   throws      invalid_input: cyclic nodes; a bind matrix that cannot be inverted (names skin and joint)
CarriedSkeleton carry_skeleton(const Character& source, const SpaceMap& map, int first_node);

/// The nearest joint at or above the node that holds a part without a skin, or -1.
int holding_joint(const Character& source, const Part& part);

}  // namespace mien
