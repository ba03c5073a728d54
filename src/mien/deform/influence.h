#pragma once
/// Influence objects on parts: what joints, nodes, shapes and an animator do to them, and what they do to the skin.

#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// x -> linear x + origin: the upper three rows of an affine matrix.
using Motion = Eigen::Matrix<double, 3, 4>;

/// One object in one pose, in model space, bind pose.
struct ObjectPose {
  bool moves = false;             ///< false: it rests, and the rest of this says nothing
  std::vector<Motion> motions;    ///< #C: what joints and node do to each control point
  PointsD displacements;          ///< #C: where each control point is, less where it was bound
  Motion frame = Motion::Zero();  ///< of a cluster or locator: where it takes a point bound to it
  std::vector<Motion>
      joints;  ///< by joint of the object's skin, where one moves: its motion as the object sees it
};

/// The influence objects of a character, compiled. All count in the bind pose, on the shaped vertex x, before the skin moves it:
///   control points  c' = N sum_j w_j J_j (c + d): moved by shapes and animator (d), then by the joints with the object's skin
///                   weights, then by its node
///   skin            x' = x + sum over objects of weight (sum of coefficient (c' - c)), or of weight (F x - x) for a cluster or
///                   locator, F x = N sum_j w_j J_j (x + d) of its one point
/// Joints and node count as motion since rest, seen from the carrier: with A_n = model(n) rest_model(n)^-1, Q = A_carrier^-1 A_n. So
/// what turns with the carrier stays, and the skin that follows the carrier takes object and vertex along. A skin whose bind pose is
/// not the rest pose takes a bound point x to R x at rest, R = rest_model(carrier) inverse_bind(carrier): then Q acts as R^-1 Q R. A
/// character at rest therefore rests, bit for bit, whatever its bind pose.
/// Everything is linear in the displacements d, and objects add up in any order.
class InfluenceField {
 public:
  ///   rest    #N, node space to model space at rest; none: the nodes' own rest. A character whose constraints act at rest has
  ///           another one: motion is counted from that
  ///   throws  invalid_input: what object_problems finds; nodes in a circle; another number of matrices
  ///   cost    linear in objects and bindings
  explicit InfluenceField(const Character& character, std::vector<Eigen::Matrix4d> rest = {});

  /// What each object does.
  ///   model    #N, node space to model space, in the pose
  ///   weights  #S, of the shapes, which move objects in proportion
  ///   moves    what the pose adds
  ///   throws   invalid_input: another number of matrices or weights, weights that are not finite, a move of an object out of range,
  ///            with another number of control points than the object's or not finite
  ///   cost     0.1 us an influence of a control point that moves
  std::vector<ObjectPose> pose(const std::vector<Eigen::Matrix4d>& model, const ShapeWeights& weights,
                               std::span<const ObjectMove> moves) const;

  /// The same into `poses`, without allocation once these have been through all objects.
  void pose(const std::vector<Eigen::Matrix4d>& model, const ShapeWeights& weights,
            std::span<const ObjectMove> moves, std::vector<ObjectPose>& poses) const;

  /// Adds what the objects do to `positions` (#V x 3, part space) of one part. Objects that rest change nothing, bit for bit.
  ///   throws  invalid_input: a part out of range, another number of objects than the character's, fewer positions than are bound
  ///   cost    about 10 ns an entry
  void add(int part, std::span<const ObjectPose> poses, PointsD& positions) const;

  /// Where an object's control points are in the posed character, #C x 3 in model space: displaced, and carried as the skin on its
  /// carrier is. For pictures and manipulators; a pose that rests gives them as bound.
  PointsD place(int object, const ObjectPose& pose, const std::vector<Eigen::Matrix4d>& model) const;

  int object_count() const { return static_cast<int>(objects_.size()); }
  /// Part `part`'s space to model space, as objects see it, and model space vectors back to its own space.
  const Motion& to_model(int part) const { return to_model_[part]; }
  const Eigen::Matrix3d& to_part(int part) const { return to_part_[part]; }

  /// The motion of a node since rest as this object sees it: R^-1 A_carrier^-1 A_node R. The identity for node -1, where neither has
  /// moved, and where the carrier is scaled to nothing.
  ///   throws  invalid_input: as `pose`; an object or node out of range
  Motion motion_of(int object, int node, const std::vector<Eigen::Matrix4d>& model) const;

 private:
  struct Bound {
    int object = 0;
    InfluenceBinding binding;
  };
  void move_by(const ObjectMove& move, double share, std::vector<ObjectPose>& poses) const;
  bool set_motions(int object, const std::vector<Eigen::Matrix4d>& model, ObjectPose& pose) const;
  void set_displacements(int object, bool is_carried, ObjectPose& pose) const;
  bool has_moved(int node, const std::vector<Eigen::Matrix4d>& model) const;

  struct Object {
    std::string name;
    bool is_frame = false;
    int carrier = -1, node = -1;
    PointsD controls;
    std::vector<int> joints;  ///< nodes
    SkinWeights skin_weights;
    bool rest_is_bind = true;
    Eigen::Matrix4d to_rest = Eigen::Matrix4d::Identity();  ///< R
  };
  std::vector<Object> objects_;
  std::vector<std::vector<ObjectMove>> shapes_;  ///< by shape
  std::vector<Eigen::Matrix4d> rest_;            ///< #N
  std::vector<std::vector<Bound>> parts_;
  std::vector<Motion> to_model_;          ///< per part: its space to model space, as bound
  std::vector<Eigen::Matrix3d> to_part_;  ///< per part: model space vectors to its own space
};

}  // namespace mien
