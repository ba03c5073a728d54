#include "mien/character/landmark_points.h"

#include <gtest/gtest.h>

#include "mien/core/error.h"

namespace mien {
namespace {

using Eigen::Vector3d;

SurfacePoint at_vertex(int vertex) {
  SurfacePoint point;
  point.vertex = vertex;
  return point;
}

/// One quad in a part that a node moves by (10, 0, 0) and doubles.
Character quad_character() {
  Character character;
  character.nodes.emplace_back();
  character.nodes[0].rest.translation = Vector3d(10, 0, 0);
  character.nodes[0].rest.scale = Vector3d(2, 2, 2);
  Part part;
  part.node = 0;
  part.mesh.positions.resize(4, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  part.mesh.faces.push_back({0, 1, 2, 3});
  character.parts.push_back(part);
  return character;
}

std::string failure_of(const Character& character, const LandmarkCurve& curve, int count) {
  try {
    sample_curve(character, curve, count);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "did not fail";
}

TEST(sample_curve, invalid_input_is_named) {
  const Character character = quad_character();
  EXPECT_EQ(failure_of(character, {"lip", {}, 2}, 2), "curve lip: has 0 points; two or more");
  EXPECT_EQ(failure_of(character, {"lip", {at_vertex(0)}, 2}, 2), "curve lip: has 1 points; two or more");
  EXPECT_EQ(failure_of(character, {"lip", {at_vertex(0), at_vertex(1)}, 2}, 0),
            "curve lip: has count 0; a count of 1 or more");
}

TEST(landmark_points, are_in_model_space_in_order) {
  Character character = quad_character();
  SurfacePoint inside;
  inside.face = 0;
  inside.corners = {0, 2, 3};
  inside.barycentric = Vector3d(0.25, 0.25, 0.5);
  character.landmarks = {{"b", at_vertex(2)}, {"a", inside}};
  const auto points = landmark_points(character);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].name, "b");
  EXPECT_EQ(points[1].name, "a");
  EXPECT_TRUE(points[0].position.isApprox(Vector3d(12, 2, 0)));
  EXPECT_TRUE(points[1].position.isApprox(Vector3d(10.5, 1.5, 0)));
  EXPECT_EQ(points[1].at.corners, inside.corners);
}

TEST(landmark_points, of_a_skinned_part_ignore_its_node) {
  Character character = quad_character();
  character.skins.emplace_back();
  character.parts[0].skin = 0;
  character.landmarks = {{"a", at_vertex(2)}};
  EXPECT_TRUE(landmark_points(character)[0].position.isApprox(Vector3d(1, 1, 0)));
}

TEST(landmark_points, there_may_be_none) {
  EXPECT_TRUE(landmark_points(Character{}).empty());
}

TEST(sample_curve, is_even_by_length_and_has_both_ends) {
  const Character character = quad_character();
  // Two sides of the square, four long in model space.
  const LandmarkCurve curve{"lip", {at_vertex(0), at_vertex(1), at_vertex(2)}, 3};
  const auto points = sample_curve(character, curve, 5);
  const Vector3d expected[] = {{10, 0, 0}, {11, 0, 0}, {12, 0, 0}, {12, 1, 0}, {12, 2, 0}};
  ASSERT_EQ(points.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(points[i].name, "lip." + std::to_string(i));
    EXPECT_TRUE(points[i].position.isApprox(expected[i], 1e-12)) << i;
  }
  EXPECT_EQ(points[0].at.vertex, 0);
  EXPECT_EQ(points[4].at.vertex, 2);
}

TEST(sample_curve, one_sample_is_the_middle) {
  const Character character = quad_character();
  const auto points = sample_curve(character, {"lip", {at_vertex(0), at_vertex(1)}, 1}, 1);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_TRUE(points[0].position.isApprox(Vector3d(11, 0, 0)));
}

TEST(sample_curve, of_no_length_is_one_place) {
  const Character character = quad_character();
  for (const auto& point : sample_curve(character, {"lip", {at_vertex(1), at_vertex(1)}, 4}, 4))
    EXPECT_TRUE(point.position.isApprox(Vector3d(12, 0, 0)));
}

}  // namespace
}  // namespace mien
