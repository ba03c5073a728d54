#pragma once
/// The built-in human with one of everything that a rig can have besides shapes, joints and skin weights.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mien/character/validate.h"
#include "mien/deform/bind_wires.h"
#include "mien/geometry/lattice.h"
#include "mien/geometry/nurbs_curve.h"
#include "transfer/faces.h"

namespace mien::test {

inline Eigen::RowVector3d landmark_place(const Character& character, int number) {
  return character.parts[0].mesh.positions.row(landmark_vertex(character, number)).cast<double>();
}

/// A weight map around a point, and each vertex's shares of the control points by `shares`.
template <class Shares>
InfluenceBinding bind_around(const Character& character, const Eigen::RowVector3d& centre, double radius,
                             bool framed, const Shares& shares) {
  InfluenceBinding binding;
  if (!framed) binding.offsets.push_back(0);
  const Points& positions = character.parts[0].mesh.positions;
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const Eigen::RowVector3d x = positions.row(v).cast<double>();
    const double away = (x - centre).squaredNorm() / (radius * radius);
    if (away >= 0.99) continue;
    binding.vertices.push_back(static_cast<int>(v));
    binding.weights.push_back(static_cast<float>((1 - away) * (1 - away)));
    if (framed) continue;
    const Eigen::VectorXd row = shares(x);
    for (Eigen::Index c = 0; c < row.size(); ++c)
      if (row[c] > 1e-3) {
        binding.controls.push_back(static_cast<int>(c));
        binding.coefficients.push_back(static_cast<float>(row[c]));
      }
    double sum = 0;
    for (std::size_t e = static_cast<std::size_t>(binding.offsets.back()); e < binding.coefficients.size();
         ++e)
      sum += binding.coefficients[e];
    for (std::size_t e = static_cast<std::size_t>(binding.offsets.back()); e < binding.coefficients.size();
         ++e)
      binding.coefficients[e] /= static_cast<float>(sum);
    binding.offsets.push_back(static_cast<int>(binding.controls.size()));
  }
  return binding;
}

inline void add_objects(Character& human) {
  const int head = find_node(human, "head"), jaw = find_node(human, "jaw");
  InfluenceObject curve;  // along the lower lip
  curve.name = "lipCurve";
  curve.form = NurbsCurve{2, {0, 0, 0, 0.5, 1, 1, 1}, {1, 0.8, 0.8, 1}};
  curve.controls.resize(4, 3);
  for (int c = 0; c < 4; ++c) curve.controls.row(c) = landmark_place(human, std::array{49, 59, 57, 55}[c]);
  curve.carrier = head;
  curve.skin = 0;
  for (int c = 0; c <= 4; ++c) curve.skin_weights.offsets.push_back(c);
  const auto& joints = human.skins[0].joints;
  for (const char* joint : {"lipCornerRight", "lipLower", "lipLower", "lipCornerLeft"}) {
    const auto at = std::find(joints.begin(), joints.end(), find_node(human, joint));
    curve.skin_weights.joints.push_back(static_cast<int>(at - joints.begin()));
    curve.skin_weights.weights.push_back(1);
  }
  const Eigen::RowVector3d left = curve.controls.row(3), right = curve.controls.row(0);
  curve.bindings = {bind_around(
      human, (left + right) / 2, 0.6 * (left - right).norm(), false, [&](const Eigen::RowVector3d& x) {
        const double u = (x - right).dot(left - right) / (left - right).squaredNorm();
        return nurbs_basis(std::get<NurbsCurve>(curve.form), u);
      })};
  InfluenceObject lattice;  // around the chin
  lattice.name = "jawLattice";
  Lattice grid{{3, 3, 2}, {2, 2, 1}};
  lattice.form = grid;
  const Eigen::RowVector3d chin = landmark_place(human, 9);
  const double reach = (left - right).norm();
  Box box;
  box.low = (chin.array() - reach).matrix().transpose();
  box.high = (chin.array() + reach).matrix().transpose();
  lattice.controls = lattice_controls(grid, box);
  lattice.carrier = lattice.node = jaw;
  lattice.bindings = {bind_around(human, chin, 0.9 * reach, false, [&](const Eigen::RowVector3d& x) {
    return lattice_basis(grid, ((x - box.low.transpose()).array() / (2 * reach)).matrix().transpose());
  })};
  InfluenceObject cluster;
  cluster.name = "noseCluster";
  cluster.node = find_node(human, "nose");
  cluster.carrier = head;
  cluster.controls = landmark_place(human, 31);
  cluster.bindings = {bind_around(human, landmark_place(human, 31), 0.5 * reach, true,
                                  [](const Eigen::RowVector3d&) { return Eigen::VectorXd(); })};
  InfluenceObject locator;
  locator.name = "browLocator";
  locator.form = Locator{};
  locator.controls = landmark_place(human, 22);
  human.objects = {curve, lattice, cluster, locator};
}

inline void add_wires(Character& human) {
  Wire wire;
  wire.name = "browWire";
  wire.feature = "brows";
  PointsD points(5, 3);
  for (int k = 0; k < 5; ++k) {
    const int vertex = landmark_vertex(human, 18 + k);
    points.row(k) = human.parts[0].mesh.positions.row(vertex).cast<double>();
    wire.points.push_back({0, -1, vertex});
  }
  wire.curve = fit_bspline(points, {6, {}});
  wire.ranges = {0.25 * (points.row(4) - points.row(0)).norm()};
  human.wires = bind_wires(human, {wire});
}

inline void add_constraints_and_controls(Character& human) {
  Constraint limit;
  limit.name = "jawLimit";
  limit.node = find_node(human, "jaw");
  limit.translation[1] = {-0.01, 0.02};
  limit.rotation[0] = {-0.1, 0.6};
  Constraint aim;
  aim.name = "look";
  aim.kind = Constraint::Kind::aim;
  aim.node = find_node(human, "eyeLeft_joint");
  aim.sources = {{find_node(human, "nose"), 1}};
  aim.up = Eigen::Vector3d::UnitY();
  human.constraints = {limit, aim};
  Control smile, jaw;
  smile.name = "smile";
  smile.region = "mouth";
  smile.sliders = {0};
  jaw.name = "jaw";
  jaw.kind = Control::Kind::joint;
  jaw.node = find_node(human, "jaw");
  human.controls = {smile, jaw};
}

/// Moves of objects and wires in the first shape, and a clip that animates one channel of each kind.
inline void add_motion(Character& human, double length) {
  PointsD moves(4, 3);
  moves << 1, 0, 0, 0, -1, 0, 0, -1, 0.5, -1, 0, 0;
  human.shapes[0].objects = {{0, length * moves}};
  PointsD lift = PointsD::Zero(human.wires[0].curve.control_count(), 3);
  lift.col(1).setConstant(length);
  human.shapes[0].wires = {{0, lift, 0.1, PointsD::Constant(4, 3, 0.05)}};
  using Property = Channel::Property;
  Clip clip;
  clip.name = "everything";
  const auto add = [&](Property property, std::vector<float> values) -> Channel& {
    Channel channel;
    channel.property = property;
    channel.times = {0, 1};
    channel.values = std::move(values);
    clip.channels.push_back(channel);
    return clip.channels.back();
  };
  const auto l = static_cast<float>(length);
  Channel& control = add(Property::object_control, {0, 0, 0, 0, -2 * l, l});
  control.object = 0;
  control.control = 1;
  Channel& wire = add(Property::wire_control, {0, 0, 0, 0, 2 * l, 0});
  wire.wire = 0;
  wire.control = 2;
  add(Property::wire_scale, {0, 0.3f}).wire = 0;
  Channel& turn = add(Property::wire_turn, {0, 0, 0, 0.2f, 0, 0.1f});
  turn.wire = 0;
  turn.control = 1;
  add(Property::slider, {0, 1}).slider = 0;
  const int jaw = find_node(human, "jaw");
  const Eigen::Vector3f rest = human.nodes[jaw].rest.translation.cast<float>();
  add(Property::translation, {rest.x(), rest.y(), rest.z(), rest.x(), rest.y() - l, rest.z() + l}).node = jaw;
  human.clips.push_back(clip);
}

/// Of the human's own objects, wires and constraints nothing is left: what it has here is known.
inline const Character& rigged_human() {
  static const Character human = [] {
    Character character = made("human");
    character.controls.clear();
    for (Shape& shape : character.shapes) {
      shape.objects.clear();
      shape.wires.clear();
    }
    for (Clip& clip : character.clips)
      std::erase_if(clip.channels, [](const Channel& c) {
        return c.moves_wire() || c.property == Channel::Property::object_control;
      });
    add_objects(character);
    add_wires(character);
    add_constraints_and_controls(character);
    const Eigen::RowVector3d left = landmark_place(character, 55), right = landmark_place(character, 49);
    add_motion(character, 0.1 * (left - right).norm());
    return character;
  }();
  return human;
}

/// A mesh without any rig.
inline Character bare(Character character) {
  Character result;
  result.parts = std::move(character.parts);
  for (Part& part : result.parts) {
    part.node = part.skin = -1;
    part.skin_weights = {};
  }
  result.landmarks = std::move(character.landmarks);
  result.curves = std::move(character.curves);
  result.appearance = std::move(character.appearance);
  return result;
}

}  // namespace mien::test
