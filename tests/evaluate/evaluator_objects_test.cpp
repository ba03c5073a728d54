// Influence objects in compiled evaluators: what the reference makes of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "character/objects_in_code.h"
#include "evaluate/evaluated.h"
#include "evaluate/expectations.h"
#include "evaluate/rigs.h"
#include "mien/core/error.h"
#include "mien/deform/influence.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"
#include "mien/evaluate/point_evaluator.h"

namespace mien {
namespace {

using test::all_sets;
using test::all_vertices;
using test::evaluated;
using test::joined;
using test::largest_difference;
using test::same_bytes;
using ::testing::HasSubstr;

/// The largest coordinate involved, of what objects add too.
double reach_of_objects(const Character& character, const Pose& pose) {
  double most = test::reach(character, pose);
  const InfluenceField field(character);
  for (const ObjectPose& object :
       field.pose(model_matrices(character, pose), pose.shape_weights, pose.objects)) {
    if (object.moves) most = std::max(most, object.displacements.cwiseAbs().maxCoeff());
    if (object.moves) most = std::max(most, object.frame.cwiseAbs().maxCoeff());
  }
  return most;
}

TEST(EvaluatorObjects, InvalidInputs) {
  const Character with = test::objects_rig(1), without = test::random_rig(1);
  const auto error_of = [](const Character& character, const ObjectMove& move) {
    Pose pose = rest_pose(character);
    pose.objects = {move};
    return test::refusal_of(character, pose);
  };
  EXPECT_THAT(error_of(with, {9, {}}), HasSubstr("object 9: does not exist; one from 0 to 3"));
  EXPECT_THAT(error_of(with, {0, PointsD::Zero(2, 3)}), HasSubstr("is moved by 2 control points"));
  EXPECT_THAT(error_of(with, {0, PointsD::Constant(3, 3, NAN)}), HasSubstr("not finite"));
  EXPECT_THAT(error_of(without, {0, {}}), HasSubstr("the character has no objects"));
}

TEST(EvaluatorObjects, AgreeWithEvaluate) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Character character = test::objects_rig(seed);
    const Pose pose = test::objects_pose(character, seed);
    const auto exact = joined(evaluate(character, pose));
    for (const InstructionSet set : all_sets) {
      if (!is_supported(set)) continue;
      Evaluator evaluator(character, {DeltaPrecision::exact, set, {}});
      const auto rows = evaluated(evaluator, pose);
      EXPECT_LT(largest_difference(exact, rows), evaluator_tolerance * reach_of_objects(character, pose))
          << "seed " << seed << ", " << name_of(set);
      std::vector<float> blocks(48 * evaluator.block_count());
      evaluator.evaluate_blocks(pose, blocks);
      for (std::size_t lane = 0; lane < evaluator.lane_rows().size(); ++lane) {
        const int row = evaluator.lane_rows()[lane];
        for (std::size_t axis = 0; row >= 0 && axis < 3; ++axis)
          EXPECT_EQ(blocks[48 * (lane / 16) + 16 * axis + lane % 16],
                    rows[3 * static_cast<std::size_t>(row) + axis]);
      }
    }
  }
}

TEST(EvaluatorObjects, AtRestNothingMovesBitForBit) {
  const Character character = test::objects_rig(5);
  Character bare = character;
  bare.objects.clear();
  for (Shape& shape : bare.shapes) shape.objects.clear();
  Pose pose = rest_pose(character);
  pose.shape_weights.values[1] = 0.7;
  Evaluator with(character), without(bare);
  EXPECT_TRUE(same_bytes(evaluated(with, pose), evaluated(without, pose)));
}

TEST(EvaluatorObjects, UpdateGivesWhatEvaluateGives) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Character character = test::objects_rig(seed);
    Evaluator evaluator(character), other(character);
    Pose pose = test::objects_pose(character, seed);
    std::vector<float> kept(3 * evaluator.vertex_count());
    evaluator.update(pose, kept);
    EXPECT_EQ(evaluator.update(pose, kept), 0u);
    const std::function<void()> steps[] = {
        [&] { pose.objects[0].controls(1, 2) += 0.1; },
        [&] { pose.shape_weights.values[0] += 0.2; },
        [&] { pose.locals[4].translation.x() += 0.1; },
        [&] {
          pose.part_shape_weights = {{1, 0, 0.9}};
        },
        [&] { pose.objects.clear(); },
        [&] { pose = rest_pose(character); },
        [&] {
          pose.objects = {{3, PointsD::Ones(1, 3)}};
        },
        [&] { pose.objects[0].controls *= 2; },
    };
    for (std::size_t step = 0; step < std::size(steps); ++step) {
      steps[step]();
      evaluator.update(pose, kept);
      ASSERT_TRUE(same_bytes(kept, evaluated(other, pose))) << "seed " << seed << ", step " << step;
    }
  }
}

TEST(EvaluatorObjects, OneObjectUpdatesTheBlocksThatItReaches) {
  Character character;
  character.parts.emplace_back();
  character.parts[0].mesh.positions = Points::Random(1600, 3);
  for (int o = 0; o < 2; ++o) {
    character.objects.push_back(test::line());
    character.objects[o].name += std::to_string(o);
    character.objects[o].carrier = -1;
    character.objects[o].bindings[0].vertices = {7 + 800 * o, 90 + 800 * o, 91 + 800 * o};
  }
  Evaluator evaluator(character);
  std::vector<float> out(3 * 1600);
  Pose pose = rest_pose(character);
  EXPECT_EQ(evaluator.update(pose, out), 100u);
  pose.objects = {{1, PointsD::Ones(2, 3)}};
  EXPECT_LE(evaluator.update(pose, out), 3u);
  EXPECT_NEAR(out[3 * 807], character.parts[0].mesh.positions(807, 0) + 1, 1e-6);
  EXPECT_EQ(out[3 * 7], character.parts[0].mesh.positions(7, 0));
}

TEST(EvaluatorObjects, ChosenVerticesAndBakes) {
  const Character character = test::objects_rig(4);
  std::vector<Pose> poses;
  for (unsigned f = 0; f < 11; ++f) poses.push_back(test::objects_pose(character, f));
  poses[4] = rest_pose(character);
  poses[6].part_shape_weights = {{1, 0, 0.5}, {2, 3, -0.5}};
  test::expect_bakes_and_choices(character, poses);
}

TEST(EvaluatorObjects, PointsFollowThem) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    Character character = test::objects_rig(seed);
    if (seed % 3 == 2) character.constraints = test::constrained_rig(seed).constraints;
    Pose pose = test::objects_pose(character, seed);
    if (seed % 2) pose.part_shape_weights = {{1, 0, 0.9}};
    SCOPED_TRACE(seed);
    test::expect_points_follow(character, pose, 1e-6 * reach_of_objects(character, pose));
  }
}

TEST(EvaluatorObjects, SlopesOfPointsFollowThemToo) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Character character = test::objects_rig(seed);
    if (seed == 4) character.constraints = test::constrained_rig(seed).constraints;
    Pose pose = test::objects_pose(character, seed);
    if (seed % 2) pose.part_shape_weights = {{1, 0, 0.9}};
    SCOPED_TRACE(seed);
    test::expect_jacobian(character, pose, all_vertices(character));
  }
}

TEST(EvaluatorObjects, ShapeRowsAreThePositionsLinearPart) {
  const Character character = test::objects_rig(3);
  test::expect_shape_rows(character, test::objects_pose(character, 3), all_vertices(character), 1e-10);
}

}  // namespace
}  // namespace mien
