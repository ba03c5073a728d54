#include "mien/evaluate/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

Part triangle(const std::string& name) {
  Part part;
  part.name = name;
  part.mesh.positions.resize(3, 3);
  part.mesh.positions << 0.1f, 0.2f, 0.3f, 1, 0, 0, 0, 1, 0;
  part.mesh.faces.push_back({0, 1, 2});
  return part;
}

PartDelta lift(int part) {
  PartDelta delta{part, {1}, Points(1, 3), {}, {}};
  delta.deltas << 0, 0, 1;
  return delta;
}

/// Part 0 stands alone, part 1 hangs on node "head" at (0, 10, 0) under a root scaled by 2; both have "lift".
Character two_parts() {
  Character character;
  Node root, head;
  root.name = "root";
  head.name = "head";
  head.parent = 0;
  root.rest.scale.setConstant(2);
  head.rest.translation = {0, 10, 0};
  character.nodes = {root, head};
  character.parts = {triangle("alone"), triangle("held")};
  character.parts[1].node = 1;
  character.shapes.push_back({"lift", {lift(0), lift(1)}});
  return character;
}

std::string error_of(const Character& character, const Pose& pose) {
  try {
    evaluate(character, pose);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "no error";
}

TEST(Evaluate, InvalidInputs) {
  const Character character = two_parts();
  Pose pose = rest_pose(character);
  pose.locals.pop_back();
  EXPECT_THAT(error_of(character, pose), HasSubstr("pose: has 1 local transforms; 2"));
  pose = rest_pose(character);
  pose.shape_weights = ShapeWeights(std::size_t{5});
  EXPECT_THAT(error_of(character, pose), HasSubstr("shape weights: number 5; 1"));
  pose = rest_pose(character);
  pose.locals[1].translation.x() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(error_of(character, pose), HasSubstr("pose of node head: is not finite"));
  pose = rest_pose(character);
  pose.part_shape_weights.push_back({0, 4, 1.0});
  EXPECT_THAT(error_of(character, pose), HasSubstr("weighs shape 4"));

  Character broken = two_parts();
  broken.parts[0].skin = 3;
  EXPECT_THAT(error_of(broken, rest_pose(broken)), HasSubstr("part alone: names skin 3"));
  broken = two_parts();
  broken.parts[1].node = 9;
  EXPECT_THAT(error_of(broken, rest_pose(broken)), HasSubstr("part held: names node 9"));
  broken = two_parts();
  broken.nodes[0].parent = 1;
  EXPECT_THAT(error_of(broken, rest_pose(broken)), HasSubstr("its own ancestor"));
}

TEST(Evaluate, ZeroWeightsGiveTheNeutralBitForBit) {
  const Character character = two_parts();
  EXPECT_EQ(evaluate(character, rest_pose(character))[0], character.parts[0].mesh.positions);
}

TEST(Evaluate, NodeCarriesItsPart) {
  const Character character = two_parts();
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 0.5;
  const auto posed = evaluate(character, pose);
  EXPECT_EQ(posed[0].row(1), Eigen::RowVector3f(1, 0, 0.5f));
  EXPECT_EQ(posed[1].row(1), Eigen::RowVector3f(2, 20, 1));
}

TEST(Evaluate, PartShapeWeightReplacesThePosesOwn) {
  const Character character = two_parts();
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 0.5;
  pose.part_shape_weights.push_back({0, 0, 0.25});
  const auto posed = evaluate(character, pose);
  EXPECT_EQ(posed[0](1, 2), 0.25f);
  EXPECT_EQ(posed[1](1, 2), 1.f);
}

TEST(Evaluate, MatrixOfANodeAtRestMayShear) {
  Character character = two_parts();
  character.nodes[1].has_matrix = true;
  character.nodes[1].matrix(0, 1) = 1;  // x += y, which no translation, rotation and scale can do
  EXPECT_EQ(evaluate(character, rest_pose(character))[1].row(2), Eigen::RowVector3f(2, 2, 0));
  Pose moved = rest_pose(character);
  moved.locals[1].translation = {1, 0, 0};
  EXPECT_EQ(evaluate(character, moved)[1].row(2), Eigen::RowVector3f(2, 2, 0));
}

TEST(Evaluate, SkinnedPartIgnoresItsNodeAndFollowsItsJoints) {
  Character character = two_parts();
  Part& part = character.parts[1];
  character.skins.push_back({"skin", {1}, {model_matrices(character)[1].inverse()}, true, -1, {}});
  part.skin = 0;
  part.skin_weights = {{0, 1, 2, 3}, {0, 0, 0}, {1, 1, 1}};
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 1;
  EXPECT_LT((evaluate(character, pose)[1].row(1) - Eigen::RowVector3f(1, 0, 1)).norm(), 1e-6);
  pose.locals[1].translation.y() += 1;  // doubled by the root's scale; shapes come before the skin
  EXPECT_LT((evaluate(character, pose)[1].row(1) - Eigen::RowVector3f(1, 2, 1)).norm(), 1e-6);
}

}  // namespace
}  // namespace mien
