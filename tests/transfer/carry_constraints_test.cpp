#include "mien/transfer/carry_constraints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/small_rig.h"

namespace mien::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double infinite = std::numeric_limits<double>::infinity();

Constraint limit_of(int node, bool relative) {
  Constraint limit;
  limit.name = "limit";
  limit.node = node;
  limit.relative = relative;
  limit.translation = {ValueRange{-1, 2}, ValueRange{-infinite, 0.5}, ValueRange{}};
  limit.rotation[0] = {-0.1, 0.4};
  return limit;
}

/// `source` with one constraint, its nodes placed by `by`.
Constraint carried(Character source, Constraint constraint, const Similarity& by) {
  source.constraints = {std::move(constraint)};
  Character target = source;
  const CarriedSkeleton skeleton = carry_skeleton(source, of_similarity(by), 0);
  std::copy(skeleton.nodes.begin(), skeleton.nodes.end(), target.nodes.begin());
  std::vector<std::string> dropped;
  const auto constraints = carry_constraints(source, target, rig_map_of(source, by), dropped);
  EXPECT_THAT(dropped, IsEmpty());
  EXPECT_THAT(constraints, SizeIs(1));
  return constraints.at(0);
}

TEST(carry_constraints, what_names_a_node_that_was_not_carried_is_named_and_left_behind) {
  Character source = rig();
  Constraint aim;
  aim.name = "look";
  aim.kind = Constraint::Kind::aim;
  aim.node = 2;
  aim.sources = {{5, 1}, {3, 0.5}};
  Constraint follow = aim;
  follow.name = "follow";
  follow.sources = {{5, 1}};
  source.constraints = {aim, follow, limit_of(5, true)};
  RigMap map = rig_map_of(source, {});
  map.node_of[5] = -1;
  std::vector<std::string> dropped;
  const auto constraints = carry_constraints(source, source, map, dropped);
  EXPECT_THAT(dropped, ElementsAre("constraint look: node Tooth", "constraint follow: node Tooth",
                                   "constraint limit: node Tooth"));
  ASSERT_THAT(constraints, SizeIs(1));
  EXPECT_EQ(constraints[0].name, "look");
  EXPECT_THAT(constraints[0].sources, ElementsAre(ConstraintSource{3, 0.5}));
}

TEST(carry_constraints, translation_limits_grow_as_lengths_do) {
  const Constraint limit = carried(rig(), limit_of(3, true), some_similarity(4));
  EXPECT_EQ(limit.node, 3);
  EXPECT_EQ(limit.translation[0], (ValueRange{-4, 8}));
  EXPECT_EQ(limit.translation[1], (ValueRange{-infinite, 2}));
  EXPECT_EQ(limit.translation[2], ValueRange{});
  EXPECT_EQ(limit.rotation[0], (ValueRange{-0.1, 0.4}));
}

TEST(carry_constraints, absolute_limits_move_with_the_rest) {
  const Character source = rig();
  const Constraint limit = carried(source, limit_of(3, false), some_similarity(4));
  // The chin rests at (0.2, 0, 2) below the jaw, whose frame turned with the face.
  EXPECT_NEAR(limit.translation[0].low, 4 * -1, 1e-9);
  EXPECT_NEAR(limit.translation[0].high, 4 * 2, 1e-9);
  EXPECT_EQ(limit.translation[1].low, -infinite);
  EXPECT_NEAR(limit.translation[1].high, 4 * 0.5, 1e-9);
}

TEST(carry_constraints, limits_of_a_node_without_a_parent_turn_with_the_face) {
  // Y up to Z up: x stays, y becomes z, z becomes -y.
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const Constraint limit = carried(rig(), limit_of(0, true), {3, turn, {1, 2, 3}});
  EXPECT_EQ(limit.translation[0], (ValueRange{-3, 6}));
  EXPECT_EQ(limit.translation[1], ValueRange{});
  EXPECT_EQ(limit.translation[2], (ValueRange{-infinite, 1.5}));
  Constraint follow = limit_of(0, true);
  follow.kind = Constraint::Kind::point;
  follow.sources = {{2, 1}};
  follow.axes = {true, false, false};
  EXPECT_THAT(carried(rig(), follow, {3, turn, {0, 0, 0}}).axes, ElementsAre(true, false, false));
  follow.axes = {false, true, false};
  EXPECT_THAT(carried(rig(), follow, {3, turn, {0, 0, 0}}).axes, ElementsAre(false, false, true));
}

TEST(carry_constraints, an_aim_keeps_its_own_axes_and_turns_its_up) {
  Constraint aim;
  aim.kind = Constraint::Kind::aim;
  aim.node = 2;
  aim.sources = {{3, 1}};
  aim.up = Eigen::Vector3d(0, 0, 1);
  const Similarity by = some_similarity(4);
  const Constraint result = carried(rig(), aim, by);
  EXPECT_EQ(result.aim_axis, aim.aim_axis);
  EXPECT_EQ(result.up_axis, aim.up_axis);
  EXPECT_LT((result.up - by.rotation * aim.up).norm(), 1e-12);
}

TEST(carry_controls, lose_what_they_drove_and_keep_their_mirrors) {
  Character source = rig();
  source.sliders.resize(3);
  Control left, right, lost, jaw;
  left.name = "smile left";
  left.sliders = {0};
  left.mirror = 2;
  lost.name = "frown";
  lost.sliders = {1};
  right.name = "smile right";
  right.sliders = {2};
  right.mirror = 0;
  jaw.name = "jaw";
  jaw.kind = Control::Kind::joint;
  jaw.node = 2;
  source.controls = {left, lost, right, jaw};
  std::vector<std::string> dropped;
  const auto controls = carry_controls(source, {4, -1, 5}, {0, 1, 7, 3, -1, -1}, dropped);
  EXPECT_THAT(dropped, ElementsAre("control frown"));
  ASSERT_THAT(controls, SizeIs(3));
  EXPECT_THAT(controls[0].sliders, ElementsAre(4));
  EXPECT_EQ(controls[0].mirror, 1);
  EXPECT_THAT(controls[1].sliders, ElementsAre(5));
  EXPECT_EQ(controls[1].mirror, 0);
  EXPECT_EQ(controls[2].node, 7);
}

}  // namespace
}  // namespace mien::test
