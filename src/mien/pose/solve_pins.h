#pragma once
/// Direct manipulation: pull on points of the face, and the sliders follow (Lewis and Anjyo 2010).

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/pose.h"

namespace mien {

/// A slider's range during a drag, in place of its own minimum and maximum. Equal ends hold it there.
struct SliderLimits {
  int slider = 0;
  double low = 0, high = 1;
};

/// A joint that a drag may turn or shift, within limits counted from its rest. Limit constraints on the node narrow them.
struct DraggedJoint {
  int node = 0;
  /// Rotation vector after the rest rotation, in the joint's own axes, radians.
  Eigen::Vector3d turn_low = Eigen::Vector3d::Zero(), turn_high = Eigen::Vector3d::Zero();
  /// In the parent's axes, the character's unit.
  Eigen::Vector3d shift_low = Eigen::Vector3d::Zero(), shift_high = Eigen::Vector3d::Zero();
  /// What a radian, or a shift by the face's box diagonal, costs against a slider's move by one.
  double stiffness = 1;
};

/// A wire that a drag may move: its control points, its scale and its turns, without limits.
struct DraggedWire {
  int wire = 0;
  /// What moving a control point by the wire's longest range, changing the scale by 1, or turning by a radian costs against a
  /// slider's move by one.
  double stiffness = 1;
};

/// How sliders move together, learned from clips (`learn_prior`): a Gaussian over slider values.
struct SliderPrior {
  Eigen::VectorXd mean;       ///< #sliders
  Eigen::MatrixXd precision;  ///< #sliders x #sliders, symmetric positive definite: the inverse covariance
};

/// alpha and mu of eq. 3 in the character's unit squared.
struct FileUnitWeights {
  double alpha = 0.1, mu = 0.001;  ///< the paper's values, meant for a face of about 20 cm in cm or mm
};

struct SolvePinsOptions {
  /// alpha = rho |B|^2 / 3, B being the pins' rows at the start: without unit, so that the same gesture gives the same weights
  /// in any. 1e-3 reaches a goal within reach to 2 % of the drag; 1e-1 is soft.
  double rho = 1e-3;
  /// mu as a share of alpha: how much sliders tend to 0. The paper's is 0.01; 0 leaves a pose alone that no pin pulls on.
  double decay = 0;
  /// Instead of rho and decay.
  std::optional<FileUnitWeights> file_units;
  std::vector<double> stiffness;     ///< #sliders, > 0: what moving each costs; empty: all 1
  std::vector<int> locked;           ///< sliders that stay as they are
  std::vector<SliderLimits> limits;  ///< others have their own minimum and maximum
  std::vector<std::vector<int>>
      exclusive;  ///< of each group at most one slider is away from its rest afterwards
  /// Above 0 and below 1: few sliders move, fewer the nearer to 1 (at 1 none would). Which ones is chosen by an L1 term in
  /// place of part of the goal's pull, how far by solving again for these alone.
  double sparsity = 0;
  /// Changes that clips do not know cost more.
  std::optional<SliderPrior> prior;
  double prior_strength = 1;         ///< of the prior against the plain cost of change
  bool towards_prior_mean = false;   ///< also pull to the clips' mean; else pins at rest still change nothing
  std::vector<DraggedJoint> joints;  ///< none: the joints stay
  std::vector<DraggedWire> wires;    ///< none: the wires stay. A pin that has `sliders` is not moved by wires
  int most_solves = 8;               ///< quadratic programs for a rig that is not linear
};

struct SolvePinsResult {
  RigPose pose;
  std::vector<double> misses;  ///< #P, distance to the goal along the held axes, the character's unit
  std::vector<int> moved;      ///< sliders that differ from the start by more than 1e-6
  bool hard_met = true;        ///< hard pins are at their goals to 1e-6 of the face's box
  bool converged = true;
  int solves = 0;        ///< quadratic programs solved
  double objective = 0;  ///< 1/2 of eq. 3's value
  explicit SolvePinsResult(RigPose start) : pose(std::move(start)) {}
};

/// Keeps what one drag needs; made when it starts, asked at every move of the pointer.
///
/// `start` is w0 of eq. 3, frozen: dragging there and back returns. Limits hold in every result, also where the start is
/// outside them. A rig that is linear (plain sliders, no joints) is solved exactly in one quadratic program; others
/// (in-betweens, correctives, joints) by a sequence of them, each on the derivative at the last pose, with a step search on
/// the true points: the objective never rises from one to the next, the first being the linear answer.
/// Hard pins (eq. 1) are met by the method of multipliers over the same program. If the limits do not let them be met,
/// the result is the nearest pose to meeting them, `hard_met` is false and `misses` says by how much.
class PinSolver {
 public:
  ///   throws  invalid_input: no pins; neither sliders nor wires to move; a pin off the surface, with numbers that are not finite or a weight not
  ///           above 0; a slider, node, joint or wire out of range; limits upside down; options out of range; hard pins on one
  ///           point with different goals; pins that nothing moves
  ///   cost    linear in the deltas of all shapes, then #rows^2 x #sliders
  PinSolver(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
            const SolvePinsOptions& options = {});
  ~PinSolver();
  PinSolver(PinSolver&&) noexcept;
  PinSolver& operator=(PinSolver&&) noexcept;

  /// #P x 3: where the pins are at the start, model space.
  const PointsD& start_positions() const;
  /// Sets a pin's goal, model space.
  ///   throws  invalid_input: no such pin, a goal that is not finite
  void set_goal(int pin, const Eigen::Vector3d& goal);
  /// The pose for the present goals, starting from the last answer. The result belongs to the solver and holds until the next
  /// call. Allocates nothing when the rig is linear.
  const SolvePinsResult& solve();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for one use.
SolvePinsResult solve_pins(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
                           const SolvePinsOptions& options = {});

/// Mean and shrunk covariance of the sliders over frames `fps` apart of the clips: (C + s^2 I)^-1 times the mean variance, with
/// s = 0.05 for what the clips never move; scaled so that sliders as free as the clips' average cost 1.
///   throws  invalid_input: no clips, an fps not above 0
SliderPrior learn_prior(const Character& character, const std::vector<Clip>& clips, double fps = 30);

}  // namespace mien
