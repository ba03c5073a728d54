#include "mien/deform/bind_influence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "character/objects_in_code.h"
#include "error_of.h"
#include "mien/character/object_problems.h"
#include "mien/core/error.h"
#include "mien/geometry/nurbs_query.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A square of n x n vertices, one unit apart, at height z.
Part square(const std::string& name, int n, float z) {
  Part part;
  part.name = name;
  part.mesh.positions.resize(n * n, 3);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) part.mesh.positions.row(i + n * j) << float(i), float(j), z;
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const int corner = i + n * j;
      part.mesh.faces.push_back({corner, corner + 1, corner + 1 + n, corner + n});
    }
  return part;
}

/// Two squares of 9 x 9, the second half a unit above the first: two lips.
Character two_squares() {
  Character character;
  character.parts = {square("low", 9, 0), square("high", 9, 0.5f)};
  return character;
}

InfluenceObject object_of(InfluenceForm form, PointsD controls) {
  InfluenceObject object;
  object.name = "thing";
  object.form = std::move(form);
  object.controls = std::move(controls);
  return object;
}

/// A straight curve over row 4 of the low square.
InfluenceObject curve() {
  PointsD controls(5, 3);
  for (int c = 0; c < 5; ++c) controls.row(c) << 2 * c, 4, 0;
  return object_of(NurbsCurve{1, {0, 0, 1, 2, 3, 4, 4}, {}}, controls);
}

InfluenceReach range(double length) {
  InfluenceReach reach;
  reach.range = length;
  return reach;
}

InfluenceObject bound(const Character& character, InfluenceObject object, const InfluenceReach& reach) {
  object.bindings = bind_influence(character, object, reach);
  return object;
}

double weight_of(const InfluenceObject& object, int part, int vertex) {
  for (const InfluenceBinding& binding : object.bindings)
    for (std::size_t k = 0; k < binding.vertices.size() && binding.part == part; ++k)
      if (binding.vertices[k] == vertex) return binding.weights[k];
  return 0;
}

/// The object's point that a vertex follows.
Eigen::RowVector3d point_of(const InfluenceObject& object, int part, int vertex) {
  Eigen::RowVector3d point = Eigen::RowVector3d::Zero();
  for (const InfluenceBinding& binding : object.bindings)
    for (std::size_t k = 0; k < binding.vertices.size() && binding.part == part; ++k)
      if (binding.vertices[k] == vertex)
        for (int e = binding.offsets[k]; e < binding.offsets[k + 1]; ++e)
          point += binding.coefficients[e] * object.controls.row(binding.controls[e]);
  return point;
}

TEST(bind_influence, invalid_inputs) {
  const Character character = two_squares();
  const auto refusal = [&](const std::function<void(InfluenceObject&, InfluenceReach&)>& change) {
    InfluenceObject object = curve();
    InfluenceReach reach = range(2);
    change(object, reach);
    return error_of([&] { bind_influence(character, object, reach); });
  };
  EXPECT_THAT(refusal([](auto& o, auto&) { std::get<NurbsCurve>(o.form).knots[3] = -1; }),
              HasSubstr("object thing: has knots that descend or are not finite; a curve that fits"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.range = 0; }),
              HasSubstr("object thing: has range 0.000000; a length above 0"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.full = 3; }), HasSubstr("a length above that of full weight"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.range = NAN; }), HasSubstr("has range nan"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.strength = 2; }), HasSubstr("has strength 2.0"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.fade = 0.7; }), HasSubstr("fades over 0.7"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.smoothing = 0; }), HasSubstr("among 0 triangles"));
  EXPECT_THAT(refusal([](auto&, auto& r) { r.parts = {2}; }),
              HasSubstr("is to reach part 2; one from 0 to 1"));
  EXPECT_THAT(refusal([](auto& o, auto&) { o.controls.array() += 100; }),
              HasSubstr("object thing: reaches no vertex; a longer range"));
  EXPECT_THAT(refusal([](auto&, auto& r) {
                r.drawn = {{0, {81}, {1}}};
              }),
              HasSubstr("has a weight drawn on vertex 81; one from 0 to 80"));
  EXPECT_THAT(refusal([](auto&, auto& r) {
                r.drawn = {{0, {8}, {1.5f}}};
              }),
              HasSubstr("part low, vertex 8: has weight 1.5"));
  EXPECT_THAT(refusal([](auto&, auto& r) {
                r.drawn = {{0, {8, 9}, {1}}};
              }),
              HasSubstr("has 1 drawn weights; 2, one a vertex"));

  InfluenceObject box = object_of(Lattice{}, lattice_controls({}, {{-9, -9, 5}, {9, 9, 6}}));
  EXPECT_THAT(error_of([&] { bind_influence(character, box, {}); }),
              HasSubstr("object thing: holds no vertex; a lattice around some of the skin"));
  InfluenceReach drawn;
  drawn.drawn = {{0, {3}, {1}}};
  EXPECT_THAT(error_of([&] { bind_influence(character, box, drawn); }),
              HasSubstr("vertex 3, which is outside of the lattice"));
}

TEST(bind_influence, a_curve_acts_on_its_piece_of_skin_with_its_closest_points) {
  const Character character = two_squares();
  const InfluenceObject object = bound(character, curve(), range(3));
  Character whole = character;
  whole.objects = {object};
  EXPECT_THAT(object_problems(whole), IsEmpty());
  ASSERT_EQ(object.bindings.size(),
            1u);  // the square above is nearer than the range, and not on the same skin
  EXPECT_EQ(object.bindings[0].part, 0);
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(weight_of(object, 0, i + 9 * 4), 1, 1e-6);
    EXPECT_NEAR(weight_of(object, 0, i + 9 * 5), std::pow(1.0 / 9 - 1, 2), 1e-6);
    EXPECT_EQ(weight_of(object, 0, i + 9 * 7), 0);
    EXPECT_LT((point_of(object, 0, i + 9 * 5) - Eigen::RowVector3d(i, 4, 0)).norm(), 1e-6);
  }
}

TEST(bind_influence, distances_go_through_space_when_asked) {
  InfluenceReach reach = range(3);
  reach.geodesic = false;
  const InfluenceObject both = bound(two_squares(), curve(), reach);
  ASSERT_EQ(both.bindings.size(), 2u);
  EXPECT_NEAR(weight_of(both, 1, 9 * 4), std::pow(0.25 / 9 - 1, 2), 1e-6);
  reach.parts = {1};
  const InfluenceObject one = bound(two_squares(), curve(), reach);
  ASSERT_EQ(one.bindings.size(), 1u);
  EXPECT_EQ(one.bindings[0].part, 1);
}

TEST(bind_influence, full_weight_and_strength) {
  InfluenceReach reach = range(3);
  reach.full = 1;
  reach.strength = 0.5;
  const InfluenceObject object = bound(two_squares(), curve(), reach);
  EXPECT_NEAR(weight_of(object, 0, 9 * 5), 0.5, 1e-6);
  EXPECT_NEAR(weight_of(object, 0, 9 * 6), 0.5 * std::pow(0.25 - 1, 2), 1e-6);
}

TEST(bind_influence, a_surface_takes_its_closest_point) {
  const NurbsSurface form{2, 2, 4, 4, clamped_knots(4, 2), clamped_knots(4, 2), {}};
  PointsD grid(16, 3);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) grid.row(i + 4 * j) << 2 + i, 2 + j, -0.1;
  InfluenceReach reach = range(2);
  reach.full = 0.2;
  const InfluenceObject object = bound(two_squares(), object_of(form, fit_controls(form, grid)), reach);
  ASSERT_EQ(object.bindings.size(), 1u);
  for (int j = 2; j <= 5; ++j)
    for (int i = 2; i <= 5; ++i) {
      EXPECT_NEAR(weight_of(object, 0, i + 9 * j), 1, 1e-6);
      EXPECT_LT((point_of(object, 0, i + 9 * j) - Eigen::RowVector3d(i, j, -0.1)).norm(), 1e-5);
    }
  EXPECT_LT((point_of(object, 0, 1 + 9 * 3) - Eigen::RowVector3d(2, 3, -0.1)).norm(), 1e-5);
}

TEST(bind_influence, a_lattice_takes_the_vertices_inside_and_fades) {
  const Lattice form{{3, 4, 2}, {2, 3, 1}};
  InfluenceObject object = object_of(form, lattice_controls(form, {{1, 1, -1}, {7, 7, 1}}));
  InfluenceReach reach;
  reach.fade = 0;
  const InfluenceObject plain = bound(two_squares(), object, reach);
  ASSERT_EQ(plain.bindings.size(), 2u);
  EXPECT_EQ(plain.bindings[0].vertices.size(), 49u);
  EXPECT_EQ(weight_of(plain, 0, 1 + 9 * 1), 1);
  EXPECT_LT((point_of(plain, 1, 3 + 9 * 5) - Eigen::RowVector3d(3, 5, 0.5)).norm(), 1e-5);
  reach.fade = 0.5;
  reach.parts = {0};
  const InfluenceObject faded = bound(two_squares(), object, reach);
  ASSERT_EQ(faded.bindings.size(), 1u);
  EXPECT_EQ(weight_of(faded, 0, 1 + 9 * 1), 0);
  EXPECT_NEAR(weight_of(faded, 0, 4 + 9 * 4), 1, 1e-6);
  const double t = 1.0 / 3;
  EXPECT_NEAR(weight_of(faded, 0, 2 + 9 * 4), t * t * (3 - 2 * t), 1e-6);
}

TEST(bind_influence, a_wrap_is_exact_on_its_mesh_and_smooth_beside_it) {
  const Part wrap = square("wrap", 4, 0);
  WrapMesh mesh{wrap.mesh.faces};
  PointsD corners = 3 * wrap.mesh.positions.cast<double>();
  corners.col(0).array() -= 0.5;
  const InfluenceObject object = bound(two_squares(), object_of(mesh, corners), [] {
    InfluenceReach reach = range(2);
    reach.geodesic = false;
    return reach;
  }());
  for (const int v : {0, 20, 40, 76})  // on the mesh, the vertex itself
    EXPECT_LT((point_of(object, 0, v) - two_squares().parts[0].mesh.positions.row(v).cast<double>()).norm(),
              1e-6);
  // Above it: several triangles share the vertex, and its point stays close to the foot.
  const std::size_t k = 40;
  const InfluenceBinding& above = object.bindings[1];
  EXPECT_GT(above.offsets[k + 1] - above.offsets[k], 3);
  EXPECT_LT((point_of(object, 1, 40) - Eigen::RowVector3d(4, 4, 0)).norm(), 0.3);
}

TEST(bind_influence, frames_fall_off_from_their_point) {
  const InfluenceObject object =
      bound(two_squares(), object_of(Cluster{}, PointsD(Eigen::RowVector3d(4, 4, 0))), range(4));
  ASSERT_EQ(object.bindings.size(), 1u);
  EXPECT_TRUE(object.bindings[0].offsets.empty() && object.bindings[0].controls.empty());
  EXPECT_NEAR(weight_of(object, 0, 4 + 9 * 4), 1, 1e-6);
  EXPECT_NEAR(weight_of(object, 0, 6 + 9 * 4), std::pow(0.25 - 1, 2), 1e-6);
}

TEST(bind_influence, drawn_weights_come_in_place_of_distances) {
  InfluenceReach reach;
  reach.drawn = {{1, {3, 70}, {0.25f, 1}}};
  const InfluenceObject object = bound(two_squares(), curve(), reach);
  ASSERT_EQ(object.bindings.size(), 1u);
  EXPECT_EQ(object.bindings[0].part, 1);
  EXPECT_THAT(object.bindings[0].vertices, ElementsAre(3, 70));
  EXPECT_THAT(object.bindings[0].weights, ElementsAre(0.25f, 1));
}

TEST(bind_influence, control_points_take_the_joints_of_the_skin_below) {
  Character character = test::head_and_lip();
  character.parts[0].skin_weights = {{0, 1, 2, 4, 5}, {0, 1, 0, 1, 1}, {1, 1, 0.5f, 0.5f, 1}};
  PointsD controls(2, 3);
  controls << 0, 0, 0, 0.5, 0, 0.01;
  const SkinWeights weights = bind_controls(character, controls, 0);
  EXPECT_THAT(weights.offsets, ElementsAre(0, 1, 3));
  EXPECT_THAT(weights.joints, ElementsAre(0, 0, 1));
  EXPECT_NEAR(weights.weights[1] + weights.weights[2], 1, 1e-6);
  EXPECT_NEAR(weights.weights[1], 0.5, 0.05);
  const std::vector<int> lip{2};
  EXPECT_THAT(bind_controls(character, controls, 0, lip).joints, ElementsAre(1, 1));
  EXPECT_THAT(error_of([&] { bind_controls(character, controls, 1); }), HasSubstr("skin 1: does not exist"));
  const std::vector<int> root{0};
  EXPECT_THAT(error_of([&] { bind_controls(character, controls, 0, root); }),
              HasSubstr("node root: is not a joint of the skin"));
}

}  // namespace
}  // namespace mien
