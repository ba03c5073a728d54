#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"
#include "mien/deform/bind_wires.h"
#include "mien/pose/pose_session.h"
#include "mien/pose/solve_pins.h"
#include "pose/small_face.h"

namespace mien {
namespace {

using test::pin_at;
using test::small_face;
using test::vertex_at;

constexpr int start_vertex = 5 * test::grid + 2, near_vertex = 7 * test::grid + 5;

/// The small face with a wire that begins at `start_vertex`.
Character face_with_wire(int shapes, int turns, double scale = 1) {
  Character face = small_face(shapes);
  for (Part& part : face.parts) part.mesh.positions *= static_cast<float>(scale);
  for (Shape& shape : face.shapes)
    for (PartDelta& delta : shape.parts) delta.deltas *= static_cast<float>(scale);
  const Eigen::Vector3d from = face.parts[0].mesh.positions.row(start_vertex).transpose().cast<double>();
  Wire wire;
  wire.name = "wire";
  wire.feature = "middle";
  wire.curve.knots = clamped_knots(5);
  wire.curve.controls.resize(5, 3);
  for (int l = 0; l < 5; ++l)
    wire.curve.controls.row(l) = (from + scale * 0.25 * l * Eigen::Vector3d(1, 0.2, 0)).transpose();
  wire.ranges = {0.8 * scale};
  wire.turn_controls = turns;
  wire.geodesic = false;
  face.wires = bind_wires(face, {wire});
  return face;
}

SolvePinsOptions with_wire(int wire = 0, double stiffness = 1) {
  SolvePinsOptions options;
  options.wires = {{wire, stiffness}};
  return options;
}

std::string error_of(const Character& face, const SolvePinsOptions& options) {
  try {
    solve_pins(face, {pin_at(start_vertex, {0, 0.1, 0})}, rest_rig_pose(face), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(WirePinsInvalid, names_the_wire) {
  const Character face = face_with_wire(3, 0);
  EXPECT_EQ(error_of(face, with_wire(1)), "wires: names wire 1; 0 to 0");
  EXPECT_EQ(error_of(face, with_wire(0, 0)), "stiffness of wire wire: is not above 0; 1, say");
  SolvePinsOptions twice = with_wire();
  twice.wires.push_back({0});
  EXPECT_EQ(error_of(face, twice), "wire wire: is there twice; each wire once");
  Character far = face_with_wire(0, 0);
  far.wires[0].bindings[0] = {0, {143}, {1}, {0}};
  EXPECT_EQ(error_of(far, with_wire()),
            "pin 1: cannot be moved: neither a slider nor a wire moves the face there; pin a point that a "
            "shape moves");
}

// At the curve's beginning f = 1, r = 0 and only the first control point counts: B = range I there, so that it takes g / (1 + rho).
TEST(WirePins, one_pin_on_the_curve_in_closed_form) {
  for (const double scale : {1.0, 100.0}) {
    const Character face = face_with_wire(0, 4, scale);
    SolvePinsOptions options = with_wire();
    options.rho = 0.25;
    const Eigen::Vector3d goal = scale * Eigen::Vector3d(0.1, 0.3, -0.2);
    const SolvePinsResult result =
        solve_pins(face, {pin_at(start_vertex, goal)}, rest_rig_pose(face), options);
    ASSERT_EQ(result.pose.wires.size(), 1u);
    const WireMove& move = result.pose.wires[0];
    EXPECT_LT((move.controls.row(0).transpose() - goal / 1.25).norm(), 1e-6 * scale);
    EXPECT_LT(move.controls.bottomRows(4).norm(), 1e-9 * scale);
    EXPECT_EQ(move.scale, 0);
    EXPECT_LT(move.turns.norm(), 1e-6);
    EXPECT_NEAR(result.misses[0], 0.2 * goal.norm(), 1e-6 * scale);
  }
}

TEST(WirePins, the_evaluated_face_is_where_the_solver_says) {
  Character face = face_with_wire(12, 4);
  RigPose start = rest_rig_pose(face);
  start.sliders.values[1] = 0.3;
  WireMove before;
  before.controls = PointsD::Constant(5, 3, 0.02);
  before.scale = 0.1;
  start.wires = {before};
  const std::vector<Pin> pins{pin_at(start_vertex, {0.02, 0.15, 0}), pin_at(near_vertex, {0, -0.1, 0.05})};
  const PinSolver at_start(face, pins, start, with_wire());
  for (const bool correctives : {false, true}) {
    if (correctives) test::add_correctives(face, 5);
    RigPose from = start;
    const SolvePinsResult result = solve_pins(face, pins, from, with_wire());
    EXPECT_EQ(result.pose.wires.size(), 2u);
    for (std::size_t p = 0; p < pins.size(); ++p) {
      const int vertex = std::get<SurfacePoint>(pins[p].at).vertex;
      const Eigen::Vector3d was = vertex_at(face, start, vertex);
      EXPECT_LT((was - at_start.start_positions().row(static_cast<Eigen::Index>(p)).transpose()).norm(),
                1e-6);
      EXPECT_NEAR((vertex_at(face, result.pose, vertex) - was - pins[p].goal).norm(), result.misses[p], 2e-6);
      EXPECT_LT(result.misses[p], 0.05 * pins[p].goal.norm());
    }
  }
}

TEST(WirePins, wires_stay_unless_asked_for_and_where_nothing_pulls) {
  const Character face = face_with_wire(12, 4);
  RigPose start = rest_rig_pose(face);
  const auto pull = pin_at(start_vertex, {0, 0.1, 0});
  EXPECT_TRUE(solve_pins(face, {pull}, start).pose.wires.empty());
  EXPECT_TRUE(solve_pins(face, {pin_at(start_vertex, {0, 0, 0})}, start, with_wire()).pose.wires.empty());
  Pin region = pull;
  region.sliders = {0};
  EXPECT_TRUE(
      solve_pins(face, {region, pin_at(near_vertex, {0, 0, 0})}, start, with_wire()).pose.wires.empty());
}

TEST(WirePins, a_session_undoes_and_redoes_them) {
  const Character face = face_with_wire(4, 4);
  PoseSession session(face, rest_rig_pose(face), with_wire());
  const int pin = session.add_pin(pin_at(start_vertex, {0, 0, 0}));
  const Eigen::Vector3d from = session.pin_goal(pin);
  session.begin_drag(pin);
  session.drag_to(from + Eigen::Vector3d(0, 0.2, 0));
  session.end_drag();
  const RigPose after = session.pose();
  ASSERT_EQ(after.wires.size(), 1u);
  EXPECT_NEAR(vertex_at(face, after, start_vertex).y() - from.y(), 0.2, 0.005);
  session.undo();
  EXPECT_TRUE(session.pose().wires.empty());
  session.redo();
  EXPECT_EQ(session.pose().wires[0].controls, after.wires[0].controls);
  session.begin_drag(pin);  // a drag there and back
  session.drag_to(from + Eigen::Vector3d(0.3, 0.2, 0));
  session.drag_to(from + Eigen::Vector3d(0, 0.2, 0));
  session.end_drag();
  EXPECT_LT((vertex_at(face, session.pose(), start_vertex) - vertex_at(face, after, start_vertex)).norm(),
            1e-3);
}

}  // namespace
}  // namespace mien
