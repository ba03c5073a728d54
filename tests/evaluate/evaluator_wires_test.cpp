// Wires in compiled evaluators: what the reference makes of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluate/evaluated.h"
#include "evaluate/expectations.h"
#include "evaluate/rigs.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"
#include "mien/evaluate/point_evaluator.h"

namespace mien {
namespace {

using test::all_sets;
using test::evaluated;
using test::joined;
using test::largest_difference;
using test::reach;
using test::same_bytes;
using ::testing::HasSubstr;

TEST(EvaluatorWires, InvalidInputs) {
  const Character character = test::wired_rig(1);
  const auto error_of = [&](const WireMove& move) {
    Pose pose = rest_pose(character);
    pose.wires = {move};
    return test::refusal_of(character, pose);
  };
  EXPECT_THAT(error_of({9, {}, 0, {}}), HasSubstr("wire 9: does not exist"));
  EXPECT_THAT(error_of({0, PointsD::Zero(3, 3), 0, {}}), HasSubstr("is moved by 3 control points"));
  EXPECT_THAT(error_of({1, {}, NAN, {}}), HasSubstr("has a scale that is not finite"));
}

TEST(EvaluatorWires, AgreeWithEvaluate) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Character character = test::wired_rig(seed);
    const Pose pose = test::wired_pose(character, seed);
    const auto exact = joined(evaluate(character, pose));
    for (const InstructionSet set : all_sets) {
      if (!is_supported(set)) continue;
      Evaluator evaluator(character, {DeltaPrecision::exact, set, {}});
      EXPECT_LT(largest_difference(exact, evaluated(evaluator, pose)),
                evaluator_tolerance * reach(character, pose))
          << "seed " << seed << ", " << name_of(set);
    }
  }
}

TEST(EvaluatorWires, CompactDeltasLeaveWiresExact) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Character character = test::wired_rig(seed);
    Pose pose = test::wired_pose(character, seed);
    pose.shape_weights.values.setZero();
    Evaluator evaluator(character, {DeltaPrecision::compact, InstructionSet::best, {}});
    EXPECT_LT(largest_difference(joined(evaluate(character, pose)), evaluated(evaluator, pose)),
              evaluator_tolerance * reach(character, pose));
  }
}

TEST(EvaluatorWires, AtRestNothingMovesBitForBit) {
  const Character character = test::wired_rig(5);
  Pose pose = test::random_pose(character, 5);
  Evaluator evaluator(character);
  const auto still = evaluated(evaluator, pose);
  pose.wires = {{0, PointsD::Zero(character.wires[0].curve.control_count(), 3), 0, {}}, {1, {}, 0, {}}};
  EXPECT_TRUE(same_bytes(still, evaluated(evaluator, pose)));
}

TEST(EvaluatorWires, UpdateGivesWhatEvaluateGives) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Character character = test::wired_rig(seed);
    Evaluator evaluator(character), other(character);
    Pose pose = test::wired_pose(character, seed);
    std::vector<float> kept(3 * evaluator.vertex_count());
    evaluator.update(pose, kept);
    EXPECT_EQ(evaluator.update(pose, kept), 0u);
    for (int step = 0; step < 8; ++step) {
      if (step % 4 == 0) pose.wires[0].scale += 0.1;
      if (step % 4 == 1) pose.wires[1].controls(1, 2) += 0.1;
      if (step % 4 == 2) std::swap(pose.wires[0], pose.wires[1]);
      if (step % 4 == 3) pose.wires.erase(pose.wires.begin());
      if (pose.wires.size() < 2) pose.wires = test::wired_pose(character, seed + 1).wires;
      evaluator.update(pose, kept);
      ASSERT_TRUE(same_bytes(kept, evaluated(other, pose))) << "seed " << seed << ", step " << step;
    }
    pose.wires.clear();
    evaluator.update(pose, kept);
    EXPECT_TRUE(same_bytes(kept, evaluated(other, pose)));
  }
}

TEST(EvaluatorWires, OneWireUpdatesTheBlocksThatItReaches) {
  Character character;
  character.parts.emplace_back();
  character.parts[0].mesh.positions = Points::Random(1600, 3);
  test::Random random(1);
  for (int w = 0; w < 2; ++w) {
    character.wires.push_back(test::random_wire(random, w, 5));
    character.wires[w].bindings = {{0, {7 + 800 * w, 90 + 800 * w}, {1, 0.5f}, {0.2f, 0.7f}}};
  }
  Evaluator evaluator(character);
  std::vector<float> out(3 * 1600);
  Pose pose = rest_pose(character);
  EXPECT_EQ(evaluator.update(pose, out), 100u);
  pose.wires = {{1, PointsD::Ones(5, 3), 0, {}}};
  EXPECT_LE(evaluator.update(pose, out), 2u);
  EXPECT_NEAR(out[3 * 807], character.parts[0].mesh.positions(807, 0) + 1, 1e-6);  // alone, falloff 1
  EXPECT_EQ(out[3 * 7], character.parts[0].mesh.positions(7, 0));
}

TEST(EvaluatorWires, ChosenVerticesAndBakes) {
  const Character character = test::wired_rig(4);
  std::vector<Pose> poses;
  for (unsigned f = 0; f < 11; ++f) poses.push_back(test::wired_pose(character, f));
  poses[4].wires.clear();
  test::expect_bakes_and_choices(character, poses);
}

TEST(EvaluatorWires, ClipsWithWireChannelsBake) {
  Character character = test::wired_rig(2);
  Clip clip;
  clip.name = "wires";
  Channel scale;
  scale.property = Channel::Property::wire_scale;
  scale.wire = 1;
  scale.times = {0, 1};
  scale.values = {0, 0.5f};
  Channel control = scale;
  control.property = Channel::Property::wire_control;
  control.wire = 0;
  control.control = 2;
  control.values = {0, 0, 0, 0.2f, -0.1f, 0.3f};
  clip.channels = {scale, control};
  std::vector<Pose> poses;
  for (int f = 0; f < 10; ++f) poses.push_back(sample_clip(character, clip, 0.1 * f));
  Evaluator evaluator(character);
  const std::size_t size = 3 * evaluator.vertex_count();
  std::vector<float> frames(poses.size() * size);
  evaluator.bake(poses, frames);
  for (std::size_t f = 0; f < poses.size(); ++f) {
    const auto at = frames.begin() + static_cast<std::ptrdiff_t>(f * size);
    EXPECT_LT(largest_difference(joined(evaluate(character, poses[f])),
                                 {at, at + static_cast<std::ptrdiff_t>(size)}),
              evaluator_tolerance * reach(character, poses[f]));
  }
}

TEST(EvaluatorWires, PointsFollowThemAndTheirSlopesToo) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Character character = test::wired_rig(seed);
    const Pose pose = test::wired_pose(character, seed);
    SCOPED_TRACE(seed);
    test::expect_points_follow(character, pose, 1e-6 * reach(character, pose));

    PointEvaluator points(character, test::all_vertices(character));
    const Freedoms freedoms{{0, 3}, {}, {{1, true, true}}};
    Eigen::MatrixXd slopes;
    points.jacobian(pose, freedoms, slopes);
    const double step = 1e-6;
    Pose up = pose, down = pose;
    up.locals[1].rotation = pose.locals[1].rotation * Eigen::AngleAxisd(step, Eigen::Vector3d::UnitY());
    down.locals[1].rotation = pose.locals[1].rotation * Eigen::AngleAxisd(-step, Eigen::Vector3d::UnitY());
    PointsD high, low;
    points.positions(up, high);
    points.positions(down, low);
    for (Eigen::Index i = 0; i < high.size(); ++i)
      EXPECT_NEAR(slopes(i, 3), (high(i / 3, i % 3) - low(i / 3, i % 3)) / (2 * step), 1e-6);
  }
}

}  // namespace
}  // namespace mien
