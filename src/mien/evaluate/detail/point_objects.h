#pragma once
/// What influence objects do to the sites of a PointEvaluator, and the slopes of it.

#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/object_motion.h"
#include "mien/evaluate/detail/point_sites.h"

namespace mien::detail {

/// What a shape does to an object.
struct ShapeMove {
  int shape = 0;
  ObjectMove move;
};

/// What objects do in one pose, by part: each part has shape weights of its own.
using PartMotions = std::vector<ObjectMotion>;

/// With x0 what shapes and wires make of a site, objects make x = A x0 + b of it, in the part's space.
class PointObjects {
 public:
  /// Keeps a reference to `sites`.
  ///   throws  invalid_input: as ObjectRows
  PointObjects(const Character& character, const ConstraintSolver& constraints, const PointSites& sites);

  bool act(const Pose& pose) const { return !layout_.empty() || !pose.objects.empty(); }
  bool are_moved_by(int node) const { return layout_.is_moved_by(node); }
  static bool reach(const Site& site) { return site.object_begin != site.object_end; }
  const std::vector<ShapeMove>& shape_moves() const { return shape_moves_; }  ///< ascending by shape
  PartMotions none() const { return PartMotions(sites_.parts.size()); }

  /// What they do while the nodes stand as `locals` says.
  ///   weights  #S x parts
  ///   throws   invalid_input: as InfluenceField::pose
  void move(const std::vector<Transform>& locals, const Eigen::MatrixXd& weights,
            std::span<const ObjectMove> moves, PartMotions& motions);

  /// x - x0.
  Eigen::Vector3d shift(const Site& site, const Eigen::Vector3d& bare, const PartMotions& motions) const;
  /// A: more than the identity where a frame turns the site.
  Eigen::Matrix3d turn(const Site& site, const PartMotions& motions) const;
  /// How x follows control points as `move` moves them.
  Eigen::Vector3d slope(const Site& site, const ObjectMove& move, const PartMotions& motions) const;

 private:
  const PointSites& sites_;
  ObjectRows layout_;
  std::vector<ShapeMove> shape_moves_;
  ShapeWeights weights_;  // of one part
};

}  // namespace mien::detail
