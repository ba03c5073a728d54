#include "mien/deform/dual_quaternion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "mien/core/error.h"
#include "mien/deform/skin.h"

namespace mien {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

Eigen::Matrix4d motion(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation,
                       const Eigen::Vector3d& scale = Eigen::Vector3d::Ones()) {
  return Transform{translation, rotation, scale}.matrix();
}

Eigen::Quaterniond about_x(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
}

/// A ring of radius 1 around x at x = 0, half of joint 0, half of joint 1.
struct Ring {
  PointsD positions{12, 3};
  SkinWeights weights{{0}, {}, {}};
  Ring() {
    for (int v = 0; v < 12; ++v) {
      positions.row(v) << 0, std::cos(v * pi / 6), std::sin(v * pi / 6);
      weights.joints.insert(weights.joints.end(), {0, 1});
      weights.weights.insert(weights.weights.end(), {0.5f, 0.5f});
      weights.offsets.push_back(2 * v + 2);
    }
  }
};

TEST(SkinDualQuaternion, InvalidInputs) {
  const Ring ring;
  try {
    skin_dual_quaternion(ring.positions, ring.weights, {Eigen::Matrix4d::Identity()});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    EXPECT_THAT(error.what(), HasSubstr("name joint 1"));
  }
}

TEST(SkinDualQuaternion, TwistKeepsTheVolume) {
  const Ring ring;
  const std::vector<Eigen::Matrix4d> joints{Eigen::Matrix4d::Identity(),
                                            motion(about_x(0.9 * pi), {0, 0, 0})};
  const PointsD twisted = skin_dual_quaternion(ring.positions, ring.weights, joints);
  const PointsD candy = skin_linear(ring.positions, ring.weights, joints);
  const Eigen::Matrix3d half = about_x(0.45 * pi).toRotationMatrix();
  for (int v = 0; v < 12; ++v) {
    EXPECT_LT((twisted.row(v) - ring.positions.row(v) * half.transpose()).norm(), 1e-12);
    EXPECT_LT(candy.row(v).norm(), 0.2);
  }
}

TEST(SkinDualQuaternion, FullTurnOfAJointFlipsNothing) {
  const Ring ring;
  std::vector<Eigen::Matrix4d> joints(2, Eigen::Matrix4d::Identity());
  const PointsD rest = skin_dual_quaternion(ring.positions, ring.weights, joints);
  // Past a half turn the rotation's quaternion jumps from q to -q: the blend goes the short way round, never through 0.
  for (const double angle : {0.0, 1.2 * pi, 1.9 * pi, 2 * pi, 3.9 * pi}) {
    joints[1] = motion(about_x(angle), {0, 0, 0});
    const PointsD turned = skin_dual_quaternion(ring.positions, ring.weights, joints);
    const Eigen::Matrix3d half = about_x(std::remainder(angle, 2 * pi) / 2).toRotationMatrix();
    for (int v = 0; v < 12; ++v)
      EXPECT_LT((turned.row(v) - ring.positions.row(v) * half.transpose()).norm(), 1e-12) << angle;
  }
}

TEST(SkinDualQuaternion, ReversedQuaternionsAreTheSameMotion) {
  const Eigen::Quaterniond a = about_x(0.3), b(-a.w(), -a.x(), -a.y(), -a.z());
  EXPECT_EQ(antipodal_sign(a.coeffs(), b.coeffs()), -1);
  EXPECT_LT(
      (rigid_matrix(dual_quaternion(a, {1, 2, 3})) - rigid_matrix(dual_quaternion(b, {1, 2, 3}))).norm(),
      1e-15);
}

TEST(SkinDualQuaternion, OneJointGoesWhereItsMatrixTakesIt) {
  std::mt19937 engine(1);
  for (int round = 0; round < 50; ++round) {
    Eigen::Matrix4d joint = Eigen::Matrix4d::Identity();
    for (int i = 0; i < 12; ++i)
      joint(i / 4, i % 4) = static_cast<double>(engine() % 2001) / 1000 - 1;  // mirrors too
    if (round == 0) joint.topLeftCorner<3, 3>().setZero();
    if (round == 1) joint.row(1).setZero();
    const PointsD positions = PointsD::Random(4, 3);
    const PointsD moved =
        skin_dual_quaternion(positions, {{0, 1, 2, 3, 4}, {0, 0, 0, 0}, {1, 1, 1, 1}}, {joint});
    ASSERT_TRUE(moved.allFinite());
    for (int v = 0; v < 4; ++v)
      EXPECT_LT(
          (moved.row(v).transpose() - (joint * positions.row(v).transpose().homogeneous()).head<3>()).norm(),
          1e-12);
  }
}

TEST(SkinDualQuaternion, ScaledJointsBlendTheirStretches) {
  const Ring ring;
  const std::vector<Eigen::Matrix4d> joints{motion(about_x(0), {0, 0, 0}, {1, 2, 2}),
                                            motion(about_x(pi / 2), {0, 0, 0}, {1, 4, 4})};
  const PointsD moved = skin_dual_quaternion(ring.positions, ring.weights, joints);
  const Eigen::Matrix3d half = about_x(pi / 4).toRotationMatrix();
  for (int v = 0; v < 12; ++v)
    EXPECT_LT((moved.row(v) - 3 * ring.positions.row(v) * half.transpose()).norm(), 1e-12);
}

TEST(SkinDualQuaternion, RigidMotionOfAllJointsIsRigid) {
  const Ring ring;
  const Eigen::Matrix4d whole = motion(Eigen::Quaterniond(0.1, 0.7, -0.4, 0.5).normalized(), {3, 4, 5});
  std::vector<Eigen::Matrix4d> joints{motion(about_x(0.2), {0.1, 0, 0}),
                                      motion(about_x(1.7), {0, 0.3, 0}, {1, 1.5, 1})};
  const PointsD before = skin_dual_quaternion(ring.positions, ring.weights, joints);
  for (Eigen::Matrix4d& joint : joints) joint = whole * joint;
  const PointsD after = skin_dual_quaternion(ring.positions, ring.weights, joints);
  for (int v = 0; v < 12; ++v)
    EXPECT_LT((after.row(v).transpose() - (whole * before.row(v).transpose().homogeneous()).head<3>()).norm(),
              1e-12);
}

TEST(SkinDualQuaternion, VertexWithoutInfluencesStays) {
  const PointsD positions = PointsD::Random(2, 3);
  EXPECT_EQ(skin_dual_quaternion(positions, {{0, 0, 0}, {}, {}}, {motion(about_x(1), {1, 1, 1})}), positions);
}

}  // namespace
}  // namespace mien
