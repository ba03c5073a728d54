#pragma once
/// Constraints at work: a pose's local transforms in, the local transforms that obey out.
///
/// Spaces: a relation is worked out in the parent frame of the node that obeys, so that moving everything together changes
/// nothing. `rest` below is Node::rest of all nodes.
///
///   limit   translation in the parent's axes, rotation as turns about x, then y, then z, scale by axis, each kept in its range.
///           Relative: translation less the rest's, turns about the node's own axes at rest, scale over the rest's.
///   parent  where a rigid child of the source would be that lies where the node lies at rest (absolute: at the source, turned as it
///           is). A scaled source carries its child with its scale, without scaling it.
///   point   rest translation + (source's position - source's position at rest), in the parent frame (absolute: the source's position).
///   orient  the source's turn since rest, then the rest rotation (absolute: the source's orientation). Single axes: as in a limit.
///   scale   rest scale x source's scale over its scale at rest (absolute: the source's), by axis; scales are lengths of model
///           space, so that a scaled parent is counted once.
///   aim     `aim_axis` exactly towards the sources' position, `up_axis` as near to up as it can be. Relative: turned by what lies
///           between that and the rest rotation at rest.
///
/// Orientation is the product of rotations up the hierarchy. Several sources: positions and scales are averaged by share, rotations
/// by the largest eigenvector of sum share q q' (Markley and others 2007, Averaging Quaternions), which no sign of q changes.
/// `influence` blends on a line, rotations on the short way. A node stays as it is when its parent is flat, when it is aimed at
/// its own position, and when a scale at rest or of its parent is 0 (on that axis). While the sources and the node's ancestors are at rest,
/// a relative relation gives the rest transform bit for bit.

#include <memory>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// A character's constraints, compiled for many poses. It keeps nothing of the character and may be shared by threads.
class ConstraintSolver {
 public:
  ///   throws  invalid_input: what `validate` finds wrong with the constraints; a source that is flat at rest (a scale of 0) and
  ///           has a child by a relative parent constraint
  ///   cost    linear in nodes
  explicit ConstraintSolver(const Character& character);

  bool empty() const;
  /// The nodes that constraints may move, ascending.
  const std::vector<int>& nodes() const;

  /// Applies the constraints in their order, each on what the ones before it left. Allocates nothing.
  ///   locals  #N finite local transforms
  ///   cost    for each constraint: sources x depth of the hierarchy
  void apply(std::vector<Transform>& locals) const;

 private:
  struct Compiled;
  std::shared_ptr<const Compiled> compiled_;
};

/// Turns about x, then y, then z, radians, of a rotation: of the two triples that give it the one nearer to none.
Eigen::Vector3d axis_turns(const Eigen::Quaterniond& rotation);
/// The rotation of these turns: Rz Ry Rx.
Eigen::Quaterniond rotation_of_turns(const Eigen::Vector3d& turns);

/// #N matrices, node space to model space, in `pose` as the character's constraints leave it: where every evaluation starts.
///   throws  invalid_input: a number of locals other than #N; cyclic parents; as ConstraintSolver
std::vector<Eigen::Matrix4d> posed_matrices(const Character& character, const Pose& pose);

}  // namespace mien
