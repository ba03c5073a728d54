// Points are made of sites: the vertices that they lie between, each with its own row of deltas and of influences, and
// every vertex once however many points share it. With x the shaped position of a site and M_c what carrier c (a joint)
// does, the site is at y = sum_c w_c M_c x. For node n, M_c = U exp([w]x) B_c with U = (parent's model matrix) T R, and
// B_c = (scale of n) (locals between n and the joint) (inverse bind): then dy/dw = -U [sum_c w_c B_c x]x. B_c is walked
// down from n, not up from the joint by inverses: a scale of zero somewhere does no harm. A site of a dual quaternion
// skin is at y = rigid(sum_c w_c q_c) sum_c w_c S_c x; the slopes of q_c and S_c come from those of M_c. Constraints stand between
// a node and M_c, with limits, averages of rotations and whatever else: there the slopes of the M_c alone, a few matrices, are
// central differences, and everything after them is as before. Influence objects make x of what shapes and wires leave,
// x = A x0 + b; what joints do to b goes through averages of motions too, and its slope is a central difference where a joint moves
// an object.
#include "mien/evaluate/point_evaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/deform/dual_quaternion.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/check_pose.h"
#include "mien/evaluate/detail/joint_chain.h"
#include "mien/evaluate/detail/point_objects.h"
#include "mien/evaluate/detail/point_sites.h"
#include "mien/evaluate/detail/wire_motion.h"

namespace mien {

using detail::Affine;
using detail::Site;
using detail::Term;

namespace {

using Motion = Eigen::Matrix<double, 3, 4>;

/// Of a turn in radians, and of a shift as a share of the points' coordinates: an error of 1e-10 either way, by its square and
/// by the digits that are left.
constexpr double difference_step = 1e-5;

/// The blend of a dual quaternion site's influences.
struct RigidBlend {
  DualQuaternion sum;
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Zero();
};

/// A column of the Jacobian that a shape has a share in.
struct ShapeColumn {
  int column = 0;
  double slope = 1;
};

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

struct PointEvaluator::Impl : detail::PointSites {
  Impl(const Character& character, const std::vector<SurfacePoint>& points)
      : PointSites(character, points),
        outline(detail::outline(character)),
        constraints(character),
        wire_rows(character),
        objects(character, constraints, *this),
        wires(wire_rows),
        moved(objects.none()),
        moved_high(moved),
        moved_low(moved) {}

  Character outline;
  ConstraintSolver constraints;
  detail::WireRows wire_rows;
  detail::PointObjects objects;

  // Of the last pose.
  Eigen::MatrixXd weights;  // #S x parts
  detail::WireMotion wires;
  detail::PartMotions moved;
  Eigen::MatrixXi is_exception;          // #S x parts: the shape weight is the part's own
  std::vector<Transform> locals;         // that obey the constraints
  std::vector<Affine> model, carried;    // by link, by carrier
  std::vector<StretchedMotion> motions;  // by carrier, when a site is of a dual quaternion skin
  std::vector<DualQuaternion> rigid;
  PointsD bare, shaped, placed;  // by site: before objects, before the skin, and where it is

  // Of one joint freedom.
  std::vector<char> is_below;  // by link
  std::vector<Affine> below;
  std::vector<std::array<MotionSlope, 6>> slopes;     // by carrier: turns, then shifts
  std::vector<std::array<Motion, 6>> carrier_slopes;  // the same as matrices, when there are constraints
  std::vector<Affine> model_there, high, low;
  detail::PartMotions moved_high, moved_low;
  std::vector<std::vector<ShapeColumn>> columns_of_shape;  // #S: the columns that a shape weight moves

  void pose_sites(const Pose& pose);
  void set_weights(const Pose& pose);
  void split_motions();
  RigidBlend blend(const Site& site) const;
  Eigen::Vector3d place(const Site& site, const Eigen::Vector3d& shaped_site) const;
  Eigen::Matrix3d linear_of(const Site& site) const;
  void add_shape_columns(Eigen::MatrixXd& out) const;
  void add_object_columns(const Term& term, const Eigen::Matrix3d& linear, Eigen::MatrixXd& out) const;
  void add_object_joint_columns(const JointFreedom& freedom, const Pose& pose, Eigen::Index column,
                                Eigen::MatrixXd& out);
  double difference_size() const;
  void add_all_joint_columns(const std::vector<JointFreedom>& joints, const Pose& pose, Eigen::Index column,
                             Eigen::MatrixXd& out);
  void walk_below(int link, const Pose& pose);
  void add_joint_columns(const JointFreedom& freedom, const Pose& pose, Eigen::Index column,
                         Eigen::MatrixXd& out);
  Eigen::Matrix<double, 3, 6> linear_slope(std::size_t site, const Eigen::Matrix3d& turn,
                                           const Eigen::Matrix3d& shift) const;
  void move_there(const Pose& pose, int node, int column, double step);
  void set_carrier_slopes(const JointFreedom& freedom, const Pose& pose);
  Eigen::Matrix<double, 3, 6> linear_slope_of_carriers(std::size_t site) const;
  void set_motion_slopes(const Eigen::Matrix3d& turn, const Eigen::Matrix3d& shift);
  Eigen::Matrix<double, 3, 6> dual_quaternion_slope(std::size_t site) const;
};

void PointEvaluator::Impl::set_weights(const Pose& pose) {
  for (std::size_t p = 0; p < parts.size(); ++p)
    weights.col(static_cast<Eigen::Index>(p)) = pose.shape_weights.values;
  is_exception.setZero();
  for (const PartShapeWeight& exception : pose.part_shape_weights)
    for (std::size_t p = 0; p < parts.size(); ++p)
      if (parts[p] == exception.part) {
        weights(exception.shape, static_cast<Eigen::Index>(p)) = exception.value;
        is_exception(exception.shape, static_cast<Eigen::Index>(p)) = 1;
      }
}

void PointEvaluator::Impl::pose_sites(const Pose& pose) {
  detail::check_pose(outline, pose);
  set_weights(pose);
  wires.set(wire_rows, pose.wires);
  locals = pose.locals;
  constraints.apply(locals);
  chain.evaluate(outline.nodes, locals, model, carried);
  if (!motions.empty()) split_motions();
  if (objects.act(pose)) objects.move(locals, weights, pose.objects, moved);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Site& site = sites[i];
    Eigen::Vector3d x = site.neutral;
    for (int d = site.delta_begin; d < site.delta_end; ++d)
      x += weights(deltas[d].shape, site.column) * deltas[d].move;
    for (int w = site.wire_begin; w < site.wire_end && !wires.is_still; ++w)
      x += to_part[site.column] * wires.of(wire_rows, wire_entries[w]);
    const auto row = static_cast<Eigen::Index>(i);
    bare.row(row) = x;
    if (objects.reach(site)) x += objects.shift(site, x, moved);
    shaped.row(row) = x;
    placed.row(row) = place(site, x);
  }
}

void PointEvaluator::Impl::split_motions() {
  for (std::size_t c = 0; c < carried.size(); ++c) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topRows<3>() << carried[c].linear, carried[c].origin;
    motions[c] = split_motion(matrix);
    rigid[c] = dual_quaternion(motions[c].rotation, motions[c].translation);
  }
}

/// The strongest influence of a site comes first: it is the pivot of the signs.
RigidBlend PointEvaluator::Impl::blend(const Site& site) const {
  RigidBlend blend;
  const Eigen::Vector4d pivot = rigid[influences[site.influence_begin].carrier].real;
  for (int k = site.influence_begin; k < site.influence_end; ++k) {
    const auto [carrier, weight] = influences[k];
    const double turned = weight * antipodal_sign(pivot, rigid[carrier].real);
    blend.sum.real += turned * rigid[carrier].real;
    blend.sum.dual += turned * rigid[carrier].dual;
    blend.stretch += weight * motions[carrier].stretch;
  }
  return blend;
}

Eigen::Vector3d PointEvaluator::Impl::place(const Site& site, const Eigen::Vector3d& x) const {
  if (site.influence_begin == site.influence_end) return x;
  if (site.is_dual_quaternion) {
    const RigidBlend blended = blend(site);
    return rigid_matrix(blended.sum) * (blended.stretch * x).homogeneous();
  }
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  for (int k = site.influence_begin; k < site.influence_end; ++k)
    y += influences[k].weight * (carried[influences[k].carrier] * x);
  return y;
}

Eigen::Matrix3d PointEvaluator::Impl::linear_of(const Site& site) const {
  if (site.influence_begin == site.influence_end) return Eigen::Matrix3d::Identity();
  if (site.is_dual_quaternion) {
    const RigidBlend blended = blend(site);
    return rigid_matrix(blended.sum).leftCols<3>() * blended.stretch;
  }
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  for (int k = site.influence_begin; k < site.influence_end; ++k)
    linear += influences[k].weight * carried[influences[k].carrier].linear;
  return linear;
}

void PointEvaluator::Impl::add_shape_columns(Eigen::MatrixXd& out) const {
  for (const Term& term : terms) {
    const Site& site = sites[term.site];
    Eigen::Matrix3d linear = term.weight * linear_of(site);
    if (objects.reach(site)) {
      add_object_columns(term, linear, out);
      linear *= objects.turn(site, moved);
    }
    for (int d = site.delta_begin; d < site.delta_end; ++d) {
      if (columns_of_shape[deltas[d].shape].empty() || is_exception(deltas[d].shape, site.column)) continue;
      const Eigen::Vector3d move = linear * deltas[d].move;
      for (const auto [column, slope] : columns_of_shape[deltas[d].shape])
        out.block<3, 1>(3 * term.point, column) += slope * move;
    }
  }
}

/// What shapes do to a site through the objects that they move.
void PointEvaluator::Impl::add_object_columns(const Term& term, const Eigen::Matrix3d& linear,
                                              Eigen::MatrixXd& out) const {
  const Site& site = sites[term.site];
  for (const auto& [shape, move] : objects.shape_moves()) {
    if (columns_of_shape[shape].empty() || is_exception(shape, site.column)) continue;
    const Eigen::Vector3d shift = linear * objects.slope(site, move, moved);
    for (const auto [column, slope] : columns_of_shape[shape])
      out.block<3, 1>(3 * term.point, column) += slope * shift;
  }
}

/// What a joint does to the sites through the objects that it moves.
void PointEvaluator::Impl::add_object_joint_columns(const JointFreedom& freedom, const Pose& pose,
                                                    Eigen::Index first, Eigen::MatrixXd& out) {
  if (sites.empty()) return;
  const double size = difference_size();
  for (int column = 0; column < 6; ++column) {
    if (!(column < 3 ? freedom.rotation : freedom.translation)) continue;
    const double step = column < 3 ? difference_step : difference_step * size;
    move_there(pose, freedom.node, column, step);
    objects.move(locals, weights, pose.objects, moved_high);
    move_there(pose, freedom.node, column, -step);
    objects.move(locals, weights, pose.objects, moved_low);
    const Eigen::Index to = first + column - (column < 3 || freedom.rotation ? 0 : 3);
    for (const Term& term : terms) {
      const Site& site = sites[term.site];
      if (!objects.reach(site)) continue;
      const Eigen::Vector3d x = bare.row(term.site);
      const Eigen::Vector3d change = objects.shift(site, x, moved_high) - objects.shift(site, x, moved_low);
      out.block<3, 1>(3 * term.point, to) += term.weight * (linear_of(site) * change) / (2 * step);
    }
  }
}

void PointEvaluator::Impl::add_all_joint_columns(const std::vector<JointFreedom>& joints, const Pose& pose,
                                                 Eigen::Index column, Eigen::MatrixXd& out) {
  for (const JointFreedom& joint : joints) {
    add_joint_columns(joint, pose, column, out);
    if (objects.are_moved_by(joint.node)) add_object_joint_columns(joint, pose, column, out);
    column += 3 * joint.rotation + 3 * joint.translation;
  }
}

/// below[c] = (scale of the node) (locals down to link c), for the links at and below `link`.
void PointEvaluator::Impl::walk_below(int link, const Pose& pose) {
  const auto& links = chain.links();
  std::fill(is_below.begin(), is_below.end(), 0);
  is_below[link] = 1;
  below[link] = {pose.locals[links[link].node].scale.asDiagonal(), Eigen::Vector3d::Zero()};
  for (std::size_t l = link + 1; l < links.size(); ++l) {
    const auto [node, parent] = links[l];
    if (parent < 0 || !is_below[parent]) continue;
    is_below[l] = 1;
    below[l] = below[parent] * detail::local_affine(outline.nodes[node], pose.locals[node]);
  }
}

void PointEvaluator::Impl::add_joint_columns(const JointFreedom& freedom, const Pose& pose,
                                             Eigen::Index column, Eigen::MatrixXd& out) {
  const int link = chain.link_of(freedom.node);
  const bool is_free = constraints.empty();
  if (link < 0 && is_free) return;  // it moves none of the points
  Eigen::Matrix3d turn, shift;
  if (is_free) {
    walk_below(link, pose);
    const int parent = chain.links()[link].parent;
    shift = parent < 0 ? Eigen::Matrix3d::Identity() : model[parent].linear;
    turn = shift * pose.locals[freedom.node].rotation.toRotationMatrix();
    if (!motions.empty()) set_motion_slopes(turn, shift);
  } else {
    set_carrier_slopes(freedom, pose);
  }
  for (const Term& term : terms) {
    const auto site = static_cast<std::size_t>(term.site);
    const Eigen::Matrix<double, 3, 6> slope =
        term.weight * (sites[site].is_dual_quaternion ? dual_quaternion_slope(site)
                       : is_free                      ? linear_slope(site, turn, shift)
                                                      : linear_slope_of_carriers(site));
    auto rows = out.middleRows<3>(3 * term.point);
    if (freedom.rotation) rows.middleCols<3>(column) += slope.leftCols<3>();
    if (freedom.translation) rows.middleCols<3>(column + 3 * freedom.rotation) += slope.rightCols<3>();
  }
}

/// Leaves in `locals` what the constraints make of the pose with one of a node's six freedoms moved by `step`.
void PointEvaluator::Impl::move_there(const Pose& pose, int node, int column, double step) {
  locals = pose.locals;
  if (column < 3)
    locals[node].rotation =
        locals[node].rotation *
        Eigen::Quaterniond(Eigen::AngleAxisd(step, Eigen::Vector3d(Eigen::Vector3d::Unit(column))));
  else
    locals[node].translation[column - 3] += step;
  constraints.apply(locals);
}

/// What a shift's step is a share of.
double PointEvaluator::Impl::difference_size() const {
  const double size = std::max(shaped.cwiseAbs().maxCoeff(), placed.cwiseAbs().maxCoeff());
  return size == 0 ? 1 : size;
}

void PointEvaluator::Impl::set_carrier_slopes(const JointFreedom& freedom, const Pose& pose) {
  if (sites.empty()) return;
  std::fill(is_below.begin(), is_below.end(), 1);  // any carrier may follow
  const double size = difference_size();
  for (int column = 0; column < 6; ++column) {
    if (!(column < 3 ? freedom.rotation : freedom.translation)) continue;
    const double step = column < 3 ? difference_step : difference_step * size;
    move_there(pose, freedom.node, column, step);
    chain.evaluate(outline.nodes, locals, model_there, high);
    move_there(pose, freedom.node, column, -step);
    chain.evaluate(outline.nodes, locals, model_there, low);
    for (std::size_t c = 0; c < carried.size(); ++c) {
      carrier_slopes[c][column] << high[c].linear - low[c].linear, high[c].origin - low[c].origin;
      carrier_slopes[c][column] /= 2 * step;
      if (!motions.empty()) slopes[c][column] = motion_slope(motions[c], carrier_slopes[c][column]);
    }
  }
}

Eigen::Matrix<double, 3, 6> PointEvaluator::Impl::linear_slope_of_carriers(std::size_t index) const {
  const Site& site = sites[index];
  const Eigen::Vector4d x = shaped.row(static_cast<Eigen::Index>(index)).transpose().homogeneous();
  Eigen::Matrix<double, 3, 6> slope = Eigen::Matrix<double, 3, 6>::Zero();
  for (int k = site.influence_begin; k < site.influence_end; ++k)
    for (int column = 0; column < 6; ++column)
      slope.col(column) += influences[k].weight * (carrier_slopes[influences[k].carrier][column] * x);
  return slope;
}

Eigen::Matrix<double, 3, 6> PointEvaluator::Impl::linear_slope(std::size_t index, const Eigen::Matrix3d& turn,
                                                               const Eigen::Matrix3d& shift) const {
  const Site& site = sites[index];
  const Eigen::Vector3d x = shaped.row(static_cast<Eigen::Index>(index));
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  double share = 0;
  for (int k = site.influence_begin; k < site.influence_end; ++k) {
    const detail::Carrier& carrier = chain.carriers()[influences[k].carrier];
    if (!is_below[carrier.link]) continue;
    arm += influences[k].weight * (below[carrier.link] * (carrier.inverse_bind * x));
    share += influences[k].weight;
  }
  Eigen::Matrix<double, 3, 6> slope;
  slope << -turn * cross_matrix(arm), share * shift;
  return slope;
}

void PointEvaluator::Impl::set_motion_slopes(const Eigen::Matrix3d& turn, const Eigen::Matrix3d& shift) {
  for (std::size_t c = 0; c < motions.size(); ++c) {
    const detail::Carrier& carrier = chain.carriers()[c];
    if (!is_below[carrier.link]) continue;
    const Affine arm = below[carrier.link] * carrier.inverse_bind;
    Eigen::Matrix<double, 3, 4> matrix;
    for (int axis = 0; axis < 3; ++axis) {
      matrix << arm.linear, arm.origin;
      matrix = (turn * cross_matrix(Eigen::Vector3d::Unit(axis)) * matrix).eval();
      slopes[c][axis] = motion_slope(motions[c], matrix);
      matrix.setZero();
      matrix.col(3) = shift.col(axis);
      slopes[c][3 + axis] = motion_slope(motions[c], matrix);
    }
  }
}

Eigen::Matrix<double, 3, 6> PointEvaluator::Impl::dual_quaternion_slope(std::size_t index) const {
  const Site& site = sites[index];
  const Eigen::Vector3d x = shaped.row(static_cast<Eigen::Index>(index));
  const RigidBlend blended = blend(site);
  const Eigen::Vector4d pivot = rigid[influences[site.influence_begin].carrier].real;
  Eigen::Matrix<double, 3, 6> slope;
  for (int column = 0; column < 6; ++column) {
    RigidBlend change;
    for (int k = site.influence_begin; k < site.influence_end; ++k) {
      const auto [carrier, weight] = influences[k];
      if (!is_below[chain.carriers()[carrier].link]) continue;
      const MotionSlope& motion = slopes[carrier][column];
      const double turned = weight * antipodal_sign(pivot, rigid[carrier].real);
      change.sum.real += turned * motion.rigid.real;
      change.sum.dual += turned * motion.rigid.dual;
      change.stretch += weight * motion.stretch;
    }
    slope.col(column) = rigid_slope(blended.sum, change.sum, blended.stretch * x, change.stretch * x);
  }
  return slope;
}

Eigen::Index Freedoms::column_count() const {
  auto count = static_cast<Eigen::Index>(shapes.size() + sliders.size());
  for (const JointFreedom& joint : joints) count += 3 * joint.rotation + 3 * joint.translation;
  return count;
}

PointEvaluator::PointEvaluator(const Character& character, const std::vector<SurfacePoint>& points)
    : impl_(std::make_unique<Impl>(character, points)) {
  const auto shapes = static_cast<Eigen::Index>(character.shapes.size());
  const auto parts = static_cast<Eigen::Index>(impl_->parts.size());
  impl_->weights.resize(shapes, parts);
  impl_->is_exception.resize(shapes, parts);
  impl_->bare.resize(static_cast<Eigen::Index>(impl_->sites.size()), 3);
  impl_->shaped.resize(static_cast<Eigen::Index>(impl_->sites.size()), 3);
  impl_->placed.resize(static_cast<Eigen::Index>(impl_->sites.size()), 3);
  impl_->is_below.resize(impl_->chain.links().size());
  impl_->below.resize(impl_->chain.links().size());
  impl_->columns_of_shape.resize(character.shapes.size());
  const auto& sites = impl_->sites;
  if (std::any_of(sites.begin(), sites.end(), [](const Site& site) { return site.is_dual_quaternion; })) {
    impl_->motions.resize(impl_->chain.carriers().size());
    impl_->rigid.resize(impl_->chain.carriers().size());
    impl_->slopes.resize(impl_->chain.carriers().size());
  }
  if (!impl_->constraints.empty())
    impl_->carrier_slopes.assign(
        impl_->chain.carriers().size(),
        {Motion::Zero(), Motion::Zero(), Motion::Zero(), Motion::Zero(), Motion::Zero(), Motion::Zero()});
}

PointEvaluator::~PointEvaluator() = default;
PointEvaluator::PointEvaluator(PointEvaluator&&) noexcept = default;
PointEvaluator& PointEvaluator::operator=(PointEvaluator&&) noexcept = default;

std::size_t PointEvaluator::point_count() const {
  return impl_->point_count;
}

void PointEvaluator::positions(const Pose& pose, PointsD& out) {
  impl_->pose_sites(pose);
  out.setZero(static_cast<Eigen::Index>(impl_->point_count), 3);
  for (const Term& term : impl_->terms) out.row(term.point) += term.weight * impl_->placed.row(term.site);
}

void PointEvaluator::jacobian(const Pose& pose, const Freedoms& freedoms, Eigen::MatrixXd& out) {
  detail::check_freedoms(impl_->outline, freedoms);
  if (!freedoms.sliders.empty()) throw invalid_input("freedoms", "name sliders of a pose", "shapes");
  impl_->pose_sites(pose);
  out.setZero(3 * static_cast<Eigen::Index>(impl_->point_count), freedoms.column_count());
  for (auto& columns : impl_->columns_of_shape) columns.clear();
  for (std::size_t s = 0; s < freedoms.shapes.size(); ++s)
    impl_->columns_of_shape[freedoms.shapes[s]].push_back({static_cast<int>(s), 1});
  impl_->add_shape_columns(out);
  impl_->add_all_joint_columns(freedoms.joints, pose, static_cast<Eigen::Index>(freedoms.shapes.size()), out);
}

void PointEvaluator::positions(const RigPose& rig, PointsD& out) {
  positions(pose_of(impl_->outline, rig), out);
}

void PointEvaluator::jacobian(const RigPose& rig, const Freedoms& freedoms, Eigen::MatrixXd& out) {
  detail::check_freedoms(impl_->outline, freedoms);
  if (!freedoms.shapes.empty()) throw invalid_input("freedoms", "name shapes of a rig's pose", "sliders");
  const Pose pose = pose_of(impl_->outline, rig);
  const Eigen::MatrixXd slopes = shape_weight_slopes(impl_->outline, rig.sliders);
  impl_->pose_sites(pose);
  out.setZero(3 * static_cast<Eigen::Index>(impl_->point_count), freedoms.column_count());
  for (auto& columns : impl_->columns_of_shape) columns.clear();
  for (std::size_t c = 0; c < freedoms.sliders.size(); ++c)
    for (Eigen::Index s = 0; s < slopes.rows(); ++s)
      if (const double slope = slopes(s, freedoms.sliders[c]); slope != 0)
        impl_->columns_of_shape[static_cast<std::size_t>(s)].push_back({static_cast<int>(c), slope});
  impl_->add_shape_columns(out);
  impl_->add_all_joint_columns(freedoms.joints, pose, static_cast<Eigen::Index>(freedoms.sliders.size()),
                               out);
}

void PointEvaluator::shape_rows(const Pose& pose, Eigen::MatrixXd& out) {
  impl_->pose_sites(pose);
  out.setZero(3 * static_cast<Eigen::Index>(impl_->point_count),
              static_cast<Eigen::Index>(impl_->outline.shapes.size()));
  for (std::size_t s = 0; s < impl_->columns_of_shape.size(); ++s)
    impl_->columns_of_shape[s].assign(1, {static_cast<int>(s), 1});
  impl_->add_shape_columns(out);
}

}  // namespace mien
