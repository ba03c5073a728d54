#include "mien/motion/retarget_joints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Character arm(double length, const Eigen::Quaterniond& root_rotation) {
  Character character;
  Node root, upper, hand;
  root.name = "Root";
  root.rest.rotation = root_rotation;
  upper.name = "Upper";
  upper.parent = 0;
  upper.rest.translation = root_rotation.inverse() * Eigen::Vector3d(length, 0, 0);
  hand.name = "Hand";
  hand.parent = 1;
  hand.rest.translation = root_rotation.inverse() * Eigen::Vector3d(length, 0, 0);
  character.nodes = {root, upper, hand};
  return character;
}

Clip bend(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& root) {
  Channel turn, move;
  turn.property = Channel::Property::rotation;
  turn.node = 1;
  turn.times = {0, 1};
  for (const Eigen::Quaterniond& q : {Eigen::Quaterniond::Identity(), rotation})
    for (int k = 0; k < 4; ++k) turn.values.push_back(static_cast<float>(q.coeffs()[k]));
  move.property = Channel::Property::translation;
  move.node = 0;
  move.times = {0, 1};
  move.values = {
      0, 0, 0, static_cast<float>(root.x()), static_cast<float>(root.y()), static_cast<float>(root.z())};
  return {"bend", {turn, move}, {}};
}

TEST(retarget_joints, bad_input_is_named) {
  const Character source = arm(1, Eigen::Quaterniond::Identity());
  const Clip clip = bend(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
  Character other;
  other.nodes.resize(1);
  other.nodes[0].name = "tail";
  const auto error_of = [&](const Character& target, const std::map<std::string, std::string>& names) {
    try {
      retarget_joints(source, clip, target, names);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error_of(other, {}), HasSubstr("moves no joint that the character has by name"));
  EXPECT_THAT(error_of(other, {{"Foot", "tail"}}), HasSubstr("joint Foot: does not exist in the source"));
  EXPECT_THAT(error_of(other, {{"Hand", "toe"}}), HasSubstr("joint toe: does not exist in the target"));
}

TEST(retarget_joints, a_larger_arm_with_other_axes_makes_the_same_move) {
  const Character source = arm(1, Eigen::Quaterniond::Identity());
  const Eigen::Quaterniond other_axes(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()));
  const Character target = arm(3, other_axes);
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()));
  const Clip clip = bend(rotation, {0.5, 0.25, 0});
  const RetargetJointsResult result = retarget_joints(source, clip, target);
  EXPECT_THAT(result.mapped, ElementsAre("Root -> Root", "Upper -> Upper", "Hand -> Hand"));
  const auto from = model_matrices(source, sample_clip(source, clip, 1));
  const auto to = model_matrices(target, sample_clip(target, result.clip, 1));
  for (int joint = 0; joint < 3; ++joint)
    EXPECT_LT((3 * from[joint].topRightCorner<3, 1>() - to[joint].topRightCorner<3, 1>()).norm(), 1e-5)
        << joint;
}

TEST(retarget_joints, what_drives_nothing_is_listed) {
  const Character source = arm(1, Eigen::Quaterniond::Identity());
  const RetargetJointsResult result =
      retarget_joints(source, bend(Eigen::Quaterniond::Identity(), {1, 0, 0}), source, {{"Root", "Hand"}});
  EXPECT_THAT(result.unmapped, ElementsAre("Upper"));
  EXPECT_THAT(result.mapped, ElementsAre("Root -> Hand"));
}

}  // namespace
}  // namespace mien
