#include "mien/deform/draw_object.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "character/objects_in_code.h"
#include "mien/core/error.h"
#include "mien/geometry/nurbs_query.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

SurfacePoint vertex(int number) {
  SurfacePoint point;
  point.vertex = number;
  return point;
}

ObjectSketch curve_sketch() {
  ObjectSketch sketch;
  sketch.object.name = "lip";
  sketch.object.form = NurbsCurve{3, clamped_knots(4, 3), {}};
  sketch.through = {vertex(0), vertex(1), vertex(2)};
  sketch.reach.range = 1.5;
  return sketch;
}

std::string refusal(const std::function<void(ObjectSketch&)>& change) {
  ObjectSketch sketch = curve_sketch();
  change(sketch);
  try {
    draw_object(test::head_and_lip(), sketch);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(draw_object, invalid_inputs) {
  EXPECT_THAT(refusal([](ObjectSketch& s) { s.object.node = 7; }),
              HasSubstr("object lip: names node 7; there are 3"));
  EXPECT_THAT(refusal([](ObjectSketch& s) { s.through = {vertex(0)}; }),
              HasSubstr("object lip: goes through 1 points; two or more"));
  EXPECT_THAT(refusal([](ObjectSketch& s) { s.through[1] = vertex(4); }),
              HasSubstr("object lip: has a point on vertex 4"));
  EXPECT_THAT(refusal([](ObjectSketch& s) { s.through[1].part = 2; }),
              HasSubstr("object lip: has a point on part 2"));
  EXPECT_THAT(refusal([](ObjectSketch& s) { s.object.form = Lattice{}; }),
              HasSubstr("object lip: is given by points"));
  EXPECT_THAT(refusal([](ObjectSketch& s) {
                s.object.form = NurbsSurface{1, 1, 2, 2, {0, 0, 1, 1}, {0, 0, 1, 1}, {}};
              }),
              HasSubstr("object lip: spline surface: is a grid of 4 control vertices, there are 3"));
  EXPECT_THAT(refusal([](ObjectSketch& s) { s.reach.range = -1; }), HasSubstr("object lip: has range -1"));
}

TEST(draw_object, a_curve_goes_along_its_points_and_takes_their_joints) {
  ObjectSketch sketch = curve_sketch();
  sketch.follows_skin = true;
  const InfluenceObject object = draw_object(test::head_and_lip(), sketch);
  const PointsD points = tessellate(std::get<NurbsCurve>(object.form), object.controls, 3);
  EXPECT_LT((points.row(0) - Eigen::RowVector3d(0, 0, 0)).norm(), 0.03);
  EXPECT_LT((points.row(2) - Eigen::RowVector3d(2, 0, 0.5)).norm(), 0.03);
  EXPECT_EQ(object.skin, 0);
  EXPECT_EQ(object.skin_weights.offsets.size(), 5u);
  ASSERT_EQ(object.bindings.size(), 1u);
  EXPECT_EQ(object.bindings[0].part, 0);
}

TEST(draw_object, a_frame_stands_at_its_point) {
  ObjectSketch sketch;
  sketch.object.name = "tip";
  sketch.object.form = Locator{};
  sketch.through = {vertex(2)};
  sketch.reach.range = 1;
  EXPECT_EQ(draw_object(test::head_and_lip(), sketch).controls.row(0), Eigen::RowVector3d(2, 0, 0.5));
}

}  // namespace
}  // namespace mien
