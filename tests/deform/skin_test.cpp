#include "mien/deform/skin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "error_of.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

/// Vertices along x from 0 to 2; the first belongs to joint 0, the last to joint 1, the middle to both.
struct Arm {
  PointsD positions{3, 3};
  SkinWeights weights{{0, 1, 3, 4}, {0, 0, 1, 1}, {1.f, 0.5f, 0.5f, 1.f}};
  Skin skin;
  Arm() {
    positions << 0, 0, 0, 1, 0, 0, 2, 0, 0;
    Eigen::Matrix4d elbow = Eigen::Matrix4d::Identity();
    elbow(0, 3) = -1;  // the elbow is at x = 1
    skin = {"arm", {0, 1}, {Eigen::Matrix4d::Identity(), elbow}, true, -1, {}};
  }
};

Eigen::Matrix4d elbow_turned(double angle) {
  Eigen::Matrix4d model = Eigen::Matrix4d::Identity();
  model.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  model(0, 3) = 1;
  return model;
}

TEST(SkinLinear, InvalidInputs) {
  const Arm arm;
  const std::vector<Eigen::Matrix4d> two(2, Eigen::Matrix4d::Identity());
  SkinWeights few = arm.weights;
  few.offsets.pop_back();
  EXPECT_THAT(error_of([&] { skin_linear(arm.positions, few, two); }), HasSubstr("have 3 offsets; 4"));
  SkinWeights far = arm.weights;
  far.joints[2] = 7;
  EXPECT_THAT(error_of([&] { skin_linear(arm.positions, far, two); }), HasSubstr("name joint 7"));
  SkinWeights descending = arm.weights;
  descending.offsets = {0, 3, 1, 4};
  EXPECT_THAT(error_of([&] { skin_linear(arm.positions, descending, two); }),
              HasSubstr("descending offsets"));
  SkinWeights open = arm.weights;
  open.offsets.back() = 3;
  EXPECT_THAT(error_of([&] { skin_linear(arm.positions, open, two); }), HasSubstr("do not cover"));
  Skin skin = arm.skin;
  skin.inverse_bind.pop_back();
  EXPECT_THAT(error_of([&] { joint_matrices(skin, two); }),
              HasSubstr("skin arm: has 1 inverse bind matrices; 2"));
  skin = arm.skin;
  skin.joints[1] = 2;
  EXPECT_THAT(error_of([&] { joint_matrices(skin, two); }), HasSubstr("skin arm: names node 2"));
}

TEST(SkinLinear, BindPoseGivesTheInput) {
  const Arm arm;
  const auto joints = joint_matrices(arm.skin, {Eigen::Matrix4d::Identity(), elbow_turned(0)});
  EXPECT_EQ(skin_linear(arm.positions, arm.weights, joints), arm.positions);
}

TEST(SkinLinear, TwoJointArmBends) {
  const Arm arm;
  const auto joints =
      joint_matrices(arm.skin, {Eigen::Matrix4d::Identity(), elbow_turned(std::numbers::pi / 2)});
  const PointsD bent = skin_linear(arm.positions, arm.weights, joints);
  EXPECT_NEAR((bent.row(0) - Eigen::RowVector3d(0, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((bent.row(1) - Eigen::RowVector3d(1, 0, 0)).norm(), 0, 1e-15);  // on the elbow
  EXPECT_NEAR((bent.row(2) - Eigen::RowVector3d(1, 1, 0)).norm(), 0, 1e-15);
}

TEST(SkinLinear, BlendsMatrices) {
  Arm arm;
  arm.positions(1, 0) = 2;  // half of joint 0 (stays) and half of joint 1 (goes to (1, 1, 0))
  const auto joints =
      joint_matrices(arm.skin, {Eigen::Matrix4d::Identity(), elbow_turned(std::numbers::pi / 2)});
  const PointsD bent = skin_linear(arm.positions, arm.weights, joints);
  EXPECT_NEAR((bent.row(1) - Eigen::RowVector3d(1.5, 0.5, 0)).norm(), 0, 1e-15);
}

TEST(SkinLinear, VertexWithoutInfluencesStays) {
  Arm arm;
  arm.weights = {{0, 0, 0, 0}, {}, {}};
  const std::vector<Eigen::Matrix4d> joints(2, 3 * Eigen::Matrix4d::Identity());
  EXPECT_EQ(skin_linear(arm.positions, arm.weights, joints), arm.positions);
}

TEST(SkinLinear, WeightsAreDividedByTheirSum) {
  Arm arm;
  arm.weights.weights = {0.25f, 0.7f, 0.7f, 2.f};
  const auto joints = joint_matrices(arm.skin, {Eigen::Matrix4d::Identity(), elbow_turned(0)});
  EXPECT_LT((skin_linear(arm.positions, arm.weights, joints) - arm.positions).norm(), 1e-15);
}

TEST(SkinLinear, ManyInfluencesAtAnyThreadCount) {
  const int vertices = 5000, influences = 9;
  PointsD positions = PointsD::Random(vertices, 3);
  SkinWeights weights;
  std::vector<Eigen::Matrix4d> joints;
  for (int j = 0; j < 20; ++j) joints.push_back(elbow_turned(0.1 * j));
  for (int v = 0; v < vertices; ++v) {
    weights.offsets.push_back(v * influences);
    for (int i = 0; i < influences; ++i) {
      weights.joints.push_back((v + 2 * i) % 20);
      weights.weights.push_back(1.f / influences);
    }
  }
  weights.offsets.push_back(vertices * influences);
  set_thread_count(1);
  const PointsD one = skin_linear(positions, weights, joints);
  set_thread_count(0);
  EXPECT_EQ(skin_linear(positions, weights, joints), one);
  const PointsD rigid = skin_linear(positions, weights, std::vector<Eigen::Matrix4d>(20, elbow_turned(0.3)));
  for (int v = 0; v < vertices; ++v) {
    const Eigen::Vector4d moved = elbow_turned(0.3) * positions.row(v).transpose().homogeneous();
    EXPECT_LT((rigid.row(v).transpose() - moved.head<3>()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace mien
