#include <gtest/gtest.h>

#include "mien/character/sliders.h"
#include "mien/evaluate/evaluate.h"
#include "mien/pose/solve_pins.h"

namespace mien {
namespace {

/// A biquadratic patch of 4 x 3 control vertices; a shape lifts its middle row, another its corner.
Character patch() {
  Character c;
  c.parts.resize(1);
  Part& part = c.parts[0];
  part.name = "Lips";
  part.surface = NurbsSurface{2, 2, 4, 3, {0, 0, 0, 1, 2, 2, 2}, {0, 0, 0, 1, 1, 1}, {}};
  part.mesh.positions.resize(12, 3);
  for (int v = 0; v < 12; ++v) part.mesh.positions.row(v) = Eigen::RowVector3f(float(v % 4), float(v / 4), 0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i)
      part.mesh.faces.push_back({4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4});
  PartDelta middle, corner;
  middle.vertices = {4, 5, 6, 7};
  middle.deltas = Points::Zero(4, 3);
  middle.deltas.col(2).setConstant(2);
  corner.vertices = {11};
  corner.deltas = Eigen::RowVector3f(0, 0, 1);
  c.shapes = {{"pout", {middle}}, {"curl", {corner}}};
  complete_sliders(c);
  return c;
}

TEST(solve_pins, a_control_vertex_of_a_spline_surface_is_dragged_and_the_surface_follows) {
  const Character character = patch();
  Pin pin;
  pin.at = SurfacePoint{.part = 0, .vertex = 5};
  pin.goal = {0, 0, 1};
  pin.goal_is_move = true;
  SolvePinsOptions options;
  options.rho = 1e-9;
  const SolvePinsResult result = solve_pins(character, {pin}, rest_rig_pose(character), options);
  EXPECT_NEAR(result.pose.sliders.values[0], 0.5, 1e-6);
  EXPECT_NEAR(result.pose.sliders.values[1], 0, 1e-9);

  const std::vector<Points> posed = evaluate(character, pose_of(character, result.pose));
  const Mesh surface = tessellate(*character.parts[0].surface, posed[0].cast<double>(), 5, 3);
  // Halfway across, the middle row has half of the share: a quarter from each border row.
  EXPECT_NEAR(surface.positions(7, 2), 0.5, 1e-5);
  EXPECT_NEAR(surface.positions(2, 2), 0, 1e-6);
}

}  // namespace
}  // namespace mien
