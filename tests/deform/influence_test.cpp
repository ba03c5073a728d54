#include "mien/deform/influence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "character/objects_in_code.h"
#include "error_of.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

PointsD neutral(const Character& character) {
  return character.parts[0].mesh.positions.cast<double>();
}

/// Part 0 with what its objects do.
PointsD influenced(const Character& character, const Pose& pose) {
  const InfluenceField field(character);
  PointsD positions = neutral(character);
  field.add(0, field.pose(model_matrices(character, pose), pose.shape_weights, pose.objects), positions);
  return positions;
}

Pose turned(const Character& character, int node, const Eigen::Vector3d& axis, double angle) {
  Pose pose = rest_pose(character);
  pose.locals[static_cast<std::size_t>(node)].rotation =
      pose.locals[static_cast<std::size_t>(node)].rotation *
      Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
  pose.locals[static_cast<std::size_t>(node)].translation += 0.3 * axis;
  return pose;
}

Eigen::Matrix4d motion_since_rest(const Character& character, const Pose& pose, int node) {
  return model_matrices(character, pose)[static_cast<std::size_t>(node)] *
         model_matrices(character)[static_cast<std::size_t>(node)].inverse();
}

Eigen::RowVector3d moved(const Eigen::Matrix4d& motion, const Eigen::RowVector3d& point) {
  return (motion.topRows<3>() * point.transpose().homogeneous()).transpose();
}

TEST(influence, invalid_inputs) {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  const InfluenceField field(character);
  const auto model = model_matrices(character);
  const ShapeWeights weights(std::size_t{1});
  std::vector<ObjectMove> moves{{1, PointsD::Zero(2, 3)}};
  EXPECT_THAT(error_of([&] { field.pose(model, weights, moves); }),
              HasSubstr("object 1: does not exist; one from 0 to 0"));
  moves = {{0, PointsD::Zero(3, 3)}};
  EXPECT_THAT(error_of([&] { field.pose(model, weights, moves); }),
              HasSubstr("object line: is moved by 3 control points; 2"));
  moves = {{0, PointsD::Constant(2, 3, NAN)}};
  EXPECT_THAT(error_of([&] { field.pose(model, weights, moves); }), HasSubstr("not finite"));
  EXPECT_THAT(error_of([&] { field.pose({}, weights, {}); }), HasSubstr("pose: has 0 matrices; 3"));
  EXPECT_THAT(error_of([&] { field.pose(model, ShapeWeights(std::size_t{2}), {}); }),
              HasSubstr("shape weights: number 2; 1"));
  EXPECT_THAT(error_of([&] { field.motion_of(0, 3, model); }), HasSubstr("object line: names node 3"));
  PointsD few = PointsD::Zero(2, 3);
  moves = {{0, PointsD::Ones(2, 3)}};
  const auto poses = field.pose(model, weights, moves);
  EXPECT_THAT(error_of([&] { field.add(0, poses, few); }),
              HasSubstr("part 0: has 2 positions; one a vertex"));
  EXPECT_THAT(error_of([&] { field.add(1, poses, few); }), HasSubstr("part 1: does not exist"));
  EXPECT_THAT(error_of([&] { field.add(0, {}, few); }), HasSubstr("pose: has 0 objects; 1"));
  character.objects[0].bindings[0].vertices[2] = 9;
  EXPECT_THAT(error_of([&] { InfluenceField broken(character); }), HasSubstr("vertex 9: is out of range"));
}

TEST(influence, at_rest_nothing_changes_by_a_bit) {
  Character character = test::head_and_lip();
  character.objects = {test::line(), test::frame(Cluster{})};
  character.objects[0].skin = 0;
  character.objects[0].skin_weights = {{0, 2, 3}, {0, 1, 1}, {0.3f, 0.7f, 1}};
  character.shapes[0].objects.push_back({0, PointsD::Ones(2, 3)});
  EXPECT_EQ(influenced(character, rest_pose(character)), neutral(character));
  // Nor when the bind pose is another one.
  character.skins[0].inverse_bind[0] *= 1.5;
  EXPECT_EQ(influenced(character, rest_pose(character)), neutral(character));
  // Nor when the head turns with all that hangs on it.
  EXPECT_EQ(influenced(character, turned(character, 1, {1, 2, 0}, 0.8)), neutral(character));
  EXPECT_EQ(influenced(character, turned(character, 0, {0, 2, 1}, -0.4)), neutral(character));
}

TEST(influence, control_points_move_their_vertices_by_their_shares) {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  PointsD shape(2, 3), extra(2, 3);
  shape << 0, 2, 0, 0, 0, 0;
  extra << 0, 0, 1, 3, 0, 0;
  character.shapes[0].objects.push_back({0, shape});
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 0.5;
  pose.objects = {{0, extra}, {0, extra}};
  PointsD wanted = neutral(character);
  wanted.row(0) += Eigen::RowVector3d(0, 1, 2);
  wanted.row(1) += 0.5 * (0.5 * Eigen::RowVector3d(0, 1, 2) + 0.5 * Eigen::RowVector3d(6, 0, 0));
  wanted.row(2) += Eigen::RowVector3d(6, 0, 0);
  EXPECT_LT((influenced(character, pose) - wanted).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(influence, is_linear_in_displacements_in_any_pose) {
  Character character = test::head_and_lip();
  character.objects = {test::line(), test::frame(Locator{})};
  character.objects[0].skin = 0;
  character.objects[0].skin_weights = {{0, 2, 3}, {0, 1, 1}, {0.3f, 0.7f, 1}};
  Pose pose = turned(character, 2, {1, 1, 0}, 0.5);
  const PointsD rest = influenced(character, pose);
  const auto effect = [&](double share) {
    pose.objects = {{0, share * PointsD::Constant(2, 3, 0.7)}, {1, share * PointsD::Constant(1, 3, -0.2)}};
    return PointsD(influenced(character, pose) - rest);
  };
  EXPECT_GT(effect(1).norm(), 0.5);
  EXPECT_LT((effect(3) - 3 * effect(1)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(influence, joints_carry_control_points_seen_from_the_carrier) {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  InfluenceObject& object = character.objects[0];
  object.skin = 0;
  object.skin_weights = {{0, 1, 3}, {1, 0, 1}, {1, 0.25f, 0.75f}};
  const Pose pose = turned(character, 2, {1, 0, 1}, 0.6);
  const Eigen::Matrix4d lip = motion_since_rest(character, pose, 2);
  const Eigen::RowVector3d first = moved(lip, object.controls.row(0)) - object.controls.row(0);
  const Eigen::RowVector3d second = 0.75 * (moved(lip, object.controls.row(1)) - object.controls.row(1));
  PointsD wanted = neutral(character);
  wanted.row(0) += first;
  wanted.row(1) += 0.25 * (first + second);
  wanted.row(2) += second;
  EXPECT_LT((influenced(character, pose) - wanted).cwiseAbs().maxCoeff(), 1e-14);

  // The same lip under a turned head: in the bind pose the same displacement.
  Pose both = turned(character, 1, {0, 1, 0}, 0.9);
  both.locals[2] = pose.locals[2];
  EXPECT_LT((influenced(character, both) - wanted).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(influence, a_node_moves_its_object_as_one_after_the_joints) {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  character.objects[0].node = 2;
  Pose pose = turned(character, 2, {0, 1, 1}, 0.4);
  pose.objects = {{0, PointsD::Constant(2, 3, 0.5)}};
  const Eigen::Matrix4d lip = motion_since_rest(character, pose, 2);
  const Eigen::RowVector3d end = character.objects[0].controls.row(1);
  const Eigen::RowVector3d wanted = moved(lip, end.array() + 0.5) - end;
  EXPECT_LT((influenced(character, pose).row(2) - neutral(character).row(2) - wanted).norm(), 1e-14);
}

TEST(influence, clusters_and_locators_move_vertices_as_a_frame_does) {
  for (const InfluenceForm& form : {InfluenceForm(Cluster{}), InfluenceForm(Locator{})}) {
    Character character = test::head_and_lip();
    character.objects = {test::frame(form)};
    Pose pose = turned(character, 2, {1, 0, 0}, 1.1);
    const Eigen::Matrix4d lip = motion_since_rest(character, pose, 2);
    PointsD wanted = neutral(character);
    wanted.row(1) = moved(lip, wanted.row(1));
    wanted.row(3) += 0.25 * (moved(lip, wanted.row(3)) - wanted.row(3));
    EXPECT_LT((influenced(character, pose) - wanted).cwiseAbs().maxCoeff(), 1e-14);
    // Its point dragged by hand: everything bound to it goes along.
    pose = rest_pose(character);
    pose.objects = {{0, PointsD::Constant(1, 3, 2)}};
    wanted = neutral(character);
    wanted.row(1).array() += 2;
    wanted.row(3).array() += 0.5;
    EXPECT_LT((influenced(character, pose) - wanted).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST(influence, objects_add_up_in_any_order) {
  Character character = test::head_and_lip();
  character.objects = {test::line(), test::frame(Cluster{})};
  Pose pose = turned(character, 2, {1, 0, 0}, 1.1);
  pose.objects = {{0, PointsD::Constant(2, 3, 0.4)}};
  const PointsD both = influenced(character, pose);
  std::swap(character.objects[0], character.objects[1]);
  pose.objects[0].object = 1;
  EXPECT_LT((influenced(character, pose) - both).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(influence, a_bind_pose_of_its_own_is_taken_into_account) {
  Character character = test::head_and_lip();
  // The skin was bound to a head that stood elsewhere: at rest it takes bound points by `to_rest`.
  Eigen::Matrix4d to_rest = Eigen::Matrix4d::Identity();
  to_rest.topLeftCorner<3, 3>() =
      1.5 * Eigen::AngleAxisd(0.7, Eigen::Vector3d(0, 1, 1).normalized()).toRotationMatrix();
  to_rest.topRightCorner<3, 1>() << 4, -1, 2;
  for (Eigen::Matrix4d& inverse : character.skins[0].inverse_bind) inverse = inverse * to_rest;
  character.objects = {test::frame(Cluster{})};
  const Pose pose = turned(character, 2, {1, 1, 0}, 0.8);
  // As skinned by the head, the vertex goes where the lip's motion takes it from where it rests.
  const auto rest = model_matrices(character);
  const Eigen::Matrix4d head = model_matrices(character, pose)[1] * character.skins[0].inverse_bind[0];
  const Eigen::RowVector3d resting =
      moved(rest[1] * character.skins[0].inverse_bind[0], neutral(character).row(1));
  const Eigen::RowVector3d posed = moved(head, influenced(character, pose).row(1));
  EXPECT_LT((posed - moved(motion_since_rest(character, pose, 2), resting)).norm(), 1e-12);
}

TEST(influence, parts_held_by_a_node_are_moved_in_their_own_space) {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  character.parts[0].skin = -1;
  character.parts[0].skin_weights = {};
  character.parts[0].node = 1;
  Pose pose = rest_pose(character);
  pose.objects = {{0, PointsD::Constant(2, 3, 1)}};
  const Eigen::Matrix4d held = model_matrices(character)[1];
  const Eigen::RowVector3d shift =
      moved(held, influenced(character, pose).row(0)) - moved(held, neutral(character).row(0));
  EXPECT_LT((shift - Eigen::RowVector3d::Ones()).norm(), 1e-14);

  character.objects = {test::frame(Cluster{})};
  pose = turned(character, 2, {1, 1, 0}, 0.8);
  const Eigen::RowVector3d there = moved(held, influenced(character, pose).row(1));
  EXPECT_LT(
      (there - moved(motion_since_rest(character, pose, 2), moved(held, neutral(character).row(1)))).norm(),
      1e-13);
}

TEST(influence, nodes_scaled_to_nothing_give_no_nan) {
  Character character = test::head_and_lip();
  character.objects = {test::line(), test::frame(Cluster{})};
  character.objects[0].node = 2;
  Pose pose = turned(character, 2, {1, 1, 0}, 0.8);
  pose.locals[1].scale.setZero();
  EXPECT_TRUE(influenced(character, pose).allFinite());
  character.nodes[2].rest.scale.setZero();
  EXPECT_TRUE(influenced(character, pose).allFinite());
}

}  // namespace
}  // namespace mien
