#include "mien/io/objects_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "character/objects_in_code.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;
using testing::ElementsAre;
using testing::HasSubstr;

Character with_landmark() {
  Character c = test::head_and_lip();
  SurfacePoint tip;
  tip.vertex = 2;
  c.landmarks.push_back({"tip", tip});
  return c;
}

std::vector<ObjectSketch> read(const std::string& objects) {
  const Folder folder;
  folder.write("patch.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  return read_objects(folder.write("objects.json", R"({"objects": {)" + objects + "}}"), with_landmark());
}

std::string error_with(const std::string& objects) {
  return test::error_of([&] { read(objects); });
}

TEST(objects_file, what_is_wrong_is_named) {
  const Folder folder;
  EXPECT_THAT(test::error_of([&] { read_objects(folder.write("o.json", "{}"), with_landmark()); }),
              HasSubstr("o.json: file: has no \"objects\""));
  EXPECT_THAT(error_with(""), HasSubstr("objects: are none"));
  EXPECT_THAT(
      error_with(R"("a": {"kind": "blob"})"),
      HasSubstr("object a.kind: is \"blob\"; give curve, surface, lattice, mesh, cluster or locator"));
  EXPECT_THAT(error_with(R"("a": {"kind": "curve"})"), HasSubstr("object a: has no points"));
  EXPECT_THAT(error_with(R"("a": {"kind": "curve", "points": [{"vertex": 99}]})"), HasSubstr("99"));
  EXPECT_THAT(error_with(R"("a": {"kind": "curve", "points": [{"landmark": "top"}]})"),
              HasSubstr("is \"top\"; name a landmark"));
  EXPECT_THAT(error_with(R"("a": {"kind": "curve", "controls": [[0, 0, 0], [1, 0, 0]]})"),
              HasSubstr("object a.count: holds 2; give more than the degree, 3"));
  EXPECT_THAT(
      error_with(
          R"("a": {"kind": "curve", "controls": [[0, 0, 0], [1, 0, 0]], "degree": 1, "knots": [0, 1, 0, 1]})"),
      HasSubstr("object a: has knots that descend or are not finite; give a curve"));
  EXPECT_THAT(error_with(R"("a": {"kind": "curve", "controls": [[0, 0], [1, 0, 0]], "degree": 1})"),
              HasSubstr("give [x, y, z] each"));
  EXPECT_THAT(error_with(R"("a": {"kind": "curve", "points": [{"vertex": 0}], "box": 1})"),
              HasSubstr("object a.box: is not a member of this kind"));
  EXPECT_THAT(error_with(R"("a": {"kind": "surface", "points": [{"vertex": 0}]})"),
              HasSubstr("object a: has no \"count\""));
  EXPECT_THAT(error_with(R"("a": {"kind": "lattice"})"), HasSubstr("has neither or both"));
  EXPECT_THAT(error_with(R"("a": {"kind": "lattice", "box": [[0, 0, 0], [1, 0, 1]]})"),
              HasSubstr("a box without volume"));
  EXPECT_THAT(error_with(R"("a": {"kind": "lattice", "count": [1, 2, 2], "box": [[0, 0, 0], [1, 1, 1]]})"),
              HasSubstr("2 or more"));
  EXPECT_THAT(error_with(R"("a": {"kind": "mesh", "file": "none.obj"})"), HasSubstr("none.obj"));
  EXPECT_THAT(error_with(R"("a": {"kind": "cluster", "at": {"vertex": 0}, "node": "nose"})"),
              HasSubstr("object a.node: names node nose; name one of the character's"));
  EXPECT_THAT(error_with(R"("a": {"kind": "cluster", "at": {"vertex": 0}, "parts": ["Skin"]})"),
              HasSubstr("object a.parts: name Skin"));
  EXPECT_THAT(error_with(R"("a": {"kind": "cluster", "at": {"vertex": 0}, "distance": "far"})"),
              HasSubstr("give geodesic or euclidean"));
  EXPECT_THAT(error_with(R"("a": {"kind": "cluster", "at": {"vertex": 0}, "joints": "all"})"),
              HasSubstr("give \"skin\", or the names of joints"));
  EXPECT_THAT(
      error_with(R"("a": {"kind": "cluster", "at": {"vertex": 0}, "weights_on": {"Face": {"x": 1}}})"),
      HasSubstr("has \"x\"; give \"VERTEX\": WEIGHT"));
  Character taken = with_landmark();
  taken.objects.push_back(test::line());
  const auto file =
      folder.write("t.json", R"({"objects": {"line": {"kind": "cluster", "at": [0, 0, 0], "range": 1}}})");
  EXPECT_THAT(test::error_of([&] { read_objects(file, taken); }), HasSubstr("object line: is there already"));
}

TEST(objects_file, every_kind_is_read) {
  const auto sketches = read(R"(
    "a": {"kind": "curve", "points": [{"vertex": 0}, {"vertex": 1}, {"landmark": "tip"}], "count": 5,
          "carrier": "head", "joints": ["lip"], "range": 0.5, "full": 0.1, "distance": "euclidean"},
    "b": {"kind": "surface", "count": [2, 3], "degree": [1, 2], "weights": [1, 1, 2, 2, 1, 1],
          "controls": [[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,2,0],[1,2,0]], "joints": "skin", "range": 1},
    "c": {"kind": "lattice", "count": [2, 3, 5], "box": [[1, 1, 1], [0, 0, -1]], "fade": 0.1},
    "d": {"kind": "mesh", "file": "patch.obj", "range": 1, "smoothing": 3},
    "e": {"kind": "cluster", "at": {"landmark": "tip"}, "node": "lip", "range": 1, "strength": 0.5},
    "f": {"kind": "locator", "at": [1, 2, 3], "weights_on": {"Face": {"3": 0.5, "1": 1}}})");
  ASSERT_EQ(sketches.size(), 6u);
  EXPECT_EQ(sketches[0].through.size(), 3u);
  EXPECT_EQ(sketches[0].through[2].vertex, 2);
  EXPECT_EQ(std::get<NurbsCurve>(sketches[0].object.form).control_count(), 5);
  EXPECT_EQ(sketches[0].object.carrier, 1);
  EXPECT_THAT(sketches[0].joints, ElementsAre(2));
  EXPECT_FALSE(sketches[0].reach.geodesic);
  EXPECT_EQ(sketches[0].reach.full, 0.1);
  EXPECT_EQ(std::get<NurbsSurface>(sketches[1].object.form).weights[2], 2);
  EXPECT_TRUE(sketches[1].follows_skin);
  EXPECT_THAT(std::get<Lattice>(sketches[2].object.form).degree, ElementsAre(1, 2, 3));
  EXPECT_EQ(sketches[2].object.controls.row(0), Eigen::RowVector3d(0, 0, -1));
  EXPECT_EQ(sketches[3].object.controls.rows(), 3);
  EXPECT_EQ(sketches[3].reach.smoothing, 3);
  EXPECT_EQ(sketches[4].object.node, 2);
  EXPECT_EQ(sketches[4].reach.strength, 0.5);
  EXPECT_EQ(sketches[5].object.controls.row(0), Eigen::RowVector3d(1, 2, 3));
  ASSERT_EQ(sketches[5].reach.drawn.size(), 1u);
  EXPECT_THAT(sketches[5].reach.drawn[0].vertices, ElementsAre(1, 3));
  EXPECT_THAT(sketches[5].reach.drawn[0].weights, ElementsAre(1, 0.5f));
}

}  // namespace
}  // namespace mien
