#pragma once
/// The pins' points as a function of what a drag may change: sliders, and the joints that it may turn and shift.

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/pose.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/pose/detail/slider_map.h"
#include "mien/pose/detail/wire_unknowns.h"

namespace mien::detail {

/// Unknowns x: #sliders slider values, then three numbers a turning joint (a rotation vector after the rest rotation,
/// radians, in the joint's own axes) and three a shifting one (from the rest translation, in `length`), then those of wires
/// (changes from the start). What a start's wires do is there also when no wire may move.
class PinnedRig {
 public:
  struct Joint {
    int node;
    bool turns, shifts;
  };
  /// What may move besides the sliders.
  struct Freed {
    std::vector<Joint> joints;
    std::vector<int> wires;
    double length = 1;  ///< what a joint's shift by one means, in the character's unit
  };
  PinnedRig(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
            const Freed& freed);

  int unknown_count() const { return static_cast<int>(start_.size()); }
  int row_count() const { return static_cast<int>(row_pin_.size()); }
  /// Whether the points are a linear function of x.
  bool linear() const { return map_.linear() && joints_.empty(); }
  const Eigen::VectorXd& start() const { return start_; }
  /// Which pin a row belongs to, and its direction.
  int pin_of(int row) const { return row_pin_[row]; }
  const Eigen::Vector3d& direction_of(int row) const { return directions_[row]; }

  /// #R: the points' coordinates along their held directions.
  void coordinates(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  /// Their derivatives, #R x unknowns. A pin of a region sees the sliders outside it where they were at the start.
  void rows(const Eigen::VectorXd& x, Eigen::MatrixXd& out);
  /// Where the pins are at the start, #P x 3, model space.
  const PointsD& start_positions() const { return start_positions_; }
  /// Sets the rig pose's sliders, joints and wires to x.
  void write(const Eigen::VectorXd& x, RigPose& pose) const;

 private:
  /// Pins that see the same sliders.
  struct Region {
    std::vector<char> sees;  // #sliders; empty: all
    std::vector<int> rows;
  };
  void add_pin(const Pin& pin, int index, std::vector<SurfacePoint>& points);
  void read_start(const RigPose& start);
  const Eigen::VectorXd& seen(const Region& region, const Eigen::VectorXd& x);
  void set_weights(const Region& region, const Eigen::VectorXd& x);
  Eigen::Index shape_count() const { return weights_.size(); }
  void set_joints(const Eigen::VectorXd& x, std::vector<Transform>& locals) const;
  void evaluate_points(PointsD& out);
  void differentiate_points();
  void add_joint_point_rows(const std::vector<Eigen::Matrix4d>& model);
  void add_region_rows(const Region& region, const Eigen::VectorXd& x, Eigen::MatrixXd& out);

  SliderMap map_;
  Character skeleton_;  // nodes and what they obey
  std::vector<Joint> joints_;
  double length_ = 1;
  int sliders_ = 0;
  std::optional<WireUnknowns>
      wires_;  // as shapes behind the character's own: the start's moves, then one an unknown
  std::vector<Region> regions_;
  std::vector<int> row_pin_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<int> point_pin_;                  // whose point the evaluator's point is
  std::vector<std::pair<int, int>> node_pins_;  // pin, node: pins on joints
  std::optional<PointEvaluator> evaluator_;
  Freedoms freedoms_;
  std::vector<Transform> start_locals_;
  Eigen::VectorXd start_, seen_, moved_, own_weights_, weights_, start_weights_, start_coordinates_;
  Pose pose_{ShapeWeights(0), {}};
  PointsD points_, found_, start_positions_;
  Eigen::MatrixXd point_slopes_;  // 3 #points x (#shapes + joint columns), as the evaluator gives them
  Eigen::MatrixXd slopes_;        // #R x the same, along the held directions
};

}  // namespace mien::detail
