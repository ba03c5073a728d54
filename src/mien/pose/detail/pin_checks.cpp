#include "mien/pose/detail/pin_checks.h"

#include <Eigen/QR>
#include <cmath>
#include <set>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

std::string range_of(std::size_t count) {
  return count == 0 ? std::string("there are none") : "0 to " + std::to_string(count - 1);
}

void check_index(const std::string& place, const char* what, int index, std::size_t count) {
  if (index < 0 || index >= static_cast<int>(count))
    throw invalid_input(place, std::string("names ") + what + " " + std::to_string(index), range_of(count));
}

bool same_place(const Pin& a, const Pin& b) {
  if (a.at.index() != b.at.index()) return false;
  if (const JointPoint* joint = std::get_if<JointPoint>(&a.at))
    return joint->node == std::get<JointPoint>(b.at).node;
  const SurfacePoint &p = std::get<SurfacePoint>(a.at), &q = std::get<SurfacePoint>(b.at);
  if (p.part != q.part || p.face != q.face) return false;
  return p.face < 0 ? p.vertex == q.vertex
                    : p.corners == q.corners && p.barycentric.isApprox(q.barycentric, 1e-9);
}

/// Whether some point is at both pins' goals along the axes that each holds.
bool agree(const Pin& a, const Pin& b, double tolerance) {
  const int count = a.axes.count + b.axes.count;
  Eigen::MatrixXd rows(count, 3);
  Eigen::VectorXd goals(count);
  for (int i = 0; i < count; ++i) {
    const Pin& pin = i < a.axes.count ? a : b;
    rows.row(i) = pin.axes.directions.row(i < a.axes.count ? i : i - a.axes.count);
    goals[i] = rows.row(i).dot(pin.goal);
  }
  const Eigen::VectorXd nearest = rows.completeOrthogonalDecomposition().solve(goals);
  return (rows * nearest - goals).norm() <= tolerance;
}

void check_slider_list(const Character& character, const char* place, const std::vector<int>& sliders) {
  for (const int slider : sliders) check_index(place, "slider", slider, character.sliders.size());
}

void check_limits(const Character& character, const SliderLimits& limits) {
  check_index("limits", "slider", limits.slider, character.sliders.size());
  if (std::isnan(limits.low) || std::isnan(limits.high) || limits.low > limits.high)
    throw invalid_input("limits of slider " + character.sliders[limits.slider].name, "are upside down",
                        "give [low, high] with low <= high");
}

void check_joint(const Character& character, const DraggedJoint& joint) {
  check_index("joints", "node", joint.node, character.nodes.size());
  const bool ordered = (joint.turn_low.array() <= joint.turn_high.array()).all() &&
                       (joint.shift_low.array() <= joint.shift_high.array()).all();
  if (!ordered)
    throw invalid_input("limits of joint " + character.nodes[joint.node].name, "are upside down",
                        "low <= high");
  if (!(joint.stiffness > 0) || !std::isfinite(joint.stiffness))
    throw invalid_input("stiffness of joint " + character.nodes[joint.node].name, "is not above 0", "1, say");
}

void check_prior(const Character& character, const SliderPrior& prior) {
  const auto count = static_cast<Eigen::Index>(character.sliders.size());
  if (prior.mean.size() != count || prior.precision.rows() != count || prior.precision.cols() != count)
    throw invalid_input("prior", "has " + std::to_string(prior.mean.size()) + " sliders",
                        std::to_string(count) + ", as the character");
  if (!prior.mean.allFinite() || !prior.precision.allFinite())
    throw invalid_input("prior", "is not finite", "finite numbers");
}

void check_wires(const Character& character, const std::vector<DraggedWire>& wires) {
  std::set<int> seen;
  for (const DraggedWire& dragged : wires) {
    check_index("wires", "wire", dragged.wire, character.wires.size());
    const Wire& wire = character.wires[static_cast<std::size_t>(dragged.wire)];
    if (!seen.insert(dragged.wire).second)
      throw invalid_input("wire " + wire.name, "is there twice", "each wire once");
    if (!(dragged.stiffness > 0) || !std::isfinite(dragged.stiffness))
      throw invalid_input("stiffness of wire " + wire.name, "is not above 0", "1, say");
  }
}

}  // namespace

std::string pin_name(std::size_t index) {
  return "pin " + std::to_string(index + 1);
}

void check_surface_point(const Character& character, const SurfacePoint& point, const std::string& place) {
  check_index(place, "part", point.part, character.parts.size());
  const Part& part = character.parts[point.part];
  if (point.face < 0) {
    if (point.vertex < 0 || point.vertex >= static_cast<int>(part.mesh.vertex_count()))
      throw invalid_input(place, "vertex " + std::to_string(point.vertex) + " is not on part " + part.name,
                          range_of(part.mesh.vertex_count()));
    return;
  }
  if (point.face >= static_cast<int>(part.mesh.faces.size()))
    throw invalid_input(place, "face " + std::to_string(point.face) + " is not on part " + part.name,
                        range_of(part.mesh.faces.size()));
  const int corners = static_cast<int>(part.mesh.faces[point.face].size());
  for (const int corner : point.corners)
    if (corner < 0 || corner >= corners)
      throw invalid_input(place, "names corner " + std::to_string(corner), range_of(corners));
  if (!point.barycentric.allFinite() || (point.barycentric.array() < -1e-6).any() ||
      std::abs(point.barycentric.sum() - 1) > 1e-6)
    throw invalid_input(place, "is off its face",
                        "barycentric coordinates that are not negative and sum to 1");
}

void check_pins(const Character& character, const std::vector<Pin>& pins, bool others_move) {
  if (character.sliders.empty() && !others_move)
    throw invalid_input("character", "has no sliders",
                        "shapes, each with its slider, so that pins can move something");
  if (pins.empty()) throw invalid_input("pins", "are none", "one or more");
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const Pin& pin = pins[p];
    const std::string place = pin_name(p);
    if (const SurfacePoint* point = std::get_if<SurfacePoint>(&pin.at))
      check_surface_point(character, *point, place);
    else
      check_index(place, "node", std::get<JointPoint>(pin.at).node, character.nodes.size());
    if (!pin.goal.allFinite())
      throw invalid_input(place, "has a goal that is not finite", "three finite numbers");
    if (!(pin.weight > 0) || !std::isfinite(pin.weight))
      throw invalid_input(place, "has a weight that is not above 0", "a finite number above 0");
    if (pin.axes.count < 1 || pin.axes.count > 3) throw invalid_input(place, "holds no axis", "one to three");
    const Eigen::Matrix3d square = pin.axes.directions * pin.axes.directions.transpose();
    if (!square.topLeftCorner(pin.axes.count, pin.axes.count).isIdentity(1e-6))
      throw invalid_input(place, "has axes that are not perpendicular unit vectors",
                          "held_axes, held_in_plane or held_along");
    check_slider_list(character, place.c_str(), pin.sliders);
  }
}

void check_start(const Character& character, const RigPose& start) {
  if (start.sliders.values.size() != static_cast<Eigen::Index>(character.sliders.size()))
    throw invalid_input("start pose", "has " + std::to_string(start.sliders.values.size()) + " sliders",
                        std::to_string(character.sliders.size()) + ", as the character");
  if (start.locals.size() != character.nodes.size())
    throw invalid_input("start pose", "has " + std::to_string(start.locals.size()) + " local transforms",
                        std::to_string(character.nodes.size()) + ", one a node");
  for (std::size_t s = 0; s < character.sliders.size(); ++s)
    if (!std::isfinite(start.sliders.values[static_cast<Eigen::Index>(s)]))
      throw invalid_input("start value of slider " + character.sliders[s].name, "is not finite",
                          "give a finite number");
}

void check_options(const Character& character, const SolvePinsOptions& options) {
  if (!(options.rho > 0) || !std::isfinite(options.rho))
    throw invalid_input("rho", "is not above 0", "0.001, say");
  if (!(options.decay >= 0) || !std::isfinite(options.decay))
    throw invalid_input("decay", "is negative", "0 or more");
  if (options.file_units) {
    const auto [alpha, mu] = *options.file_units;
    if (!(alpha >= 0 && mu >= 0 && alpha + mu > 0) || !std::isfinite(alpha + mu))
      throw invalid_input("alpha and mu", "do not hold the sliders", "both 0 or more, not both 0");
  }
  if (!options.stiffness.empty() && options.stiffness.size() != character.sliders.size())
    throw invalid_input("stiffness", "is given for " + std::to_string(options.stiffness.size()) + " sliders",
                        std::to_string(character.sliders.size()) + ", or none");
  for (const double stiffness : options.stiffness)
    if (!(stiffness > 0) || !std::isfinite(stiffness))
      throw invalid_input("stiffness", "is not above 0", "1, say");
  if (!(options.sparsity >= 0 && options.sparsity < 1))
    throw invalid_input("sparsity", "is not from 0 to below 1", "0.1, say");
  if (!(options.prior_strength >= 0) || !std::isfinite(options.prior_strength))
    throw invalid_input("prior strength", "is negative", "0 or more");
  if (options.most_solves < 1) throw invalid_input("most solves", "is below 1", "8, say");
  check_slider_list(character, "locked", options.locked);
  for (const SliderLimits& limits : options.limits) check_limits(character, limits);
  for (const std::vector<int>& group : options.exclusive) check_slider_list(character, "exclusive", group);
  for (const DraggedJoint& joint : options.joints) check_joint(character, joint);
  check_wires(character, options.wires);
  if (options.prior) check_prior(character, *options.prior);
}

void check_hard_pins(const std::vector<Pin>& pins, double tolerance) {
  for (std::size_t b = 0; b < pins.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (pins[a].hard && pins[b].hard && same_place(pins[a], pins[b]) && !agree(pins[a], pins[b], tolerance))
        throw invalid_input(pin_name(b),
                            "is hard, on the same point as " + pin_name(a) + ", and wants it elsewhere",
                            "one goal for one point");
}

}  // namespace mien::detail
