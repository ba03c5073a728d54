#include "mien/transfer/carry_objects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/small_rig.h"

namespace mien::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A rational curve of three control points on vertices 1 and 2, moved by two joints of the second skin, and a cluster on
/// vertex 3.
Character source_with_objects() {
  Character source = rig();
  source.parts = row_of_vertices(5).parts;
  InfluenceObject curve;
  curve.name = "muscle";
  curve.form = NurbsCurve{2, {0, 0, 0, 1, 1, 1}, {1, 0.5, 1}};
  curve.controls.resize(3, 3);
  curve.controls << 1, 0, 0, 1.5, 1, 0, 2, 0, 0;
  curve.carrier = 1;
  curve.skin = 1;
  curve.skin_weights = {{0, 1, 2, 4}, {0, 1, 0, 1}, {1, 1, 0.25f, 0.75f}};
  curve.bindings = {{0, {1, 2}, {0.5f, 1}, {0, 2, 4}, {0, 1, 1, 2}, {0.75f, 0.25f, 0.5f, 0.5f}}};
  InfluenceObject cluster;
  cluster.name = "cheek";
  cluster.node = 3;
  cluster.controls = Eigen::RowVector3d(3, 0, 0);
  cluster.bindings = {{0, {3}, {0.8f}, {}, {}, {}}};
  source.objects = {curve, cluster};
  return source;
}

std::vector<InfluenceObject> carry(const Character& source, const RigMap& map) {
  std::vector<std::string> dropped;
  std::vector<InfluenceObject> objects = carry_objects(source, source, map, dropped);
  EXPECT_THAT(dropped, IsEmpty());
  return objects;
}

TEST(carry_objects, a_node_that_was_not_carried_is_named) {
  const Character source = source_with_objects();
  RigMap map = rig_map_of(source, {});
  map.node_of[3] = -1;
  std::vector<std::string> dropped;
  const auto objects = carry_objects(source, source, map, dropped);
  EXPECT_THAT(dropped, ElementsAre("object cheek: node chin"));
  EXPECT_EQ(objects[1].node, -1);
  EXPECT_EQ(objects[0].carrier, 1);
}

TEST(carry_objects, nothing_changes_where_nothing_is_mapped) {
  const Character source = source_with_objects();
  const auto objects = carry(source, rig_map_of(source, {}));
  ASSERT_EQ(objects.size(), 2u);
  for (std::size_t o = 0; o < 2; ++o) {
    EXPECT_EQ(objects[o].name, source.objects[o].name);
    EXPECT_EQ(objects[o].form, source.objects[o].form);
    EXPECT_EQ(objects[o].controls, source.objects[o].controls);
    EXPECT_EQ(objects[o].bindings, source.objects[o].bindings);
  }
  // The target has one skin of all joints: head, chin, jaw.
  EXPECT_EQ(objects[0].skin, 0);
  EXPECT_THAT(objects[0].skin_weights.joints, ElementsAre(1, 2, 1, 2));
  EXPECT_EQ(objects[0].skin_weights.weights, source.objects[0].skin_weights.weights);
}

TEST(carry_objects, control_points_go_through_the_map_of_space) {
  const Character source = source_with_objects();
  const Similarity map = some_similarity(7);
  const auto objects = carry(source, rig_map_of(source, map));
  for (std::size_t o = 0; o < 2; ++o)
    EXPECT_LT((objects[o].controls - map(source.objects[o].controls)).norm(), 1e-12);
  EXPECT_EQ(objects[0].form, source.objects[0].form);  // degree, knots and rational weights
}

TEST(carry_objects, a_vertex_between_two_has_the_mix_of_their_rows) {
  const Character source = source_with_objects();
  RigMap map = rig_map_of(source, {});
  // Target vertex 0 lies between 1 and 2, vertex 1 between 2 and 3 (which the curve does not hold), vertex 4 nowhere near.
  map.rows = [](const WeightMatrix& rows) {
    WeightMatrix mix(5, 5);
    mix.insert(0, 1) = 0.5;
    mix.insert(0, 2) = 0.5;
    mix.insert(1, 2) = 0.25;
    mix.insert(1, 3) = 0.75;
    mix.insert(4, 0) = 1;
    return WeightMatrix(mix * rows);
  };
  const auto objects = carry(source, map);
  const InfluenceBinding& binding = objects[0].bindings[0];
  EXPECT_THAT(binding.vertices, ElementsAre(0, 1));
  EXPECT_NEAR(binding.weights[0], 0.75, 1e-6);
  EXPECT_NEAR(binding.weights[1], 0.25, 1e-6);
  EXPECT_THAT(binding.controls, ElementsAre(0, 1, 2, 1, 2));
  const float expected[] = {0.25f, 5.f / 12, 1.f / 3, 0.5f, 0.5f};
  for (std::size_t e = 0; e < 5; ++e) EXPECT_NEAR(binding.coefficients[e], expected[e], 1e-6) << e;
  EXPECT_THAT(objects[1].bindings[0].vertices, ElementsAre(1));
  EXPECT_NEAR(objects[1].bindings[0].weights[0], 0.6, 1e-6);
  EXPECT_THAT(objects[1].bindings[0].offsets, IsEmpty());
}

TEST(carry_object_moves, follow_the_rule_of_displacements) {
  const Character source = source_with_objects();
  const Similarity map = some_similarity(7);
  PointsD moves(3, 3);
  moves << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const auto carried = carry_object_moves(source, {{0, moves}, {1, PointsD()}}, rig_map_of(source, map), 1.5);
  ASSERT_EQ(carried.size(), 2u);
  EXPECT_LT((carried[0].controls - 1.5 * map.of_vectors(moves)).norm(), 1e-12);
  EXPECT_EQ(carried[1].controls.rows(), 0);
}

}  // namespace
}  // namespace mien::test
