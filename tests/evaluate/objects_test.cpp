#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "character/objects_in_code.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

// Influence objects through the whole evaluation; deform/influence_test.cpp has each step.

namespace mien {
namespace {

using ::testing::HasSubstr;

/// The line bound to the lip; shape "raise" lifts it; part 0 follows the head.
Character rigged() {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  character.objects[0].node = 2;
  PointsD up = PointsD::Zero(2, 3);
  up.col(1).setConstant(2);
  character.shapes[0].objects.push_back({0, up});
  return character;
}

TEST(evaluate_objects, a_slider_moves_the_skin_through_an_object) {
  const Character character = rigged();
  RigPose rig = rest_rig_pose(character);
  const Points rest = evaluate(character, pose_of(character, rig))[0];
  rig.sliders.values[0] = 0.5;
  const Points raised = evaluate(character, pose_of(character, rig))[0];
  EXPECT_LT((raised.row(0) - rest.row(0) - Eigen::RowVector3f(0, 1, 0)).norm(), 1e-6f);
  EXPECT_LT((raised.row(1) - rest.row(1) - Eigen::RowVector3f(0, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_EQ(raised.row(3), rest.row(3));
}

TEST(evaluate_objects, the_head_carries_object_and_skin_alike) {
  const Character character = rigged();
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 1;
  const Points shaped = evaluate(character, pose)[0];
  const Eigen::Matrix4d before = model_matrices(character, pose)[1];
  pose.locals[0].rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY())) * pose.locals[0].rotation;
  pose.locals[1].translation += Eigen::Vector3d(1, 2, 3);
  const Eigen::Matrix4d turn = model_matrices(character, pose)[1] * before.inverse();
  const Points turned = evaluate(character, pose)[0];
  for (int v = 0; v < 4; ++v) {
    const Eigen::Vector3d wanted = (turn * shaped.row(v).transpose().cast<double>().homogeneous()).head<3>();
    EXPECT_LT((turned.row(v).transpose().cast<double>() - wanted).norm(), 2e-6);
  }
}

TEST(evaluate_objects, a_shape_on_one_part_alone_moves_its_objects_there_alone) {
  Character character = rigged();
  character.parts.push_back(character.parts[0]);
  character.objects[0].bindings.push_back(character.objects[0].bindings[0]);
  character.objects[0].bindings[1].part = 1;
  Pose pose = rest_pose(character);
  const auto rest = evaluate(character, pose);
  pose.part_shape_weights.push_back({1, 0, 1.0});
  const auto posed = evaluate(character, pose);
  EXPECT_EQ(posed[0], rest[0]);
  EXPECT_NEAR(posed[1](0, 1) - rest[1](0, 1), 2, 1e-6);
}

TEST(evaluate_objects, constraints_that_act_at_rest_move_nothing) {
  Character character = rigged();
  Constraint constraint;
  constraint.name = "stay";
  constraint.kind = Constraint::Kind::point;
  constraint.node = 2;
  constraint.sources = {{0, 1}};
  constraint.relative = false;
  const Points rest = evaluate(character, rest_pose(character))[0];
  character.constraints.push_back(constraint);
  EXPECT_EQ(evaluate(character, rest_pose(character))[0], rest);
}

TEST(evaluate_objects, a_pose_that_moves_an_unknown_object_is_refused) {
  Pose pose = rest_pose(rigged());
  pose.objects = {{1, PointsD::Zero(2, 3)}};
  try {
    evaluate(rigged(), pose);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("object 1: does not exist; one from 0 to 0"));
  }
}

TEST(sample_clip, object_channels_move_control_points) {
  const Character character = rigged();
  Channel channel;
  channel.property = Channel::Property::object_control;
  channel.object = 0;
  channel.control = 1;
  channel.times = {0, 2};
  channel.values = {0, 0, 0, 2, 4, 6};
  Clip clip{"clip", {channel}, {}};
  const Pose pose = sample_clip(character, clip, 1);
  ASSERT_EQ(pose.objects.size(), 1u);
  PointsD wanted = PointsD::Zero(2, 3);
  wanted.row(1) << 1, 2, 3;
  EXPECT_EQ(pose.objects[0].controls, wanted);
  EXPECT_EQ(sample_rig(character, clip, 1).objects[0].controls, wanted);
  clip.channels[0].control = 2;
  try {
    sample_clip(character, clip, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("animates control point 2 of object line; one from 0 to 1"));
  }
}

}  // namespace
}  // namespace mien
