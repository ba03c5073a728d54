#include "mien/evaluate/constraints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/rigs.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Kind = Constraint::Kind;
using ::testing::HasSubstr;

/// Model-space coordinates of about 1: what a handful of matrix products rounds.
constexpr double rounding = 1e-12;

enum { root, head, follower, goal, other };

/// root; head and follower on it, turned and shifted; goal and other in model space.
Character small_rig() {
  Character c;
  c.nodes.resize(5);
  const char* names[] = {"root", "head", "follower", "goal", "other"};
  for (int n = 0; n < 5; ++n) c.nodes[n].name = names[n];
  c.nodes[head].parent = c.nodes[follower].parent = root;
  c.nodes[head].rest.translation = {0, 1, 0};
  c.nodes[follower].rest.translation = {0.3, 0.4, 0.1};
  c.nodes[follower].rest.rotation = AngleAxisd(0.4, Vector3d(1, 2, 3).normalized());
  c.nodes[goal].rest.translation = {0.2, 0.5, 3};
  c.nodes[other].rest.translation = {-1, 0.5, 2};
  c.nodes[other].rest.rotation = AngleAxisd(-0.7, Vector3d::UnitY());
  return c;
}

Constraint relation(Kind kind, std::vector<ConstraintSource> sources, bool relative) {
  Constraint c;
  c.name = "relation";
  c.kind = kind;
  c.node = follower;
  c.sources = std::move(sources);
  c.relative = relative;
  return c;
}

std::vector<Transform> rest_of(const Character& character) {
  std::vector<Transform> locals;
  for (const Node& node : character.nodes) locals.push_back(node.rest);
  return locals;
}

std::vector<Transform> obeying(const Character& character, std::vector<Transform> locals) {
  ConstraintSolver(character).apply(locals);
  return locals;
}

Eigen::Matrix4d model_of(const Character& character, const std::vector<Transform>& locals, int node) {
  return model_matrices(character, Pose{ShapeWeights(0), locals})[node];
}

Vector3d origin(const Eigen::Matrix4d& matrix) {
  return matrix.topRightCorner<3, 1>();
}

double angle_between(const Quaterniond& a, const Quaterniond& b) {
  return a.angularDistance(b);
}

bool same(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs() && a.scale == b.scale;
}

/// `locals` with everything turned and shifted as one.
std::vector<Transform> moved_together(const Character& character, std::vector<Transform> locals,
                                      const Quaterniond& turn, const Vector3d& shift) {
  for (std::size_t n = 0; n < locals.size(); ++n)
    if (character.nodes[n].parent < 0) {
      locals[n].translation = turn * locals[n].translation + shift;
      locals[n].rotation = turn * locals[n].rotation;
    }
  return locals;
}

TEST(Constraints, InvalidOnesAreRefused) {
  Character character = small_rig();
  character.constraints = {relation(Kind::aim, {{follower, 1}}, true)};
  const auto error_of = [](const Character& c) -> std::string {
    try {
      ConstraintSolver solver(c);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of(character), HasSubstr("follower depends on follower"));
  character.constraints = {relation(Kind::parent, {{goal, 1}}, true)};
  character.nodes[goal].rest.scale.z() = 0;
  EXPECT_THAT(error_of(character), HasSubstr("has the source goal, which is flat at rest"));
  character.constraints[0].relative = false;
  EXPECT_EQ(error_of(character), "no error");
  character.nodes[root].parent = head;
  EXPECT_THAT(error_of(character), HasSubstr("is its own ancestor"));
}

TEST(Constraints, RelativeOnesKeepTheRestBitForBit) {
  for (const Kind kind : {Kind::parent, Kind::point, Kind::orient, Kind::scale, Kind::aim}) {
    Character character = small_rig();
    character.constraints = {relation(kind, {{goal, 1}, {other, 2}}, true)};
    const std::vector<Transform> rest = rest_of(character);
    EXPECT_TRUE(same(obeying(character, rest)[follower], rest[follower])) << static_cast<int>(kind);
  }
}

TEST(Constraints, NothingChangesWhenAllMovesTogether) {
  const Quaterniond turn(AngleAxisd(1.1, Vector3d(3, 1, -2).normalized()));
  for (const Kind kind : {Kind::parent, Kind::point, Kind::orient, Kind::scale, Kind::aim})
    for (const bool relative : {true, false}) {
      Character character = small_rig();
      character.constraints = {relation(kind, {{goal, 1}, {other, 2}}, relative)};
      character.constraints[0].up_node = head;
      std::vector<Transform> locals = rest_of(character);
      locals[goal].translation += Vector3d(0.3, -0.2, 0.1);
      locals[other].rotation = AngleAxisd(0.9, Vector3d::UnitX()) * locals[other].rotation;
      const Transform here = obeying(character, locals)[follower];
      const Transform there =
          obeying(character, moved_together(character, locals, turn, {5, -3, 2}))[follower];
      EXPECT_NEAR((here.translation - there.translation).norm(), 0, 10 * rounding) << static_cast<int>(kind);
      EXPECT_NEAR(angle_between(here.rotation, there.rotation), 0, 1e-7) << static_cast<int>(kind);
      EXPECT_NEAR((here.scale - there.scale).norm(), 0, rounding) << static_cast<int>(kind);
    }
}

TEST(Constraints, PointFollowsThePosition) {
  Character character = small_rig();
  character.constraints = {relation(Kind::point, {{goal, 1}}, false)};
  std::vector<Transform> locals = rest_of(character);
  locals[root] = {{1, 2, 3}, Quaterniond(AngleAxisd(0.8, Vector3d::UnitZ())), Vector3d(2, 2, 2)};
  EXPECT_NEAR(
      (origin(model_of(character, obeying(character, locals), follower)) - locals[goal].translation).norm(),
      0, rounding);
  // Relative: the root at rest, goal moves by (1, 0, 0), so does the follower.
  character.constraints[0].relative = true;
  locals = rest_of(character);
  locals[goal].translation.x() += 1;
  EXPECT_NEAR((obeying(character, locals)[follower].translation - Vector3d(1.3, 0.4, 0.1)).norm(), 0,
              rounding);
  // Only y obeys: nothing moved along it.
  character.constraints[0].axes = {false, true, false};
  EXPECT_NEAR((obeying(character, locals)[follower].translation - Vector3d(0.3, 0.4, 0.1)).norm(), 0,
              rounding);
}

TEST(Constraints, InfluenceAndSharesAreProportions) {
  Character character = small_rig();
  character.constraints = {relation(Kind::point, {{goal, 1}, {other, 3}}, true)};
  character.constraints[0].influence = 0.5;
  std::vector<Transform> locals = rest_of(character);
  locals[goal].translation.x() += 1;
  locals[other].translation.y() += 1;
  const Vector3d moved = obeying(character, locals)[follower].translation - locals[follower].translation;
  EXPECT_NEAR((moved - Vector3d(0.125, 0.375, 0)).norm(), 0, rounding);
  character.constraints[0].influence = 0;
  EXPECT_TRUE(same(obeying(character, locals)[follower], locals[follower]));
}

TEST(Constraints, OrientFollowsTheTurn) {
  Character character = small_rig();
  character.constraints = {relation(Kind::orient, {{other, 1}}, false)};
  std::vector<Transform> locals = rest_of(character);
  locals[root].rotation = AngleAxisd(0.3, Vector3d::UnitX());
  const Quaterniond absolute(model_of(character, obeying(character, locals), follower).topLeftCorner<3, 3>());
  EXPECT_NEAR(angle_between(absolute, locals[other].rotation), 0, 1e-7);
  // Relative: other turns by t about model axes, the follower's orientation does too.
  character.constraints[0].relative = true;
  const Quaterniond turn(AngleAxisd(0.6, Vector3d(1, -1, 2).normalized()));
  locals = rest_of(character);
  locals[other].rotation = turn * locals[other].rotation;
  EXPECT_NEAR(angle_between(obeying(character, locals)[follower].rotation, turn * locals[follower].rotation),
              0, 1e-7);
}

TEST(Constraints, OrientByOneAxis) {
  Character character = small_rig();
  character.nodes[follower].rest.rotation.setIdentity();
  character.nodes[other].rest.rotation.setIdentity();
  character.constraints = {relation(Kind::orient, {{other, 1}}, true)};
  character.constraints[0].axes = {true, false, false};
  std::vector<Transform> locals = rest_of(character);
  locals[other].rotation = rotation_of_turns({0.5, 0.2, -0.3});
  locals[follower].rotation = rotation_of_turns({0.1, 0.7, 0.4});
  const Vector3d turns = axis_turns(obeying(character, locals)[follower].rotation);
  EXPECT_NEAR((turns - Vector3d(0.5, 0.7, 0.4)).norm(), 0, 1e-10);
}

TEST(Constraints, RotationsAreAveragedWhateverTheirSign) {
  Character character = small_rig();
  for (const int n : {follower, goal, other}) character.nodes[n].rest.rotation.setIdentity();
  character.constraints = {relation(Kind::orient, {{goal, 1}, {other, 1}}, false)};
  std::vector<Transform> locals = rest_of(character);
  locals[goal].rotation = AngleAxisd(0.2, Vector3d::UnitY());
  locals[other].rotation = AngleAxisd(0.8, Vector3d::UnitY());
  for (const double sign : {1., -1.}) {
    locals[other].rotation.coeffs() *= sign;
    EXPECT_NEAR(angle_between(obeying(character, locals)[follower].rotation,
                              Quaterniond(AngleAxisd(0.5, Vector3d::UnitY()))),
                0, 1e-7);
  }
}

TEST(Constraints, ParentCarriesAsAChild) {
  Character character = small_rig();
  character.constraints = {relation(Kind::parent, {{other, 1}}, true)};
  std::vector<Transform> locals = rest_of(character);
  const Eigen::Matrix4d bound =
      model_of(character, locals, other).inverse() * model_of(character, locals, follower);
  locals[other].translation += Vector3d(0.4, 0.1, -2);
  locals[other].rotation = AngleAxisd(2, Vector3d(1, 1, 0).normalized()) * locals[other].rotation;
  locals[root].rotation = AngleAxisd(0.3, Vector3d::UnitX());
  const Eigen::Matrix4d expected = model_of(character, locals, other) * bound;
  const Eigen::Matrix4d found = model_of(character, obeying(character, locals), follower);
  EXPECT_LT((found - expected).norm(), 10 * rounding);
  // Scaled: it goes out with its parent and keeps its own size.
  locals[other].scale.setConstant(3);
  const Eigen::Matrix4d scaled = model_of(character, obeying(character, locals), follower);
  EXPECT_LT((origin(scaled) - origin(model_of(character, locals, other) * bound)).norm(), 10 * rounding);
  EXPECT_NEAR(scaled.col(0).norm(), 1, rounding);
}

TEST(Constraints, ScaleFollows) {
  Character character = small_rig();
  character.constraints = {relation(Kind::scale, {{other, 1}}, true)};
  character.nodes[follower].rest.scale = {1, 2, -1};
  std::vector<Transform> locals = rest_of(character);
  locals[other].scale = {2, 3, 0.5};
  EXPECT_LT((obeying(character, locals)[follower].scale - Vector3d(2, 6, -0.5)).norm(), rounding);
  // The root's scale is the follower's already; in model space it keeps the source's proportion.
  locals[root].scale.setConstant(2);
  EXPECT_LT((obeying(character, locals)[follower].scale - Vector3d(1, 3, -0.25)).norm(), rounding);
  character.constraints[0].relative = false;
  EXPECT_LT((obeying(character, locals)[follower].scale - Vector3d(1, 1.5, -0.25)).norm(), rounding);
  locals[root].scale.x() = 0;  // flat: it stays
  EXPECT_TRUE(same(obeying(character, locals)[follower], locals[follower]));
}

TEST(Constraints, AimPointsAtTheGoal) {
  Character character = small_rig();
  character.constraints = {relation(Kind::aim, {{goal, 1}}, false)};
  std::vector<Transform> locals = rest_of(character);
  locals[root] = {{1, 2, 3}, Quaterniond(AngleAxisd(0.8, Vector3d::UnitZ())), Vector3d(2, 1, 0.5)};
  const Eigen::Matrix4d model = model_of(character, obeying(character, locals), follower);
  const Vector3d wanted = (locals[goal].translation - origin(model)).normalized();
  EXPECT_LT((model.topLeftCorner<3, 3>() * Vector3d::UnitZ()).normalized().cross(wanted).norm(), rounding);
  EXPECT_GT((model.topLeftCorner<3, 3>() * Vector3d::UnitZ()).dot(wanted), 0);
  EXPECT_GT((model.topLeftCorner<3, 3>() * Vector3d::UnitY()).y(), 0);
}

TEST(Constraints, AimKeepsItsOffset) {
  // Straight ahead at rest; the goal turns by 0.3 about y around the follower, so does the follower.
  Character character = small_rig();
  character.nodes[goal].rest.translation = character.nodes[follower].rest.translation + Vector3d(0, 0, 2);
  character.constraints = {relation(Kind::aim, {{goal, 1}}, true)};
  std::vector<Transform> locals = rest_of(character);
  const Quaterniond turn(AngleAxisd(0.3, Vector3d::UnitY()));
  locals[goal].translation = locals[follower].translation + turn * Vector3d(0, 0, 5);
  EXPECT_NEAR(angle_between(obeying(character, locals)[follower].rotation, turn * locals[follower].rotation),
              0, 1e-7);
  // At its own position there is no direction: it stays.
  locals[goal].translation = locals[follower].translation;
  EXPECT_TRUE(same(obeying(character, locals)[follower], locals[follower]));
  // Straight along up: the shortest turn.
  locals[goal].translation = locals[follower].translation + Vector3d(0, 1, 0);
  EXPECT_TRUE(obeying(character, locals)[follower].rotation.coeffs().allFinite());
}

TEST(Constraints, LimitsClampFromRest) {
  Character character = small_rig();
  Constraint limit;
  limit.name = "range";
  limit.node = follower;
  limit.translation[1] = {-0.1, 0.1};
  limit.rotation[0] = {0, 0.5};
  limit.rotation[1] = limit.rotation[2] = {0, 0};
  limit.scale[2] = {1, 2};
  character.constraints = {limit};
  std::vector<Transform> locals = rest_of(character);
  EXPECT_TRUE(same(obeying(character, locals)[follower], locals[follower]));
  const Transform rest = locals[follower];
  locals[follower].translation += Vector3d(3, 3, 3);
  locals[follower].rotation = rest.rotation * rotation_of_turns({0.9, 0.2, -0.4});
  locals[follower].scale = {5, 5, 5};
  const Transform kept = obeying(character, locals)[follower];
  EXPECT_LT((kept.translation - rest.translation - Vector3d(3, 0.1, 3)).norm(), rounding);
  EXPECT_NEAR(angle_between(kept.rotation, rest.rotation * rotation_of_turns({0.5, 0, 0})), 0, 1e-7);
  EXPECT_EQ(kept.scale, Vector3d(5, 5, 2));
  // Within the range: the same bits.
  locals[follower] = rest;
  locals[follower].rotation = rest.rotation * Quaterniond(AngleAxisd(0.25, Vector3d::UnitX()));
  character.constraints[0].rotation[1] = character.constraints[0].rotation[2] = {-1e-6, 1e-6};
  EXPECT_TRUE(same(obeying(character, locals)[follower], locals[follower]));
}

TEST(Constraints, LimitsFromTheParentsFrame) {
  Character character = small_rig();
  Constraint limit;
  limit.name = "range";
  limit.node = follower;
  limit.relative = false;
  limit.translation[0] = {0, 0.2};
  limit.axes = {true, false, true};
  limit.translation[1] = {0, 0.2};  // y does not obey
  character.constraints = {limit};
  const Transform kept = obeying(character, rest_of(character))[follower];
  EXPECT_EQ(kept.translation, Vector3d(0.2, 0.4, 0.1));
}

TEST(Constraints, TurnsPastAQuarterAreReadTheShortWay) {
  for (const Vector3d& turns : {Vector3d(0.2, 1.8, -0.3), Vector3d(-2, 0.4, 1), Vector3d(0.1, -1.9, 0.2)})
    EXPECT_LT((axis_turns(rotation_of_turns(turns)) - turns).norm(), 1e-9);
  const Quaterniond locked = rotation_of_turns({0.4, EIGEN_PI / 2, 0});
  EXPECT_NEAR(angle_between(rotation_of_turns(axis_turns(locked)), locked), 0, 1e-7);
}

TEST(Constraints, EachSeesWhatTheOnesBeforeLeft) {
  Character character = small_rig();
  Constraint first = relation(Kind::point, {{goal, 1}}, true), second = first;
  first.name = "first";
  first.node = other;
  second.name = "second";
  second.sources = {{other, 1}};
  std::vector<Transform> locals = rest_of(character);
  locals[goal].translation.x() += 1;
  character.constraints = {first, second};
  EXPECT_NEAR(obeying(character, locals)[follower].translation.x(), 1.3, rounding);
  character.constraints = {second, first};
  EXPECT_NEAR(obeying(character, locals)[follower].translation.x(), 0.3, rounding);
}

TEST(Constraints, EvaluationObeysThem) {
  Character character = test::random_rig(2);
  const Pose pose = test::random_pose(character, 5);
  Constraint held;
  held.name = "held";
  held.node = 6;
  held.translation[0] = held.translation[1] = held.translation[2] = {0, 0};
  held.rotation[0] = held.rotation[1] = held.rotation[2] = {0, 0};
  held.scale[0] = held.scale[1] = held.scale[2] = {1, 1};
  character.constraints = {held};
  Pose wanted = pose;
  wanted.locals[6] = character.nodes[6].rest;
  const auto obeying = evaluate(character, pose);
  character.constraints.clear();
  const auto expected = evaluate(character, wanted), free = evaluate(character, pose);
  EXPECT_LT((obeying[1] - expected[1]).cwiseAbs().maxCoeff(), 1e-6f);
  EXPECT_GT((obeying[1] - free[1]).cwiseAbs().maxCoeff(), 1e-3f);
}

}  // namespace
}  // namespace mien
