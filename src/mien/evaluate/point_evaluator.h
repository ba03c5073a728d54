#pragma once
/// A few surface points of a character, compiled for many poses: where they are, and how they move with shape weights
/// and joints. What a solver or a pin needs of the whole evaluation.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// How one node may move: turned about its own axes (R -> R exp([w]x), w in radians), or shifted along its parent's.
struct JointFreedom {
  int node = 0;
  bool rotation = true;
  bool translation = false;
};

/// What a Jacobian is taken by. Its columns are the shapes or the sliders in this order (each once), then for each joint its three turns x, y, z
/// (if any) and its three shifts x, y, z (if any).
struct Freedoms {
  std::vector<int> shapes;   ///< of a Pose
  std::vector<int> sliders;  ///< of a RigPose
  std::vector<JointFreedom> joints;
  Eigen::Index column_count() const;
};

/// One thread at a time uses an evaluator: it holds working memory. After the first call with outputs of the right size
/// no call allocates. It keeps nothing of the character: the points of a character changed since are not followed.
class PointEvaluator {
 public:
  ///   points  #P, in any order and number
  ///   throws  invalid_input: a point on a part, face or vertex that does not exist, barycentric coordinates that are not
  ///           finite, a part that names a skin, joint or node out of range
  ///   cost    linear in the deltas of all shapes
  PointEvaluator(const Character& character, const std::vector<SurfacePoint>& points);
  ~PointEvaluator();
  PointEvaluator(PointEvaluator&&) noexcept;
  PointEvaluator& operator=(PointEvaluator&&) noexcept;

  std::size_t point_count() const;

  /// Where the points are: the same as `evaluate`, not rounded to float.
  ///   out     #P x 3, model space; resized
  ///   throws  invalid_input: as `evaluate` for the pose
  ///   cost    linear in the points' active deltas and influences, plus the joints above them
  void positions(const Pose& pose, PointsD& out);

  /// The points' derivatives at `pose`.
  ///   out     3 #P x columns; row 3 p + a is coordinate a of point p, columns as Freedoms says; resized
  ///   throws  invalid_input: as `evaluate` for the pose; a shape or node out of range
  ///   cost    as `positions`, times the joints of `freedoms`
  /// By the chain rule through the joints, exact wherever the evaluation is smooth; tests compare it with central
  /// differences. Where a character has constraints the slopes of its joints' matrices are central differences, right to about
  /// 1e-9; at a limit they are half of those within it. So are the slopes of what a joint does through an influence object. A node whose file gave a matrix that shears is differentiated as its translation, rotation and scale.
  /// A shape that the pose weighs on one part alone moves the other parts' points alone.
  void jacobian(const Pose& pose, const Freedoms& freedoms, Eigen::MatrixXd& out);

  /// The same by sliders, through their stops and correctives (shape_weights and shape_weight_slopes of sliders.h, whose
  /// results are allocated).
  ///   throws  invalid_input: freedoms that name shapes here, or sliders above
  void positions(const RigPose& rig, PointsD& out);
  void jacobian(const RigPose& rig, const Freedoms& freedoms, Eigen::MatrixXd& out);

  /// The derivatives by every shape weight. Skinning is affine in the shaped position: the rows are constant for any
  /// shape weights while the joints stay as in `pose`, and `positions` is their linear function.
  ///   out     3 #P x #S; resized
  void shape_rows(const Pose& pose, Eigen::MatrixXd& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mien
