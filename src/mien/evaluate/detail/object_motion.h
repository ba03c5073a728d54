#pragma once
/// What a pose's influence objects do, in memory that is kept.

#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"
#include "mien/deform/influence.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/joint_chain.h"

namespace mien::detail {

/// A character's influence objects, and the row of each control point among those of all objects.
class ObjectRows {
 public:
  ///   throws  invalid_input: as InfluenceField and JointChain
  ObjectRows(const Character& character, const ConstraintSolver& constraints);

  bool empty() const { return field_.object_count() == 0; }
  int object_count() const { return field_.object_count(); }
  int control_begin(int object) const { return control_begin_[object]; }
  int control_count(int object) const { return control_begin_[object + 1] - control_begin_[object]; }
  int row_count() const { return control_begin_.back(); }
  /// A cluster or locator, which moves what is bound to it as a rigid frame would.
  bool is_frame(int object) const { return is_frame_[object]; }
  const InfluenceField& field() const { return field_; }

  /// Whether turning or shifting this node moves an object relative to what carries it; with constraints any node may.
  bool is_moved_by(int node) const { return is_moved_by_[node]; }

  /// All nodes to model space. `carried` is working memory; `locals` obey the constraints.
  void place_nodes(const std::vector<Transform>& locals, std::vector<Affine>& links,
                   std::vector<Affine>& nodes, std::vector<Eigen::Matrix4d>& model) const;

 private:
  std::vector<Eigen::Matrix4d> rest_of(const Character& character, const ConstraintSolver& constraints) const;
  void find_movers(const Character& character, bool is_constrained);

  std::vector<Node> nodes_;
  JointChain chain_;  ///< carrier n is node n
  InfluenceField field_;
  std::vector<int> control_begin_{0};  ///< objects + 1
  std::vector<char> is_frame_, is_moved_by_;
};

class ObjectMotion {
 public:
  /// Where the nodes are. First of a pose.
  void place_nodes(const ObjectRows& layout, const std::vector<Transform>& locals) {
    layout.place_nodes(locals, links_, nodes_, model_);
  }
  /// What the objects do under these shape weights and moves.
  ///   throws  invalid_input: as InfluenceField::pose
  void set(const ObjectRows& layout, const ShapeWeights& weights, std::span<const ObjectMove> moves) {
    layout.field().pose(model_, weights, moves, poses_);
  }
  const std::vector<ObjectPose>& poses() const { return poses_; }

 private:
  std::vector<Affine> links_, nodes_;
  std::vector<Eigen::Matrix4d> model_;
  std::vector<ObjectPose> poses_;
};

}  // namespace mien::detail
