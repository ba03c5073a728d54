#include "mien/picture/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "error_of.h"
#include "mien/core/error.h"
#include "shapes_in_code.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

/// The largest |x| / aspect and |y| of the points in the picture, where 1 is the border.
double reach(const Camera& camera, const Points& points, double aspect) {
  const Eigen::Vector3d back = (camera.eye - camera.target).normalized();
  const Eigen::Vector3d right = camera.up.cross(back).normalized(), up = back.cross(right);
  const double slope = std::tan(camera.field_of_view * std::numbers::pi / 360);
  double most = 0;
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Eigen::Vector3d q = points.row(v).transpose().cast<double>() - camera.eye;
    const double depth = -q.dot(back);
    most = std::max(
        {most, std::abs(q.dot(right)) / depth / slope / aspect, std::abs(q.dot(up)) / depth / slope});
  }
  return most;
}

TEST(Camera, InvalidInputs) {
  EXPECT_EQ(error_of([] { view_of_name("back"); }),
            "view back: does not exist; front, left, right or three-quarter");
  EXPECT_THAT(error_of([] { frame_points(Points(0, 3)); }), HasSubstr("shows nothing"));
  Points broken = Points::Zero(2, 3);
  broken(1, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error_of([&] { frame_points(broken); }), HasSubstr("not finite"));
}

TEST(Camera, NamesOfViewsGoBothWays) {
  for (const View view : {View::front, View::left, View::right, View::three_quarter})
    EXPECT_EQ(view_of_name(name_of(view)), view);
}

TEST(Camera, HoldsAllPointsAndTouchesTheMargin) {
  const Points points = make_sphere("ball", 12).mesh.positions * Eigen::DiagonalMatrix<float, 3>(1, 2, 0.5f);
  for (const View view : {View::front, View::left, View::right, View::three_quarter})
    for (const double aspect : {0.5, 1.0, 2.0}) {
      FrameOptions options;
      options.view = view;
      options.aspect = aspect;
      EXPECT_NEAR(reach(frame_points(points, options), points, aspect), 1 - 2 * options.margin, 1e-6);
    }
}

TEST(Camera, ViewsLookAtTheirSide) {
  const Points points = make_sphere("ball", 8).mesh.positions;
  EXPECT_GT(frame_points(points).eye.z(), 2);
  EXPECT_GT(frame_points(points, {.view = View::left}).eye.x(), 2);
  EXPECT_LT(frame_points(points, {.view = View::right}).eye.x(), -2);
  FrameOptions turned;  // a face that looks along +X
  turned.facing = Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_GT(frame_points(points, turned).eye.x(), 2);
}

TEST(Camera, OnePointIsFramedToo) {
  const Camera camera = frame_points(Points::Ones(1, 3));
  EXPECT_TRUE(camera.eye.allFinite());
  EXPECT_GT((camera.eye - camera.target).norm(), 0);
}

TEST(FrameHead, LeavesTheBodyOut) {
  // A ball that a shape moves, over a long body.
  Part body = make_sphere("body", 8);
  body.mesh.positions.col(1) = body.mesh.positions.col(1).array() * 8 - 9;
  Character character = character_of({make_sphere("skin", 8), body});
  Shape shape{"smile", {PartDelta()}};
  for (int v = 0; v < character.parts[0].mesh.positions.rows(); ++v) shape.parts[0].vertices.push_back(v);
  shape.parts[0].deltas = Points::Zero(character.parts[0].mesh.positions.rows(), 3);
  character.shapes.push_back(shape);
  const auto posed = positions_of(character);
  const Camera head = frame_head(character, posed);
  EXPECT_NEAR(head.target.y(), -0.5, 0.8);
  character.shapes.clear();
  EXPECT_LT(frame_head(character, posed).target.y(), -6);
}

TEST(FrameHead, HasRoomForTheShapes) {
  Character character = character_of({make_sphere("skin", 8)});
  Shape open{"jawOpen", {{0, {0}, Points(1, 3), {}, {}}}};
  open.parts[0].deltas << 0, -0.9f - character.parts[0].mesh.positions(0, 1), 0;
  open.parts[0].deltas(0, 1) -= 0.4f;
  character.shapes.push_back(open);
  const auto posed = positions_of(character);
  Points target = posed[0];
  target.row(0) += open.parts[0].deltas.row(0);
  EXPECT_LE(reach(frame_head(character, posed), target, 1), 1 - 2 * FrameOptions().margin + 1e-6);
}

}  // namespace
}  // namespace mien
