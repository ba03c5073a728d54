#include "mien/character/object_problems.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "character/objects_in_code.h"

namespace mien {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Character with_objects() {
  Character character = test::head_and_lip();
  character.objects = {test::line(), test::frame(Cluster{})};
  character.shapes[0].objects.push_back({0, PointsD::Ones(2, 3)});
  return character;
}

/// The first problem after a change.
std::string problem_after(const std::function<void(Character&)>& change) {
  Character character = with_objects();
  change(character);
  const auto problems = validate(character);
  return problems.empty() ? std::string() : problems.front().error().what();
}

TEST(object_problems, a_sound_character_has_no_problems) {
  EXPECT_THAT(object_problems(with_objects()), IsEmpty());
  EXPECT_THAT(validate(with_objects()), IsEmpty());
}

TEST(object_problems, names_are_unique_and_forms_fit) {
  EXPECT_THAT(problem_after([](Character& c) { c.objects[1].name = "line"; }),
              HasSubstr("object line: is there twice; names are unique"));
  EXPECT_THAT(problem_after([](Character& c) { std::get<NurbsCurve>(c.objects[0].form).knots[1] = 2; }),
              HasSubstr("object line: has knots that descend or are not finite; give a curve that fits"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[1].controls.resize(0, 3); }),
              HasSubstr("object frame: has 0 points, one is needed; give a cluster"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].controls(1, 1) = NAN; }),
              HasSubstr("object line: has control points that are not finite"));
  EXPECT_THAT(fault_of(InfluenceForm(WrapMesh{}), 3), HasSubstr("has no faces"));
  WrapMesh mesh;
  mesh.faces.push_back({0, 1, 3});
  EXPECT_THAT(fault_of(InfluenceForm(mesh), 3), HasSubstr("has face 0 with vertex 3, there are 3"));
  EXPECT_THAT(fault_of(InfluenceForm(mesh), 4), IsEmpty());
  EXPECT_THAT(fault_of(InfluenceForm(Lattice{}), 7), HasSubstr("grid of 8 control points, there are 7"));
  EXPECT_THAT(fault_of(InfluenceForm(NurbsSurface{}), 7), HasSubstr("control vertices along u"));
}

TEST(object_problems, nodes_and_skins_exist) {
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].carrier = 3; }),
              HasSubstr("object line: names node 3; there are 3"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].node = -2; }),
              HasSubstr("object line: names node -2"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].skin = 1; }),
              HasSubstr("object line: names skin 1; there are 1"));
  EXPECT_THAT(problem_after([](Character& c) {
                c.objects[0].skin_weights = {{0, 1, 2}, {0, 1}, {1, 1}};
              }),
              HasSubstr("object line: has skin weights and no skin"));
  EXPECT_THAT(problem_after([](Character& c) {
                c.objects[0].skin = 0;
                c.objects[0].skin_weights = {{0, 1, 2}, {0, 2}, {1, 1}};
              }),
              HasSubstr("object line: control point 1: names joint 2; there are 2"));
  EXPECT_THAT(problem_after([](Character& c) {
                c.objects[0].skin = 0;
                c.objects[0].skin_weights = {{0, 1}, {0}, {1}};
              }),
              HasSubstr("counts do not fit together; give each control point its influences"));
}

TEST(object_problems, bindings_fit_parts_and_control_points) {
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].part = 1; }),
              HasSubstr("object line: names part 1; there are 1"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings.push_back(c.objects[0].bindings[0]); }),
              HasSubstr("object line: lists its parts out of order"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].vertices[2] = 4; }),
              HasSubstr("object line: part Face, vertex 4: is out of range or out of order"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].vertices[2] = 1; }),
              HasSubstr("vertex 1: is out of range or out of order"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].weights[0] = 0; }),
              HasSubstr("vertex 0: has weight 0.000000; above 0 and at most 1"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].weights.pop_back(); }),
              HasSubstr("has 2 weights; there are 3 vertices"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].offsets.pop_back(); }),
              HasSubstr("a binding whose counts do not fit together"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].offsets[1] = 4; }),
              HasSubstr("coefficients that sum to 3"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].controls[3] = 2; }),
              HasSubstr("vertex 2: names control point 2; there are 2"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[0].bindings[0].coefficients[1] = NAN; }),
              HasSubstr("vertex 1: has coefficients that sum to nan"));
  EXPECT_THAT(problem_after([](Character& c) { c.objects[1].bindings[0].controls = {0}; }),
              HasSubstr("object frame: part Face: lists control points; a cluster has none"));
}

TEST(object_problems, moves_and_channels_fit_their_objects) {
  EXPECT_THAT(problem_after([](Character& c) { c.shapes[0].objects[0].object = 2; }),
              HasSubstr("shape raise: names object 2; there are 2"));
  EXPECT_THAT(problem_after([](Character& c) { c.shapes[0].objects[0].controls.resize(3, 3); }),
              HasSubstr("shape raise: object line: is moved by 3 control points; 2"));
  EXPECT_THAT(problem_after([](Character& c) { c.shapes[0].objects[0].controls(0, 0) = INFINITY; }),
              HasSubstr("is moved by numbers that are not finite"));
  EXPECT_THAT(problem_after([](Character& c) { c.shapes[0].objects.push_back(c.shapes[0].objects[0]); }),
              HasSubstr("shape raise: object line: is out of order"));
  Channel channel;
  channel.property = Channel::Property::object_control;
  channel.times = {0};
  channel.values = {0, 0, 0};
  channel.object = 0;
  channel.control = 2;
  EXPECT_THAT(problem_after([&](Character& c) {
                c.clips.push_back({"clip", {channel}, {}});
              }),
              HasSubstr("clip clip: channel 0: names control point 2; there are 2"));
  channel.object = 2;
  EXPECT_THAT(problem_after([&](Character& c) {
                c.clips.push_back({"clip", {channel}, {}});
              }),
              HasSubstr("clip clip: channel 0: names object 2; there are 2"));
}

}  // namespace
}  // namespace mien
