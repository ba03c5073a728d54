#include "mien/transfer/carry_wires.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/small_rig.h"

namespace mien::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A straight wire over a row of vertices.
Character source_with_wire() {
  Character source = row_of_vertices(5);
  Wire wire;
  wire.name = "lip";
  wire.curve.controls.resize(4, 3);
  wire.curve.controls << 0, 0.5, 0, 1, 0.5, 0, 2, 0.5, 0, 3, 0.5, 0;
  wire.curve.knots = clamped_knots(4);
  wire.ranges = {2, 1};
  wire.turn_controls = 4;
  wire.points.resize(2);
  wire.bindings = {{0, {0, 1, 3}, {1, 0.5f, 0.25f}, {0, 0.125f, 1}}};
  source.wires = {wire};
  return source;
}

TEST(carry_wires, nothing_changes_where_nothing_is_mapped) {
  const Character source = source_with_wire();
  const auto wires = carry_wires(source, source, rig_map_of(source, {}));
  ASSERT_EQ(wires.size(), 1u);
  EXPECT_EQ(wires[0].curve, source.wires[0].curve);
  EXPECT_EQ(wires[0].ranges, source.wires[0].ranges);
  EXPECT_EQ(wires[0].bindings, source.wires[0].bindings);
  EXPECT_EQ(wires[0].points.size(), 2u);
}

TEST(carry_wires, ranges_grow_and_curves_go_along) {
  const Character source = source_with_wire();
  const Similarity map = some_similarity(7);
  const auto wires = carry_wires(source, source, rig_map_of(source, map));
  EXPECT_LT((wires[0].curve.controls - map(source.wires[0].curve.controls)).norm(), 1e-12);
  EXPECT_THAT(wires[0].ranges, ElementsAre(14, 7));
}

TEST(carry_wires, points_without_a_place_are_left_out_together) {
  const Character source = source_with_wire();
  RigMap map = rig_map_of(source, {});
  map.surface_point = [](const SurfacePoint&) { return std::optional<SurfacePoint>(); };
  EXPECT_THAT(carry_wires(source, source, map)[0].points, IsEmpty());
}

TEST(carry_wires, mixed_vertices_take_the_mean_parameter_unless_it_means_nothing) {
  const Character source = source_with_wire();
  RigMap map = rig_map_of(source, {});
  map.rows = [](const WeightMatrix& rows) {
    WeightMatrix mix(5, 5);
    mix.insert(2, 0) = 0.5;  // between parameters 0 and 0.125 ...
    mix.insert(2, 1) = 0.5;
    mix.insert(3, 0) = 0.5;  // ... and between 0 and 1: the curve's ends
    mix.insert(3, 3) = 0.5;
    return WeightMatrix(mix * rows);
  };
  const WireBinding binding = carry_wires(source, source, map)[0].bindings[0];
  EXPECT_THAT(binding.vertices, ElementsAre(2, 3));
  EXPECT_NEAR(binding.falloff[0], 0.75, 1e-6);
  EXPECT_NEAR(binding.parameters[0], 0.125 / 3, 1e-6);
  EXPECT_NEAR(binding.falloff[1], 0.625, 1e-6);
  EXPECT_NEAR(binding.parameters[1], 1, 1e-3);  // vertex 3 lies below the end of the curve
}

TEST(carry_wire_moves, follow_the_rule_of_displacements_and_turn_with_the_face) {
  const Character source = source_with_wire();
  const Similarity map = some_similarity(7);
  WireMove move{0, PointsD::Ones(4, 3), 0.2, PointsD::Ones(4, 3)};
  const auto carried = carry_wire_moves(source, {move}, rig_map_of(source, map), 2);
  EXPECT_LT((carried[0].controls - 2 * map.of_vectors(move.controls)).norm(), 1e-12);
  EXPECT_NEAR(carried[0].scale, 0.4, 1e-12);
  EXPECT_LT((carried[0].turns - 2 * move.turns * map.rotation.transpose()).norm(), 1e-12);
}

}  // namespace
}  // namespace mien::test
