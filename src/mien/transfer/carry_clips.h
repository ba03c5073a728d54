#pragma once
/// Animation from one rig to another (thesis 4.7.2 and 4.8): every channel's values adapted to the target's volume.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "mien/transfer/carry_skeleton.h"

namespace mien {

/// How the motion of one node is carried.
struct NodeMotion {
  int node = -1;       ///< in the target, -1: left out
  Transform from, to;  ///< at rest, source and target
  double growth = 1;   ///< how much longer translations become
  /// Turns the source's parent frame into the target's, and the node's own frame at rest.
  Eigen::Quaterniond parent_turn = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond own_turn = Eigen::Quaterniond::Identity();
};

/// How everything that a clip can move is carried. An index of -1 leaves its channels out.
struct ClipMap {
  std::vector<NodeMotion> nodes;                             ///< per source node
  std::vector<int> shape_of, slider_of, wire_of, object_of;  ///< per source element its index in the target
  /// Displacements of control points at places of the source, as RigMap::move; not asked without wires and objects.
  std::function<PointsD(const PointsD& at, const PointsD& moves)> move;
  std::function<Eigen::Matrix3d(const Eigen::Vector3d&)> rotation;  ///< how directions turn there
};

/// The nodes' part for a skeleton that `carry_skeleton` placed.
std::vector<NodeMotion> node_motions(const Character& source, const CarriedSkeleton& skeleton);

/// One clip in the target's terms. Translations relative to rest grow by `growth` and turn with the parent, rotations act from the
/// new rest, scales stay factors of the rest's; shape weights, sliders and wire scales stay; control points of wires and objects
/// move by `move`, wire turns turn with the face. Keys and interpolation stay; tangents are carried as what they are, rates.
///   dropped  receives one line a channel that is left out
///   cost     linear in the values
Clip carry_clip(const Character& source, const Clip& clip, const ClipMap& map,
                std::vector<std::string>& dropped);

/// What two rigs differ in, one line a difference, empty when a clip of one plays on the other: joints by name and parent,
/// shapes, sliders, wires, influence objects and controls by name, kind and number of control points (thesis 4.8: the structure is
/// checked first).
std::vector<std::string> rig_differences(const Character& a, const Character& b);

}  // namespace mien
