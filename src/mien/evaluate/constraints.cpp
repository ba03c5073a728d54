// Every relation is an answer in the parent's frame (`want_...`), which `blend` then mixes into what the node had. Matrices are
// walked up from the node each time: chains are short, nothing has to be kept up to date between constraints, and nothing is
// allocated. What is at rest is recognised by its bits rather than computed, because the rest transform times its own inverse is
// the identity only up to rounding, and a node at rest keeps the matrix that its file gave.
#include "mien/evaluate/constraints.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "mien/character/validate.h"
#include "mien/core/error.h"

namespace mien {
namespace {

/// A linear map whose determinant is below this share of its columns' lengths is flat.
constexpr double flat = 1e-12;
/// Directions nearer to parallel than this (the sine of their angle) say nothing of the turn about them.
constexpr double parallel = 1e-9;

using Locals = std::vector<Transform>;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d origin_of(const Matrix4d& matrix) {
  return matrix.topRightCorner<3, 1>();
}

Vector3d carried(const Matrix4d& matrix, const Vector3d& point) {
  return matrix.topLeftCorner<3, 3>() * point + origin_of(matrix);
}

Vector3d lengths_of(const Matrix4d& matrix) {
  return matrix.topLeftCorner<3, 3>().colwise().norm().transpose();
}

/// False: the matrix is flat.
bool invert(const Matrix4d& matrix, Matrix4d& inverse) {
  const Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double size = lengths_of(matrix).prod();
  if (!(std::abs(linear.determinant()) > flat * size)) return false;
  inverse.setIdentity();
  inverse.topLeftCorner<3, 3>() = linear.inverse();
  inverse.topRightCorner<3, 1>() = -inverse.topLeftCorner<3, 3>() * origin_of(matrix);
  return true;
}

bool same(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs() && a.scale == b.scale;
}

/// Turns `aim_axis` to `direction` and `up_axis` as near to `up` as that lets it. Where up says nothing: the shortest turn from
/// `otherwise`.
Quaterniond aimed(const Constraint& constraint, const Vector3d& direction, const Vector3d& up,
                  const Quaterniond& otherwise) {
  const auto frame = [](const Vector3d& along, const Vector3d& above) {
    Matrix3d axes;
    axes.col(0) = along.normalized();
    axes.col(2) = along.cross(above).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  };
  if (!(direction.cross(up).norm() > parallel * direction.norm() * up.norm()))
    return Quaterniond::FromTwoVectors(otherwise * constraint.aim_axis, direction) * otherwise;
  return Quaterniond(frame(direction, up) * frame(constraint.aim_axis, constraint.up_axis).transpose());
}

/// Averages rotations: the eigenvector of sum share q q' (its lower triangle in `sum`).
Quaterniond average(const Eigen::Matrix4d& sum, const Quaterniond& near) {
  Quaterniond mean;
  mean.coeffs() = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(sum).eigenvectors().col(3);
  if (mean.dot(near) < 0) mean.coeffs() = -mean.coeffs();
  return mean;
}

double total_share(const Constraint& constraint) {
  double sum = 0;
  for (const ConstraintSource& source : constraint.sources) sum += source.share;
  return sum;
}

/// The sources' rotations, each as `rotation_of(k)` gives it, averaged.
template <typename Function>
Quaterniond mix_rotations(const Constraint& constraint, const Quaterniond& near,
                          const Function& rotation_of) {
  if (constraint.sources.size() == 1) return rotation_of(0);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (std::size_t k = 0; k < constraint.sources.size(); ++k) {
    const Eigen::Vector4d q = rotation_of(k).coeffs();
    sum += constraint.sources[k].share * q * q.transpose();
  }
  return average(sum, near);
}

/// The same for vectors.
template <typename Function>
Vector3d mix_vectors(const Constraint& constraint, const Function& vector_of) {
  if (constraint.sources.size() == 1) return vector_of(0);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < constraint.sources.size(); ++k)
    sum += constraint.sources[k].share * vector_of(k);
  return sum / total_share(constraint);
}

double kept_in(const ValueRange& range, double value) {
  return std::min(std::max(value, range.low), range.high);
}

bool is_bounded(const std::array<ValueRange, 3>& ranges) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [](const ValueRange& range) { return !(range == ValueRange{}); });
}

}  // namespace

Vector3d axis_turns(const Quaterniond& rotation) {
  const Matrix3d r = rotation.normalized().toRotationMatrix();
  const double level = std::hypot(r(0, 0), r(1, 0));
  const double y = std::atan2(-r(2, 0), level);
  if (level < parallel) return {std::atan2(-r(1, 2), r(1, 1)), y, 0};
  const Vector3d near(std::atan2(r(2, 1), r(2, 2)), y, std::atan2(r(1, 0), r(0, 0)));
  const auto wrapped = [](double angle) { return angle > 0 ? angle - EIGEN_PI : angle + EIGEN_PI; };
  const Vector3d far(wrapped(near.x()), (y < 0 ? -EIGEN_PI : EIGEN_PI) - y, wrapped(near.z()));
  return far.squaredNorm() < near.squaredNorm() ? far : near;
}

Quaterniond rotation_of_turns(const Vector3d& turns) {
  return Eigen::AngleAxisd(turns.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(turns.y(), Vector3d::UnitY()) *
         Eigen::AngleAxisd(turns.x(), Vector3d::UnitX());
}

struct ConstraintSolver::Compiled {
  /// What the source or the node is in model space at rest.
  struct Rest {
    Vector3d position, scale;
    Quaterniond rotation;
    Matrix4d inverse;  ///< of its matrix; for the sources of a relative parent constraint
  };
  struct Rule {
    Constraint constraint;
    std::vector<Rest> sources;
    Rest node;
    Matrix4d parent_inverse;      ///< of the node's parent
    Quaterniond parent_rotation;  ///< of the node's parent
    Quaterniond aim_offset;       ///< relative aim: comes before the aimed rotation
    bool is_flat = false;         ///< the parent is flat at rest: nothing can be counted from there
  };

  explicit Compiled(const Character& character);
  Rule compile(const Constraint& constraint, const Locals& rest) const;
  Rest rest_of(int node, const Locals& rest) const;

  Matrix4d model_of(int node, const Locals& locals) const;
  Quaterniond orientation_of(int node, const Locals& locals) const;
  bool is_at_rest(int node, const Locals& locals) const;
  bool sees_rest(const Constraint& constraint, const Locals& locals) const;
  Vector3d middle_of(const Constraint& constraint, const Locals& locals) const;

  void apply(const Rule& rule, Locals& locals) const;
  Transform wanted(const Rule& rule, const Locals& locals) const;
  Transform limited(const Constraint& constraint, const Transform& local) const;
  void want_parent(const Rule& rule, const Locals& locals, const Matrix4d& into, Transform& local) const;
  void want_point(const Rule& rule, const Locals& locals, const Matrix4d& into, Transform& local) const;
  void want_orient(const Rule& rule, const Locals& locals, Transform& local) const;
  void want_scale(const Rule& rule, const Locals& locals, Transform& local) const;
  bool aim(const Constraint& constraint, const Locals& locals, const Matrix4d& parent, const Matrix4d& into,
           Quaterniond& rotation) const;

  std::vector<Node> nodes;
  std::vector<Rule> rules;
  std::vector<int> moved;
};

ConstraintSolver::Compiled::Compiled(const Character& character) : nodes(character.nodes) {
  model_matrices(character);  // complains of cyclic parents
  const std::vector<Problem> problems = constraint_problems(character);
  if (!problems.empty()) throw problems.front().error();
  Locals rest;
  for (const Node& node : nodes) rest.push_back(node.rest);
  std::set<int> seen;
  for (const Constraint& constraint : character.constraints) {
    rules.push_back(compile(constraint, rest));
    seen.insert(constraint.node);
  }
  moved.assign(seen.begin(), seen.end());
}

ConstraintSolver::Compiled::Rest ConstraintSolver::Compiled::rest_of(int node, const Locals& rest) const {
  const Matrix4d model = model_of(node, rest);
  return {origin_of(model), lengths_of(model), orientation_of(node, rest), Matrix4d::Identity()};
}

ConstraintSolver::Compiled::Rule ConstraintSolver::Compiled::compile(const Constraint& constraint,
                                                                     const Locals& rest) const {
  Rule rule;
  rule.constraint = constraint;
  rule.node = rest_of(constraint.node, rest);
  const int parent = nodes[constraint.node].parent;
  rule.parent_rotation = orientation_of(parent, rest);
  const Matrix4d frame = model_of(parent, rest);
  rule.is_flat = !invert(frame, rule.parent_inverse);
  for (const ConstraintSource& source : constraint.sources) {
    rule.sources.push_back(rest_of(source.node, rest));
    if (constraint.kind == Constraint::Kind::parent && constraint.relative &&
        !invert(model_of(source.node, rest), rule.sources.back().inverse))
      throw invalid_input("constraint " + constraint.name,
                          "has the source " + nodes[source.node].name + ", which is flat at rest",
                          "a source whose scales are not 0, or an absolute constraint");
  }
  rule.aim_offset.setIdentity();
  Quaterniond found;
  if (constraint.kind == Constraint::Kind::aim && constraint.relative && !rule.is_flat &&
      aim(constraint, rest, frame, rule.parent_inverse, found))
    rule.aim_offset = found.conjugate() * rest[constraint.node].rotation;
  return rule;
}

/// Model space for node -1.
Matrix4d ConstraintSolver::Compiled::model_of(int node, const Locals& locals) const {
  Matrix4d model = Matrix4d::Identity();
  for (int n = node; n >= 0; n = nodes[n].parent) model = local_matrix(nodes[n], locals[n]) * model;
  return model;
}

Quaterniond ConstraintSolver::Compiled::orientation_of(int node, const Locals& locals) const {
  Quaterniond rotation = Quaterniond::Identity();
  for (int n = node; n >= 0; n = nodes[n].parent) rotation = locals[n].rotation * rotation;
  return rotation.normalized();
}

bool ConstraintSolver::Compiled::is_at_rest(int node, const Locals& locals) const {
  for (int n = node; n >= 0; n = nodes[n].parent)
    if (!same(locals[n], nodes[n].rest)) return false;
  return true;
}

/// Whether all that a relative relation looks at is at rest.
bool ConstraintSolver::Compiled::sees_rest(const Constraint& constraint, const Locals& locals) const {
  const bool aims = constraint.kind == Constraint::Kind::aim;
  if (!is_at_rest(nodes[constraint.node].parent, locals)) return false;
  if (aims && (!is_at_rest(constraint.up_node, locals) ||
               locals[constraint.node].translation != nodes[constraint.node].rest.translation))
    return false;
  return std::all_of(constraint.sources.begin(), constraint.sources.end(),
                     [&](const ConstraintSource& source) { return is_at_rest(source.node, locals); });
}

/// The sources' position, model space.
Vector3d ConstraintSolver::Compiled::middle_of(const Constraint& constraint, const Locals& locals) const {
  return mix_vectors(constraint,
                     [&](std::size_t k) { return origin_of(model_of(constraint.sources[k].node, locals)); });
}

void ConstraintSolver::Compiled::want_parent(const Rule& rule, const Locals& locals, const Matrix4d& into,
                                             Transform& local) const {
  const Constraint& constraint = rule.constraint;
  const Vector3d position = mix_vectors(constraint, [&](std::size_t k) {
    const Matrix4d source = model_of(constraint.sources[k].node, locals);
    return constraint.relative ? carried(source * rule.sources[k].inverse, rule.node.position)
                               : origin_of(source);
  });
  const Quaterniond rotation = mix_rotations(constraint, rule.node.rotation, [&](std::size_t k) {
    const Quaterniond source = orientation_of(constraint.sources[k].node, locals);
    return constraint.relative ? source * rule.sources[k].rotation.conjugate() * rule.node.rotation : source;
  });
  local.translation = carried(into, position);
  local.rotation = orientation_of(nodes[constraint.node].parent, locals).conjugate() * rotation;
}

void ConstraintSolver::Compiled::want_point(const Rule& rule, const Locals& locals, const Matrix4d& into,
                                            Transform& local) const {
  local.translation = carried(into, middle_of(rule.constraint, locals));
  if (!rule.constraint.relative) return;
  const Vector3d at_rest =
      mix_vectors(rule.constraint, [&](std::size_t k) { return rule.sources[k].position; });
  local.translation += nodes[rule.constraint.node].rest.translation - carried(rule.parent_inverse, at_rest);
}

void ConstraintSolver::Compiled::want_orient(const Rule& rule, const Locals& locals, Transform& local) const {
  const Constraint& constraint = rule.constraint;
  const Quaterniond& rest = nodes[constraint.node].rest.rotation;
  const Quaterniond into = orientation_of(nodes[constraint.node].parent, locals).conjugate();
  local.rotation = mix_rotations(constraint, rest, [&](std::size_t k) {
    const Quaterniond now = into * orientation_of(constraint.sources[k].node, locals);
    return constraint.relative ? now * rule.sources[k].rotation.conjugate() * rule.parent_rotation * rest
                               : now;
  });
}

void ConstraintSolver::Compiled::want_scale(const Rule& rule, const Locals& locals, Transform& local) const {
  const Constraint& constraint = rule.constraint;
  const Transform& rest = nodes[constraint.node].rest;
  const Vector3d parent = lengths_of(model_of(nodes[constraint.node].parent, locals));
  const Vector3d wanted = mix_vectors(constraint, [&](std::size_t k) -> Vector3d {
    const Vector3d now = lengths_of(model_of(constraint.sources[k].node, locals));
    if (!constraint.relative) return now;
    const Vector3d& before = rule.sources[k].scale;
    return (before.array() > 0).select(now.array() / before.array(), 1) * rule.node.scale.array();
  });
  for (int a = 0; a < 3; ++a)
    if (parent[a] > 0) local.scale[a] = std::copysign(wanted[a] / parent[a], rest.scale[a]);
}

/// False: there is no direction to aim in.
///   parent  its matrix; `into` the inverse of that
/// Of all turns about the direction the one whose up axis goes farthest along up in model space: R y . P'up is most when y is the part
/// of P'up across the direction.
bool ConstraintSolver::Compiled::aim(const Constraint& constraint, const Locals& locals,
                                     const Matrix4d& parent, const Matrix4d& into,
                                     Quaterniond& rotation) const {
  const Transform& own = locals[constraint.node];
  const Vector3d target = carried(into, middle_of(constraint, locals));
  const Vector3d direction = target - own.translation;
  if (!(direction.norm() > flat * (target.norm() + own.translation.norm()))) return false;
  const Vector3d up =
      constraint.up_node < 0
          ? constraint.up
          : Vector3d(origin_of(model_of(constraint.up_node, locals)) - carried(parent, own.translation));
  rotation = aimed(constraint, direction, parent.topLeftCorner<3, 3>().transpose() * up, own.rotation);
  return true;
}

/// What the node would be if it obeyed in full.
Transform ConstraintSolver::Compiled::wanted(const Rule& rule, const Locals& locals) const {
  const Constraint& constraint = rule.constraint;
  Transform local = locals[constraint.node];
  const Transform& rest = nodes[constraint.node].rest;
  if (constraint.kind == Constraint::Kind::limit) return limited(constraint, local);
  if (constraint.relative && sees_rest(constraint, locals)) {
    using Kind = Constraint::Kind;
    const Kind kind = constraint.kind;
    if (kind == Kind::parent || kind == Kind::point) local.translation = rest.translation;
    if (kind == Kind::parent || kind == Kind::orient || kind == Kind::aim) local.rotation = rest.rotation;
    if (kind == Kind::scale) local.scale = rest.scale;
    return local;
  }
  const Matrix4d parent = model_of(nodes[constraint.node].parent, locals);
  Matrix4d into;
  if ((constraint.relative && rule.is_flat) || !invert(parent, into)) return local;
  switch (constraint.kind) {
    case Constraint::Kind::limit:
      break;
    case Constraint::Kind::parent:
      want_parent(rule, locals, into, local);
      break;
    case Constraint::Kind::point:
      want_point(rule, locals, into, local);
      break;
    case Constraint::Kind::orient:
      want_orient(rule, locals, local);
      break;
    case Constraint::Kind::scale:
      want_scale(rule, locals, local);
      break;
    case Constraint::Kind::aim:
      if (aim(constraint, locals, parent, into, local.rotation))
        local.rotation = local.rotation * rule.aim_offset;
      break;
  }
  return local;
}

Transform ConstraintSolver::Compiled::limited(const Constraint& constraint, const Transform& local) const {
  const Transform& rest = nodes[constraint.node].rest;
  Transform kept = local;
  const Vector3d from = constraint.relative ? rest.translation : Vector3d(Vector3d::Zero());
  const Vector3d unit = constraint.relative ? rest.scale : Vector3d(Vector3d::Ones());
  const Quaterniond before = constraint.relative ? rest.rotation : Quaterniond::Identity();
  const bool turns = is_bounded(constraint.rotation);
  const Vector3d now = turns ? axis_turns(before.conjugate() * local.rotation) : Vector3d(Vector3d::Zero());
  Vector3d angles = now;
  for (int a = 0; a < 3; ++a) {
    if (!constraint.axes[a]) continue;
    const double shift = local.translation[a] - from[a],
                 kept_shift = kept_in(constraint.translation[a], shift);
    if (kept_shift != shift) kept.translation[a] = from[a] + kept_shift;
    const double ratio = unit[a] != 0 ? local.scale[a] / unit[a] : 0,
                 kept_ratio = kept_in(constraint.scale[a], ratio);
    if (unit[a] != 0 && kept_ratio != ratio) kept.scale[a] = unit[a] * kept_ratio;
    if (turns) angles[a] = kept_in(constraint.rotation[a], now[a]);
  }
  if (angles != now) kept.rotation = before * rotation_of_turns(angles);
  return kept;
}

void ConstraintSolver::Compiled::apply(const Rule& rule, Locals& locals) const {
  const Constraint& constraint = rule.constraint;
  const double influence = constraint.influence;
  if (influence == 0) return;
  Transform goal = wanted(rule, locals);
  Transform& local = locals[constraint.node];
  using Kind = Constraint::Kind;
  const bool by_axis =
      constraint.kind == Kind::point || constraint.kind == Kind::orient || constraint.kind == Kind::scale;
  const auto obeys = [&](int axis) { return !by_axis || constraint.axes[axis]; };
  for (int a = 0; a < 3; ++a) {
    if (!obeys(a)) goal.translation[a] = local.translation[a];
    if (!obeys(a)) goal.scale[a] = local.scale[a];
  }
  if (constraint.kind == Kind::orient && !(obeys(0) && obeys(1) && obeys(2))) {
    const Quaterniond before =
        constraint.relative ? nodes[constraint.node].rest.rotation : Quaterniond::Identity();
    Vector3d turns = axis_turns(before.conjugate() * local.rotation);
    const Vector3d follow = axis_turns(before.conjugate() * goal.rotation);
    for (int a = 0; a < 3; ++a)
      if (obeys(a)) turns[a] = follow[a];
    goal.rotation = before * rotation_of_turns(turns);
  }
  if (influence == 1) {
    local = goal;
    return;
  }
  local.translation += influence * (goal.translation - local.translation);
  local.scale += influence * (goal.scale - local.scale);
  if (goal.rotation.coeffs() != local.rotation.coeffs())
    local.rotation = local.rotation.slerp(influence, goal.rotation);
}

ConstraintSolver::ConstraintSolver(const Character& character)
    : compiled_(std::make_shared<const Compiled>(character)) {}

bool ConstraintSolver::empty() const {
  return compiled_->rules.empty();
}

const std::vector<int>& ConstraintSolver::nodes() const {
  return compiled_->moved;
}

void ConstraintSolver::apply(std::vector<Transform>& locals) const {
  for (const Compiled::Rule& rule : compiled_->rules) compiled_->apply(rule, locals);
}

std::vector<Eigen::Matrix4d> posed_matrices(const Character& character, const Pose& pose) {
  if (character.constraints.empty() || pose.locals.size() != character.nodes.size())
    return model_matrices(character, pose);
  Pose obeying{ShapeWeights(0), pose.locals};
  ConstraintSolver(character).apply(obeying.locals);
  return model_matrices(character, obeying);
}

}  // namespace mien
