#include "mien/pose/solve_pins.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"
#include "pose/small_face.h"

namespace mien {
namespace {

using test::pin_at;
using test::small_face;

std::string error_of(const Character& face, const std::vector<Pin>& pins,
                     const SolvePinsOptions& options = {}) {
  try {
    solve_pins(face, pins, rest_rig_pose(face), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(SolvePins, names_what_is_wrong_with_pins) {
  const Character face = small_face(6);
  const Eigen::Vector3d up(0, 0.1, 0);
  Pin pin = pin_at(40, up);
  EXPECT_EQ(error_of(face, {}), "pins: are none; one or more");
  EXPECT_EQ(error_of(Character{}, {pin}),
            "character: has no sliders; shapes, each with its slider, so that pins can move something");
  EXPECT_EQ(error_of(face, {pin, pin_at(144, up)}), "pin 2: vertex 144 is not on part Face; 0 to 143");
  EXPECT_EQ(error_of(face, {pin_at(-1, up)}), "pin 1: vertex -1 is not on part Face; 0 to 143");
  EXPECT_EQ(error_of(face, {pin_at(40, {0, NAN, 0})}),
            "pin 1: has a goal that is not finite; three finite numbers");
  pin.weight = 0;
  EXPECT_EQ(error_of(face, {pin}), "pin 1: has a weight that is not above 0; a finite number above 0");
  pin = pin_at(40, up);
  pin.sliders = {6};
  EXPECT_EQ(error_of(face, {pin}), "pin 1: names slider 6; 0 to 5");
  pin = pin_at(40, up);
  std::get<SurfacePoint>(pin.at).part = 1;
  EXPECT_EQ(error_of(face, {pin}), "pin 1: names part 1; 0 to 0");
  SurfacePoint point;
  point.face = 3;
  point.barycentric = {0.5, 0.6, 0.2};
  pin.at = point;
  EXPECT_EQ(error_of(face, {pin}),
            "pin 1: is off its face; barycentric coordinates that are not negative and sum to 1");
  point.face = 121;
  pin.at = point;
  EXPECT_EQ(error_of(face, {pin}), "pin 1: face 121 is not on part Face; 0 to 120");
  pin.at = JointPoint{0};
  EXPECT_EQ(error_of(face, {pin}), "pin 1: names node 0; there are none");
}

TEST(SolvePins, names_hard_pins_that_contradict_each_other) {
  const Character face = small_face(16);
  Pin first = pin_at(65, {0, 0.1, 0}), second = pin_at(65, {0, 0.1, 0});
  first.hard = second.hard = true;
  EXPECT_EQ(error_of(face, {first, second}), "no error");
  second.goal.y() = 0.2;
  EXPECT_EQ(error_of(face, {first, second}),
            "pin 2: is hard, on the same point as pin 1, and wants it elsewhere; one goal for one point");
  second.axes = held_axes("xz");
  EXPECT_EQ(error_of(face, {first, second}), "no error");
}

TEST(SolvePins, names_what_is_wrong_with_options) {
  const Character face = small_face(6);
  const Pin pin = pin_at(40, {0, 0.1, 0});
  SolvePinsOptions options;
  options.rho = 0;
  EXPECT_EQ(error_of(face, {pin}, options), "rho: is not above 0; 0.001, say");
  options = {};
  options.file_units = FileUnitWeights{0, 0};
  EXPECT_EQ(error_of(face, {pin}, options),
            "alpha and mu: do not hold the sliders; both 0 or more, not both 0");
  options = {};
  options.limits = {{2, 1, 0}};
  EXPECT_EQ(error_of(face, {pin}, options),
            "limits of slider shape2: are upside down; give [low, high] with low <= high");
  options = {};
  options.locked = {17};
  EXPECT_EQ(error_of(face, {pin}, options), "locked: names slider 17; 0 to 5");
  options = {};
  options.stiffness = {1, 2};
  EXPECT_EQ(error_of(face, {pin}, options), "stiffness: is given for 2 sliders; 6, or none");
  options = {};
  options.sparsity = 1;
  EXPECT_EQ(error_of(face, {pin}, options), "sparsity: is not from 0 to below 1; 0.1, say");
}

TEST(SolvePins, names_shapes_that_are_empty_or_zero) {
  Character face = small_face(3);
  for (Shape& shape : face.shapes) shape.parts[0].deltas.setZero();
  EXPECT_EQ(error_of(face, {pin_at(40, {0, 0.1, 0})}),
            "pin 1: cannot be moved: no slider moves the face there; pin a point that a shape moves");
  for (Shape& shape : face.shapes) shape.parts.clear();
  EXPECT_EQ(error_of(face, {pin_at(40, {0, 0.1, 0}), pin_at(41, {0, 0, 0})}),
            "pins: cannot be moved: no slider moves the face there; pin a point that a shape moves");
}

RigPose random_pose(const Character& face, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> uniform(0, 1);
  RigPose pose = rest_rig_pose(face);
  for (double& value : pose.sliders.values) value = uniform(random) < 0.5 ? 0 : uniform(random);
  return pose;
}

/// Eq. 3 solved without limits, from the paper's own matrices.
TEST(SolvePins, is_eq_3_in_the_files_units) {
  const Character face = small_face(8);
  const RigPose start = random_pose(face, 1);
  const Pin pin = pin_at(65, {0.02, -0.03, 0.01});
  SolvePinsOptions options;
  options.file_units = FileUnitWeights{0.1, 0.001};
  for (int s = 0; s < 8; ++s) options.limits.push_back({s, -HUGE_VAL, HUGE_VAL});
  const SolvePinsResult result = solve_pins(face, {pin}, start, options);

  Eigen::MatrixXd b(3, 8);
  for (int s = 0; s < 8; ++s) {
    RigPose one = rest_rig_pose(face);
    one.sliders.values[s] = 1;
    b.col(s) = test::vertex_at(face, one, 65) - test::vertex_at(face, rest_rig_pose(face), 65);
  }
  const Eigen::VectorXd w0 = start.sliders.values, m = b * w0 + pin.goal;
  const Eigen::VectorXd w = (b.transpose() * b + 0.101 * Eigen::MatrixXd::Identity(8, 8))
                                .ldlt()
                                .solve(b.transpose() * m + 0.1 * w0);
  EXPECT_LT((result.pose.sliders.values - w).cwiseAbs().maxCoeff(), 1e-6);  // the face's points are float
}

TEST(SolvePins, pins_at_rest_change_nothing_and_dragging_there_and_back_returns) {
  Character linear = small_face(12), curved = small_face(12);
  test::add_correctives(curved, 10);
  for (const Character* face : {&linear, &curved}) {
    const RigPose start = random_pose(*face, 2);
    const std::vector<Pin> pins{pin_at(40, {0, 0, 0}), pin_at(77, {0, 0, 0})};
    PinSolver solver(*face, pins, start);
    EXPECT_LT((solver.solve().pose.sliders.values - start.sliders.values).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_TRUE(solver.solve().moved.empty());
    const Eigen::Vector3d from = solver.start_positions().row(0).transpose();
    for (const double t : {0.1, 0.5, 3.0, 0.4, 0.0}) {
      solver.set_goal(0, from + t * Eigen::Vector3d(0.1, 0.1, 0.05));
      EXPECT_EQ(solver.solve().moved.empty(), t == 0);
    }
    EXPECT_LT((solver.solve().pose.sliders.values - start.sliders.values).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(SolvePins, the_same_gesture_gives_the_same_weights_in_any_unit_turned_and_moved) {
  const Character face = small_face(10);
  const RigPose start = random_pose(face, 3);
  const Eigen::Vector3d pull(0.05, -0.1, 0.08);
  const Eigen::VectorXd weights = solve_pins(face, {pin_at(53, pull)}, start).pose.sliders.values;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const double scale : {0.01, 1.0, 1000.0}) {
    Character other = face;
    Points& points = other.parts[0].mesh.positions;
    points = (scale * points.cast<double>() * turn.transpose()).cast<float>();
    points.rowwise() += Eigen::RowVector3d(3 * scale, -2 * scale, scale).cast<float>();
    for (Shape& shape : other.shapes)
      shape.parts[0].deltas = (scale * shape.parts[0].deltas.cast<double>() * turn.transpose()).cast<float>();
    const SolvePinsResult result = solve_pins(other, {pin_at(53, scale * turn * pull)}, start);
    EXPECT_LT((result.pose.sliders.values - weights).cwiseAbs().maxCoeff(), 1e-6) << scale;
  }
}

TEST(SolvePins, stays_within_limits_however_far_the_pull) {
  Character face = small_face(12);
  face.sliders[1].minimum = -0.5;
  face.sliders[2].maximum = 1.5;
  SolvePinsOptions options;
  options.locked = {4};
  options.limits = {{5, 0.1, 0.2}};
  for (int seed = 0; seed < 20; ++seed) {
    const RigPose start = random_pose(face, seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    const Eigen::Vector3d pull(10 * normal(random), 10 * normal(random), 10 * normal(random));
    const SolvePinsResult result = solve_pins(face, {pin_at(30 + 4 * seed, pull)}, start, options);
    const Eigen::VectorXd& w = result.pose.sliders.values;
    EXPECT_EQ(w[4], start.sliders.values[4]);
    EXPECT_GE(w[5], 0.1);
    EXPECT_LE(w[5], 0.2);
    for (int s = 0; s < 12; ++s)
      if (s != 5) {
        EXPECT_GE(w[s], face.sliders[s].minimum - 1e-15);
        EXPECT_LE(w[s], face.sliders[s].maximum + 1e-15);
      }
  }
}

TEST(SolvePins, holds_only_the_axes_it_is_told_to) {
  const Character face = small_face(12);
  const RigPose start = rest_rig_pose(face);
  Pin pin = pin_at(65, {0.03, 5, 5});
  pin.axes = held_axes("x");
  SolvePinsResult result = solve_pins(face, {pin}, start);
  const double moved = test::vertex_at(face, result.pose, 65).x() - test::vertex_at(face, start, 65).x();
  EXPECT_GT(moved, 0.01);
  EXPECT_NEAR(result.misses[0], std::abs(moved - 0.03), 1e-6);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 1, 0.3).normalized();
  pin = pin_at(65, {0.02, -0.02, 0});
  pin.axes = held_in_plane(normal);
  result = solve_pins(face, {pin}, start);
  const double in_plane = result.misses[0];
  pin.goal += 7 * normal;  // along the camera's ray: the same gesture
  result = solve_pins(face, {pin}, start);
  EXPECT_NEAR(result.misses[0], in_plane, 1e-9);
}

TEST(SolvePins, meets_hard_pins_and_says_when_they_cannot_be_met) {
  const Character face = small_face(16);
  const RigPose start = rest_rig_pose(face);
  RigPose wanted = start;
  wanted.sliders.values[3] = 0.6;
  wanted.sliders.values[7] = 0.4;
  std::vector<Pin> pins{pin_at(52, test::vertex_at(face, wanted, 52) - test::vertex_at(face, start, 52)),
                        pin_at(80, test::vertex_at(face, wanted, 80) - test::vertex_at(face, start, 80)),
                        pin_at(66, {0.5, 0.5, 0.5})};
  pins[0].hard = pins[1].hard = true;
  SolvePinsResult result = solve_pins(face, pins, start);
  EXPECT_TRUE(result.hard_met);
  EXPECT_LT(result.misses[0], 1e-7);
  EXPECT_LT(result.misses[1], 1e-7);
  EXPECT_GT(result.misses[2], 0.1);

  pins.resize(1);
  pins[0].goal = {4, 0, 0};
  result = solve_pins(face, pins, start);
  EXPECT_FALSE(result.hard_met);
  EXPECT_GT(result.misses[0], 1);
  // The nearest that the limits allow: a soft pin that counts for everything gets no nearer.
  SolvePinsOptions soft;
  soft.rho = 1e-9;
  pins[0].hard = false;
  EXPECT_NEAR(result.misses[0], solve_pins(face, pins, start, soft).misses[0], 1e-6);
}

TEST(SolvePins, moves_few_sliders_when_asked) {
  const Character face = small_face(40);
  const RigPose start = rest_rig_pose(face);
  const Pin pin = pin_at(65, {0.05, 0.05, 0});
  SolvePinsOptions few;
  few.sparsity = 0.5;
  const SolvePinsResult all = solve_pins(face, {pin}, start), sparse = solve_pins(face, {pin}, start, few);
  EXPECT_LT(sparse.moved.size(), all.moved.size() / 2);
  EXPECT_GE(sparse.moved.size(), 1u);
  EXPECT_LT(sparse.misses[0], pin.goal.norm());
}

TEST(SolvePins, moves_one_of_sliders_that_exclude_each_other) {
  const Character face = small_face(20);
  SolvePinsOptions options;
  options.exclusive = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {10, 11, 12}};
  const SolvePinsResult result =
      solve_pins(face, {pin_at(65, {0.1, 0.1, 0}), pin_at(30, {0, 0.1, 0})}, rest_rig_pose(face), options);
  for (const auto& group : options.exclusive) {
    int away = 0;
    for (const int s : group) away += result.pose.sliders.values[s] != 0;
    EXPECT_LE(away, 1);
  }
}

TEST(SolvePins, a_pin_moves_the_sliders_of_its_region_alone) {
  const Character face = small_face(20);
  Pin left = pin_at(64, {0.1, 0, 0}), right = pin_at(66, {0, 0.1, 0});
  left.sliders = {0, 1, 2, 3, 4};
  SolvePinsResult result = solve_pins(face, {left}, rest_rig_pose(face));
  for (const int s : result.moved) EXPECT_LT(s, 5);
  right.sliders = {5, 6, 7};
  result = solve_pins(face, {left, right}, rest_rig_pose(face));
  for (const int s : result.moved) EXPECT_LT(s, 8);
}

TEST(SolvePins, stiff_sliders_move_less) {
  const Character face = small_face(10);
  const Pin pin = pin_at(65, {0.05, 0.05, 0});
  const SolvePinsResult plain = solve_pins(face, {pin}, rest_rig_pose(face));
  SolvePinsOptions options;
  options.stiffness.assign(10, 1.0);
  options.stiffness[plain.moved[0]] = 1e6;
  const SolvePinsResult stiff = solve_pins(face, {pin}, rest_rig_pose(face), options);
  EXPECT_LT(std::abs(stiff.pose.sliders.values[plain.moved[0]]), 1e-3);
}

TEST(SolvePins, correctives_are_solved_for_and_never_worse_than_the_linear_answer) {
  Character face = small_face(16);
  test::add_correctives(face, 60);
  double linear_miss = 0, miss = 0;
  for (int seed = 0; seed < 30; ++seed) {
    const RigPose start = random_pose(face, seed), wanted = random_pose(face, seed + 100);
    std::vector<Pin> pins;
    for (const int v : {40, 65, 90})
      pins.push_back(pin_at(v, test::vertex_at(face, wanted, v) - test::vertex_at(face, start, v)));
    SolvePinsOptions once;
    once.most_solves = 1;
    const SolvePinsResult linear = solve_pins(face, pins, start, once), full = solve_pins(face, pins, start);
    EXPECT_LE(full.objective, linear.objective * (1 + 1e-12));
    EXPECT_LE(full.solves, 8);
    for (std::size_t p = 0; p < pins.size(); ++p) {
      EXPECT_NEAR(full.misses[p],
                  (test::vertex_at(face, full.pose, std::get<SurfacePoint>(pins[p].at).vertex) -
                   test::vertex_at(face, start, std::get<SurfacePoint>(pins[p].at).vertex) - pins[p].goal)
                      .norm(),
                  1e-5);
      linear_miss += linear.misses[p];
      miss += full.misses[p];
    }
  }
  EXPECT_LT(miss, 0.5 * linear_miss);
}

TEST(SolvePins, joints_turn_within_their_limits) {
  Character face = small_face(6);
  test::add_jaw(face);
  DraggedJoint jaw;
  jaw.node = 1;
  jaw.turn_low = {-0.3, 0, 0};
  jaw.turn_high = {0.5, 0, 0};
  SolvePinsOptions options;
  options.joints = {jaw};
  for (int s = 0; s < 6; ++s) options.locked.push_back(s);
  const RigPose start = rest_rig_pose(face);
  RigPose wanted = start;
  wanted.locals[1].rotation = Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitX());
  const int chin = 6;
  const Eigen::Vector3d move = test::vertex_at(face, wanted, chin) - test::vertex_at(face, start, chin);
  SolvePinsResult result = solve_pins(face, {pin_at(chin, move)}, start, options);
  EXPECT_LT(result.misses[0], 0.02 * move.norm());
  EXPECT_LT(result.pose.locals[1].rotation.angularDistance(wanted.locals[1].rotation), 0.01);
  result = solve_pins(face, {pin_at(chin, 20 * move)}, start, options);
  EXPECT_LT(Eigen::AngleAxisd(result.pose.locals[1].rotation).angle(), 0.5 + 1e-9);
  Constraint limit;
  limit.name = "jaw";
  limit.node = 1;
  limit.rotation[0] = {-0.1, 0.2};
  face.constraints = {limit};
  result = solve_pins(face, {pin_at(chin, 20 * move)}, start, options);
  EXPECT_NEAR(Eigen::AngleAxisd(result.pose.locals[1].rotation).angle(), 0.2, 1e-9);
  Pin rest = pin_at(chin, {0, 0, 0});
  result = solve_pins(face, {rest}, start, options);
  EXPECT_EQ(result.pose.locals[1].rotation.coeffs(), start.locals[1].rotation.coeffs());

  Pin joint;  // a pin on the joint itself, which only its shift can move
  joint.at = JointPoint{1};
  joint.goal = {0, -0.1, 0};
  joint.goal_is_move = true;
  options.joints[0].shift_low = {0, -0.2, 0};
  options.joints[0].shift_high = {0, 0, 0};
  result = solve_pins(face, {joint}, start, options);
  EXPECT_NEAR(result.pose.locals[1].translation.y(), -0.1, 0.002);
}

TEST(SolvePins, a_prior_moves_together_what_the_clips_move_together) {
  Character face = small_face(8);
  Clip clip;
  for (const int slider : {2, 5}) {
    Channel channel;
    channel.property = Channel::Property::slider;
    channel.slider = slider;
    channel.times = {0, 1, 2};
    channel.values = {0, 0.8f, 0};
    clip.channels.push_back(channel);
  }
  SolvePinsOptions options;
  options.prior = learn_prior(face, {clip});
  options.prior_strength = 100;
  RigPose start = rest_rig_pose(face), wanted = start;
  wanted.sliders.values[2] = 0.3;
  int vertex = 0;
  for (int v = 0; v < 144; ++v)
    if ((test::vertex_at(face, wanted, v) - test::vertex_at(face, start, v)).norm() >
        (test::vertex_at(face, wanted, vertex) - test::vertex_at(face, start, vertex)).norm())
      vertex = v;
  const Pin pin =
      pin_at(vertex, test::vertex_at(face, wanted, vertex) - test::vertex_at(face, start, vertex));
  const Eigen::VectorXd w = solve_pins(face, {pin}, start, options).pose.sliders.values;
  EXPECT_GT(w[5], 0.5 * w[2]);
  for (const int other : {0, 1, 3, 4, 6, 7}) EXPECT_LT(std::abs(w[other]), 0.5 * w[2]);
  EXPECT_TRUE(solve_pins(face, {pin_at(vertex, {0, 0, 0})}, start, options).moved.empty());
}

TEST(PinSolver, agrees_with_the_function) {
  const Character face = small_face(12);
  const RigPose start = random_pose(face, 5);
  PinSolver solver(face, {pin_at(40, {0, 0, 0}), pin_at(90, {0, 0, 0})}, start);
  const Eigen::Vector3d from = solver.start_positions().row(0).transpose();
  for (const double t : {0.3, 1.0, 2.0}) {
    const Eigen::Vector3d pull = t * Eigen::Vector3d(0.05, -0.05, 0.1);
    solver.set_goal(0, from + pull);
    const SolvePinsResult once = solve_pins(face, {pin_at(40, pull), pin_at(90, {0, 0, 0})}, start);
    EXPECT_LT((solver.solve().pose.sliders.values - once.pose.sliders.values).cwiseAbs().maxCoeff(), 1e-10);
  }
  EXPECT_THROW(solver.set_goal(2, from), Error);
  EXPECT_THROW(solver.set_goal(0, {NAN, 0, 0}), Error);
}

}  // namespace
}  // namespace mien
