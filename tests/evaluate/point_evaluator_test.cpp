#include "mien/evaluate/point_evaluator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "error_of.h"
#include "evaluate/expectations.h"
#include "evaluate/rigs.h"
#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/load.h"

namespace mien {
namespace {

using test::all_freedoms;
using test::error_of;
using test::expect_jacobian;
using ::testing::HasSubstr;

SurfacePoint at_vertex(int part, int vertex) {
  return {part, -1, vertex, {1, 0, 0}, {0, 1, 2}};
}

/// Some vertices and a point in the middle of a face of every part.
std::vector<SurfacePoint> some_points(const Character& character) {
  std::vector<SurfacePoint> points;
  for (int p = 0; p < static_cast<int>(character.parts.size()); ++p) {
    const int vertices = static_cast<int>(character.parts[p].mesh.vertex_count());
    for (int v = 0; v < vertices; v += std::max(1, vertices / 7)) points.push_back(at_vertex(p, v));
    points.push_back({p, 0, -1, {0.2, 0.5, 0.3}, {0, 1, 2}});
  }
  return points;
}

TEST(PointEvaluator, InvalidInputs) {
  const Character character = test::random_rig(1);
  EXPECT_THAT(error_of([&] { PointEvaluator(character, {at_vertex(9, 0)}); }),
              HasSubstr("point 0: is on part 9"));
  EXPECT_THAT(error_of([&] {
                PointEvaluator(character, {at_vertex(0, 0), at_vertex(0, 999)});
              }),
              HasSubstr("point 1: is on vertex 999"));
  EXPECT_THAT(error_of([&] {
                PointEvaluator(character, {{0, 999, -1, {1, 0, 0}, {0, 1, 2}}});
              }),
              HasSubstr("point 0: is on face 999"));
  EXPECT_THAT(error_of([&] {
                PointEvaluator(character, {{0, 0, -1, {1, 0, 0}, {0, 1, 7}}});
              }),
              HasSubstr("point 0: names corner 7"));
  EXPECT_THAT(error_of([&] {
                PointEvaluator(character, {{0, 0, -1, {NAN, 0, 0}, {0, 1, 2}}});
              }),
              HasSubstr("not finite"));
  Character broken = character;
  broken.parts[0].skin = 5;
  EXPECT_THAT(error_of([&] { PointEvaluator(broken, {at_vertex(0, 0)}); }), HasSubstr("names skin 5"));

  PointEvaluator evaluator(character, some_points(character));
  PointsD out;
  Pose pose = rest_pose(character);
  pose.locals.pop_back();
  EXPECT_THAT(error_of([&] { evaluator.positions(pose, out); }), HasSubstr("local transforms"));
  Eigen::MatrixXd jacobian;
  EXPECT_THAT(error_of([&] {
                evaluator.jacobian(rest_pose(character), {{99}, {}, {}}, jacobian);
              }),
              HasSubstr("freedoms: name shape 99"));
  EXPECT_THAT(error_of([&] {
                evaluator.jacobian(rest_pose(character), {{}, {}, {{99}}}, jacobian);
              }),
              HasSubstr("freedoms: name node 99"));
}

TEST(PointEvaluator, NoPoints) {
  const Character character = test::random_rig(1);
  PointEvaluator evaluator(character, {});
  PointsD out;
  evaluator.positions(rest_pose(character), out);
  EXPECT_EQ(out.rows(), 0);
}

TEST(PointEvaluator, AgreesWithEvaluate) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Character character = test::random_rig(seed);
    const Pose pose = test::random_pose(character, seed);
    const auto points = some_points(character);
    PointEvaluator evaluator(character, points);
    PointsD out;
    evaluator.positions(pose, out);
    const auto posed = evaluate(character, pose);
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector3d whole =
          position_of(character.parts[points[p].part].mesh, posed[points[p].part], points[p]);
      EXPECT_LT((out.row(static_cast<Eigen::Index>(p)).transpose() - whole).norm(), 1e-5) << "seed " << seed;
    }
  }
}

TEST(PointEvaluator, JacobianIsTheSlope) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Character character = test::random_rig(seed);
    expect_jacobian(character, rest_pose(character), some_points(character));
    expect_jacobian(character, test::random_pose(character, seed), some_points(character));
  }
}

/// Under joints that flatten and crush what is below them.
Pose crushed(const Character& character) {
  Pose pose = test::random_pose(character, 4);
  pose.locals[0].scale.y() = 0;
  pose.locals[1].scale.setZero();
  return pose;
}

TEST(PointEvaluator, JointUnderAScaleOfZeroHasASlope) {
  const Character character = test::random_rig(4);
  expect_jacobian(character, crushed(character), some_points(character));
}

TEST(PointEvaluator,
     DualQuaternionsUnderAScaleOfZeroStayFinite) {  // a crushed joint's rotation is not determined
  Character character = test::random_rig(4);
  character.skins[0].method = SkinningMethod::dual_quaternion;
  PointEvaluator evaluator(character, some_points(character));
  Eigen::MatrixXd jacobian;
  evaluator.jacobian(crushed(character), all_freedoms(character), jacobian);
  EXPECT_TRUE(jacobian.allFinite());
}

TEST(PointEvaluator, ShapeRowsAreThePositionsLinearPart) {
  const Character character = test::random_rig(5);
  test::expect_shape_rows(character, test::random_pose(character, 5), some_points(character), 1e-12);
}

TEST(PointEvaluator, ShapeWeighedOnOnePartAlone) {
  const Character character = test::random_rig(5);
  Pose pose = test::random_pose(character, 5);
  pose.part_shape_weights.push_back({0, 1, 0.3});
  expect_jacobian(character, pose, some_points(character));
}

TEST(PointEvaluator, SlidersActThroughStopsAndCorrectives) {
  Character character = test::random_rig(6);
  character.sliders = {{"open", 0, 1, 0, {{0.5, 0}, {1, 1}}}, {"side", -1, 1, 0, {{-1, 2}, {1, 3}}}};
  character.correctives = {{4, CorrectiveRule::product, {{0, 1}, {1, 1}}}};
  RigPose rig{SliderValues(Eigen::Vector2d(0.7, 0.6)), test::random_pose(character, 6).locals};
  PointEvaluator evaluator(character, some_points(character));
  PointsD out, same, up, down;
  evaluator.positions(rig, out);
  evaluator.positions(pose_of(character, rig), same);
  EXPECT_EQ(out, same);
  Eigen::MatrixXd jacobian;
  evaluator.jacobian(rig, {{}, {1, 0}, {{2}}}, jacobian);
  ASSERT_EQ(jacobian.cols(), 5);
  for (int slider : {0, 1}) {
    RigPose moved = rig;
    moved.sliders.values[slider] += 1e-5;
    evaluator.positions(moved, up);
    moved.sliders.values[slider] -= 2e-5;
    evaluator.positions(moved, down);
    for (Eigen::Index p = 0; p < up.rows(); ++p)
      EXPECT_LT(
          ((up.row(p) - down.row(p)).transpose() / 2e-5 - jacobian.block<3, 1>(3 * p, 1 - slider)).norm(),
          1e-8);
  }
  EXPECT_THAT(error_of([&] { evaluator.jacobian(rig, {{0}, {}, {}}, jacobian); }), HasSubstr("name shapes"));
  EXPECT_THAT(error_of([&] {
                evaluator.jacobian(rig, {{}, {7}, {}}, jacobian);
              }),
              HasSubstr("name slider 7"));
  EXPECT_THAT(error_of([&] {
                evaluator.jacobian(pose_of(character, rig), {{}, {0}, {}}, jacobian);
              }),
              HasSubstr("name sliders"));
}

TEST(PointEvaluator, RealFaceInItsClip) {
  const std::filesystem::path file =
      std::filesystem::path(MIEN_SHARED_DATA) / "makehuman/caucasian_male_young.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared data";
  const Character character = load(file);
  expect_jacobian(character, sample_clip(character, character.clips[0], 7.25), some_points(character));
}

}  // namespace
}  // namespace mien
