// What the built-in human's joints obey.

#include "mien/evaluate/constraints.h"

#include <gtest/gtest.h>

#include "mien/evaluate/evaluate.h"
#include "sample/made.h"

namespace mien::test {
namespace {

bool same(const std::vector<Transform>& a, const std::vector<Transform>& b) {
  for (std::size_t n = 0; n < a.size(); ++n)
    if (a[n].rotation.coeffs() != b[n].rotation.coeffs() || a[n].translation != b[n].translation)
      return false;
  return a.size() == b.size();
}

TEST(HumanConstraints, LeaveRestAndTalkAlone) {
  const Character& human = made("human");
  EXPECT_EQ(human.constraints.size(), 3u);
  const ConstraintSolver constraints(human);
  for (double seconds = -1; seconds <= human.clips[0].duration(); seconds += 1. / 60) {
    const Pose pose = seconds < 0 ? rest_pose(human) : sample_clip(human, human.clips[0], seconds);
    std::vector<Transform> locals = pose.locals;
    constraints.apply(locals);
    EXPECT_TRUE(same(locals, pose.locals)) << seconds;
  }
}

TEST(HumanConstraints, TheJawOpensNoFurther) {
  const Character& human = made("human");
  Pose pose = rest_pose(human);
  const auto jaw = static_cast<std::size_t>(find_node(human, "jaw"));
  pose.locals[jaw].rotation = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX());
  ConstraintSolver(human).apply(pose.locals);
  EXPECT_NEAR(Eigen::AngleAxisd(pose.locals[jaw].rotation).angle(), 32 * EIGEN_PI / 180, 1e-12);
}

}  // namespace
}  // namespace mien::test
