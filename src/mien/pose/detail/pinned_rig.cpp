// While no joint may move, the points are affine in the shape weights: their rows are taken once, and a pose costs one
// product. With joints the evaluator is asked at every step.
#include "mien/pose/detail/pinned_rig.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "mien/evaluate/constraints.h"

namespace mien::detail {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond turned(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))
                   : Eigen::Quaterniond::Identity();
}

Eigen::Vector3d turn_of(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation.normalized());
  const double angle = turn.angle() > EIGEN_PI ? turn.angle() - 2 * EIGEN_PI : turn.angle();
  return angle * turn.axis();
}

/// exp(turn + d) = exp(turn) exp(this d), to first order: the right Jacobian of the rotations.
Eigen::Matrix3d turn_slopes(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  const Eigen::Matrix3d k = cross_matrix(turn);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() - k / 2;
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / (angle * angle) * k +
         (angle - std::sin(angle)) / (angle * angle * angle) * k * k;
}

}  // namespace

PinnedRig::PinnedRig(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
                     const Freed& freed)
    : map_(character), joints_(freed.joints), length_(freed.length), sliders_(map_.slider_count()) {
  skeleton_.nodes = character.nodes;
  skeleton_.constraints = character.constraints;
  std::vector<SurfacePoint> points;
  for (std::size_t p = 0; p < pins.size(); ++p) add_pin(pins[p], static_cast<int>(p), points);
  Eigen::Index shapes = map_.shape_count();
  if (freed.wires.empty() && start.wires.empty()) {
    evaluator_.emplace(character, points);
  } else {
    wires_.emplace(character, freed.wires, start.wires);
    Character with_wires = character;
    wires_->add_shapes(points, with_wires);
    evaluator_.emplace(with_wires, points);
    shapes = static_cast<Eigen::Index>(with_wires.shapes.size());
  }
  weights_.setZero(shapes);
  freedoms_.shapes.resize(static_cast<std::size_t>(shapes));
  std::iota(freedoms_.shapes.begin(), freedoms_.shapes.end(), 0);
  for (const Joint& joint : joints_) freedoms_.joints.push_back({joint.node, joint.turns, joint.shifts});
  start_positions_.resize(static_cast<Eigen::Index>(pins.size()), 3);
  read_start(start);
}

void PinnedRig::add_pin(const Pin& pin, int index, std::vector<SurfacePoint>& points) {
  if (const SurfacePoint* point = std::get_if<SurfacePoint>(&pin.at)) {
    points.push_back(*point);
    point_pin_.push_back(index);
  } else {
    node_pins_.push_back({index, std::get<JointPoint>(pin.at).node});
  }
  std::vector<char> sees;
  if (!pin.sliders.empty()) sees.assign(static_cast<std::size_t>(sliders_), 0);
  for (const int slider : pin.sliders) sees[static_cast<std::size_t>(slider)] = 1;
  Region* region = nullptr;
  for (Region& other : regions_)
    if (other.sees == sees) region = &other;
  if (!region) region = &regions_.emplace_back(Region{sees, {}});
  for (int a = 0; a < pin.axes.count; ++a) {
    region->rows.push_back(static_cast<int>(row_pin_.size()));
    row_pin_.push_back(index);
    directions_.push_back(pin.axes.directions.row(a).transpose());
  }
}

void PinnedRig::read_start(const RigPose& start) {
  int count = sliders_;
  for (const Joint& joint : joints_) count += 3 * joint.turns + 3 * joint.shifts;
  if (wires_) count += wires_->count();
  start_.setZero(count);
  start_.head(sliders_) = start.sliders.values;
  int column = sliders_;
  for (const Joint& joint : joints_) {
    const Transform &rest = skeleton_.nodes[joint.node].rest, &local = start.locals[joint.node];
    if (joint.turns) {
      start_.segment<3>(column) = turn_of(rest.rotation.inverse() * local.rotation);
      column += 3;
    }
    if (joint.shifts) {
      start_.segment<3>(column) = (local.translation - rest.translation) / length_;
      column += 3;
    }
  }
  seen_.resize(sliders_);
  own_weights_.resize(map_.shape_count());
  set_weights(Region{}, start_);
  start_weights_ = weights_;
  start_locals_ = start.locals;
  pose_ = Pose{ShapeWeights(weights_), start.locals, {}};
  evaluate_points(start_positions_);
  if (joints_.empty()) {
    point_slopes_.setZero(3 * start_positions_.rows(), shape_count());
    differentiate_points();
  }
  start_coordinates_.resize(row_count());
  for (int r = 0; r < row_count(); ++r)
    start_coordinates_[r] = start_positions_.row(row_pin_[r]).dot(directions_[r].transpose());
}

/// Where the pins are in `pose_`.
void PinnedRig::evaluate_points(PointsD& out) {
  evaluator_->positions(pose_, found_);
  for (std::size_t p = 0; p < point_pin_.size(); ++p)
    out.row(point_pin_[p]) = found_.row(static_cast<Eigen::Index>(p));
  if (node_pins_.empty()) return;
  const std::vector<Eigen::Matrix4d> model = posed_matrices(skeleton_, pose_);
  for (const auto& [pin, node] : node_pins_) out.row(pin) = model[node].topRightCorner<3, 1>().transpose();
}

/// `slopes_` in `pose_`: by shape weights, then by what the joints do.
void PinnedRig::differentiate_points() {
  if (joints_.empty())
    evaluator_->shape_rows(pose_, point_slopes_);
  else
    evaluator_->jacobian(pose_, freedoms_, point_slopes_);
  slopes_.setZero(row_count(), freedoms_.column_count());
  std::vector<int> point_of(static_cast<std::size_t>(start_positions_.rows()), -1);
  for (std::size_t p = 0; p < point_pin_.size(); ++p) point_of[point_pin_[p]] = static_cast<int>(p);
  for (int r = 0; r < row_count(); ++r)
    if (const int point = point_of[row_pin_[r]]; point >= 0)
      slopes_.row(r).noalias() = directions_[r].transpose() * point_slopes_.middleRows<3>(3 * point);
  if (!node_pins_.empty() && !joints_.empty()) add_joint_point_rows(posed_matrices(skeleton_, pose_));
}

/// A joint's origin p turns about the joints above it: U = parent's model matrix x T R, p = U v, dp = U (w x v).
void PinnedRig::add_joint_point_rows(const std::vector<Eigen::Matrix4d>& model) {
  for (const auto& [pin, node] : node_pins_) {
    const Eigen::Vector3d p = model[node].topRightCorner<3, 1>();
    Eigen::Index column = shape_count();
    for (const Joint& joint : joints_) {
      bool above = false;
      for (int n = node; n >= 0 && !above; n = skeleton_.nodes[n].parent) above = n == joint.node;
      const int parent = skeleton_.nodes[joint.node].parent;
      const Eigen::Affine3d up(parent >= 0 ? model[parent] : Eigen::Matrix4d::Identity());
      const Transform& local = pose_.locals[joint.node];
      const Eigen::Affine3d u = up * Eigen::Translation3d(local.translation) * local.rotation;
      Eigen::Matrix3d slopes[2];
      int count = 0;
      if (joint.turns) slopes[count++] = -u.linear() * cross_matrix(u.inverse() * p);
      if (joint.shifts) slopes[count++] = up.linear();
      for (int k = 0; k < count; ++k, column += 3)
        for (int r = 0; above && r < row_count(); ++r)
          if (row_pin_[r] == pin) slopes_.row(r).segment<3>(column) = directions_[r].transpose() * slopes[k];
    }
  }
}

const Eigen::VectorXd& PinnedRig::seen(const Region& region, const Eigen::VectorXd& x) {
  seen_ = x.head(sliders_);
  for (std::size_t s = 0; s < region.sees.size(); ++s)
    if (!region.sees[s]) seen_[static_cast<Eigen::Index>(s)] = start_[static_cast<Eigen::Index>(s)];
  return seen_;
}

/// Weights of the character's shapes, then of those that stand for wires.
void PinnedRig::set_weights(const Region& region, const Eigen::VectorXd& x) {
  map_.weights(seen(region, x), own_weights_);
  weights_.head(own_weights_.size()) = own_weights_;
  if (!wires_) return;
  weights_[own_weights_.size()] = 1;
  if (region.sees.empty())
    weights_.tail(wires_->count()) = x.tail(wires_->count());
  else
    weights_.tail(wires_->count()).setZero();
}

void PinnedRig::set_joints(const Eigen::VectorXd& x, std::vector<Transform>& locals) const {
  int column = sliders_;
  for (const Joint& joint : joints_) {
    const Transform& rest = skeleton_.nodes[joint.node].rest;
    Transform& local = locals[joint.node];
    if (joint.turns) {
      // What did not turn has the start's bits, so that a drag there and back ends where it began.
      const Eigen::Vector3d turn = x.segment<3>(column);
      local.rotation = turn == start_.segment<3>(column) ? start_locals_[joint.node].rotation
                                                         : rest.rotation * turned(turn);
      column += 3;
    }
    if (joint.shifts) {
      const Eigen::Vector3d shift = x.segment<3>(column);
      local.translation = shift == start_.segment<3>(column)
                              ? start_locals_[joint.node].translation
                              : Eigen::Vector3d(rest.translation + length_ * shift);
      column += 3;
    }
  }
}

void PinnedRig::coordinates(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  out.resize(row_count());
  for (const Region& region : regions_) {
    set_weights(region, x);
    if (joints_.empty()) {
      weights_ -= start_weights_;
      moved_.noalias() = slopes_ * weights_;
      for (const int r : region.rows) out[r] = start_coordinates_[r] + moved_[r];
      continue;
    }
    pose_.shape_weights.values = weights_;
    set_joints(x, pose_.locals);
    points_.resize(start_positions_.rows(), 3);
    evaluate_points(points_);
    for (const int r : region.rows) out[r] = points_.row(row_pin_[r]).dot(directions_[r].transpose());
  }
}

void PinnedRig::rows(const Eigen::VectorXd& x, Eigen::MatrixXd& out) {
  out.setZero(row_count(), unknown_count());
  for (const Region& region : regions_) {
    if (!joints_.empty()) {
      set_weights(region, x);
      pose_.shape_weights.values = weights_;
      set_joints(x, pose_.locals);
      differentiate_points();
    }
    add_region_rows(region, x, out);
  }
}

void PinnedRig::add_region_rows(const Region& region, const Eigen::VectorXd& x, Eigen::MatrixXd& out) {
  const bool all_rows = regions_.size() == 1;
  for (const SliderMap::Slope& slope : map_.slopes(seen(region, x))) {
    if (!region.sees.empty() && !region.sees[static_cast<std::size_t>(slope.slider)]) continue;
    if (all_rows)
      out.col(slope.slider) += slope.value * slopes_.col(slope.shape);
    else
      for (const int r : region.rows) out(r, slope.slider) += slope.value * slopes_(r, slope.shape);
  }
  int column = sliders_;
  Eigen::Index from = shape_count();
  for (const Joint& joint : joints_) {
    if (joint.turns) {
      const Eigen::Matrix3d chain = turn_slopes(x.segment<3>(column));
      for (const int r : region.rows) out.row(r).segment<3>(column) = slopes_.row(r).segment<3>(from) * chain;
      column += 3;
      from += 3;
    }
    if (joint.shifts) {
      for (const int r : region.rows)
        out.row(r).segment<3>(column) = length_ * slopes_.row(r).segment<3>(from);
      column += 3;
      from += 3;
    }
  }
  if (!wires_ || !region.sees.empty()) return;
  const Eigen::Index first = shape_count() - wires_->count();
  for (const int r : region.rows)
    out.row(r).tail(wires_->count()) = slopes_.row(r).segment(first, wires_->count());
}

void PinnedRig::write(const Eigen::VectorXd& x, RigPose& pose) const {
  pose.sliders.values = x.head(sliders_);
  set_joints(x, pose.locals);
  if (wires_) pose.wires = wires_->moves(x.tail(wires_->count()));
}

}  // namespace mien::detail
