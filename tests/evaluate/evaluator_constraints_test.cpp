// Constraints in compiled evaluators: what the reference makes of them, and how points move through them.
#include <gtest/gtest.h>

#include <cstring>

#include "evaluate/evaluated.h"
#include "evaluate/rigs.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"
#include "mien/evaluate/point_evaluator.h"

namespace mien {
namespace {

using test::all_vertices;
using test::evaluated;

PointsD stacked(const std::vector<Points>& parts) {
  Eigen::Index count = 0;
  for (const Points& part : parts) count += part.rows();
  PointsD all(count, 3);
  count = 0;
  for (const Points& part : parts) {
    all.middleRows(count, part.rows()) = part.cast<double>();
    count += part.rows();
  }
  return all;
}

TEST(EvaluatorConstraints, AgreeWithEvaluateAtEveryVertex) {
  for (unsigned seed = 0; seed < 16; ++seed) {
    const Character character = test::constrained_rig(seed);
    Evaluator evaluator(character);
    PointEvaluator points(character, all_vertices(character));
    for (unsigned step = 0; step < 4; ++step) {
      const Pose pose = test::random_pose(character, 10 * seed + step);
      const PointsD exact = stacked(evaluate(character, pose));
      const auto fast = evaluated(evaluator, pose);
      PointsD out;
      points.positions(pose, out);
      ASSERT_EQ(out.rows(), exact.rows());
      const double reach = 1 + exact.cwiseAbs().maxCoeff() + out.cwiseAbs().maxCoeff();
      for (Eigen::Index i = 0; i < exact.size(); ++i) {
        EXPECT_NEAR(fast[static_cast<std::size_t>(i)], exact(i / 3, i % 3), 2 * evaluator_tolerance * reach);
        EXPECT_NEAR(out(i / 3, i % 3), exact(i / 3, i % 3), 1e-7 * reach);
      }
    }
  }
}

TEST(EvaluatorConstraints, UpdatesAndBakesSeeWhatFollows) {
  const Character character = test::constrained_rig(3);
  Evaluator evaluator(character), other(character);
  std::vector<float> kept(3 * evaluator.vertex_count());
  std::vector<Pose> poses;
  Pose pose = test::random_pose(character, 8);
  for (int step = 0; step < 10; ++step) {
    pose.locals[1].rotation = Eigen::AngleAxisd(0.1 * step, Eigen::Vector3d::UnitX());
    poses.push_back(pose);
    evaluator.update(pose, kept);
    const auto all = evaluated(other, pose);
    ASSERT_EQ(std::memcmp(kept.data(), all.data(), 4 * kept.size()), 0) << step;
  }
  std::vector<float> frames(poses.size() * kept.size());
  evaluator.bake(poses, frames);
  EXPECT_EQ(std::memcmp(kept.data(), frames.data() + 9 * kept.size(), 4 * kept.size()), 0);
}

TEST(EvaluatorConstraints, SlopesGoThroughThem) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Character character = test::constrained_rig(seed);
    const Pose pose = test::random_pose(character, seed);
    PointEvaluator points(character, all_vertices(character));
    for (int node = 0; node < 7; ++node) {
      Eigen::MatrixXd slopes;
      points.jacobian(pose, {{1}, {}, {{node, true, true}}}, slopes);
      for (int k = 0; k < 6; ++k) {
        const double step = 1e-5;
        PointsD high, low;
        for (const double sign : {1.0, -1.0}) {
          Pose moved = pose;
          Transform& local = moved.locals[node];
          if (k < 3)
            local.rotation = local.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(
                                                  sign * step, Eigen::Vector3d(Eigen::Vector3d::Unit(k))));
          else
            local.translation[k - 3] += sign * step;
          points.positions(moved, sign > 0 ? high : low);
        }
        const PointsD wanted = (high - low) / (2 * step);
        const double size = 1 + wanted.cwiseAbs().maxCoeff();
        for (Eigen::Index i = 0; i < wanted.size(); ++i)
          ASSERT_NEAR(slopes(i, 1 + k), wanted(i / 3, i % 3), 1e-6 * size)
              << "seed " << seed << ", node " << node << ", column " << k;
      }
    }
  }
}

}  // namespace
}  // namespace mien
