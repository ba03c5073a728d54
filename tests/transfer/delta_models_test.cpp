#include "mien/transfer/delta_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "transfer/faces.h"

namespace mien::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(name_of, says_what_the_command_line_says) {
  EXPECT_EQ(name_of(DeltaModel::automatic), "auto");
  EXPECT_EQ(name_of(DeltaModel::local), "local");
  EXPECT_EQ(name_of(DeltaModel::raw), "raw");
  EXPECT_EQ(name_of(DeltaModel::copy), "copy");
  EXPECT_EQ(name_of(DeltaModel::warp), "warp");
  EXPECT_EQ(name_of(DeltaModel::thesis), "thesis");
}

TEST(local_scale, is_the_scale_of_a_scaled_surface) {
  const auto plane = grid(8);
  for (const double scale : {0.25, 1.0, 7.0}) {
    const Eigen::VectorXd found = local_scale(plane.positions, scale * plane.positions, plane.triangles, 2);
    EXPECT_LT((found.array() / scale - 1).abs().maxCoeff(), 1e-10) << scale;
  }
}

TEST(local_scale, lies_between_the_scales_of_two_halves) {
  const auto plane = grid(20);
  PointsD stretched = plane.positions;
  for (Eigen::Index v = 0; v < stretched.rows(); ++v)
    stretched(v, 0) = plane.positions(v, 0) + 3 * std::max(0.0, plane.positions(v, 0) - 10);
  const Eigen::VectorXd found = local_scale(plane.positions, stretched, plane.triangles, 1.5);
  EXPECT_GT(found.minCoeff(), 0.95);
  EXPECT_LT(found.maxCoeff(), 2.05);
  EXPECT_NEAR(found[10 * 21], 1, 0.05);       // areas stay on the left
  EXPECT_NEAR(found[10 * 21 + 20], 2, 0.05);  // and are four times as large on the right
}

TEST(local_scale, is_finite_where_there_is_no_area) {
  auto plane = grid(2);
  plane.positions.conservativeResize(10, 3);
  plane.positions.row(9) << 50, 50, 50;  // belongs to no triangle
  EXPECT_TRUE(local_scale(plane.positions, 2 * plane.positions, plane.triangles, 1).allFinite());
  EXPECT_TRUE(local_scale(plane.positions, 0 * plane.positions, plane.triangles, 1).allFinite());
}

TEST(farthest_points, spread_out_from_the_end) {
  PointsD line(5, 3);
  line << 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 10, 0, 0;
  EXPECT_THAT(farthest_points(line, 3), ElementsAre(4, 0, 3));
  EXPECT_THAT(farthest_points(line, 0), IsEmpty());
  EXPECT_THAT(farthest_points(PointsD(0, 3), 4), IsEmpty());
}

TEST(farthest_points, never_choose_one_place_twice) {
  EXPECT_EQ(farthest_points(random_points(20, 1), 100).size(), 20u);
  PointsD twice(40, 3);
  twice << random_points(20, 1), random_points(20, 1);
  const auto chosen = farthest_points(twice, 100);
  EXPECT_EQ(chosen.size(), 20u);
  EXPECT_EQ(std::set<int>(chosen.begin(), chosen.end()).size(), 20u);
}

TEST(dense_spline, reproduces_an_affine_map) {
  const PointsD aligned = random_points(100, 1), landmarks = random_points(10, 2);
  Eigen::Matrix3d linear;
  linear << 2, 0.5, 0, 0, 1, -0.2, 0.1, 0, 3;
  const ThinPlateSpline spline = dense_spline(aligned, aligned * linear.transpose(), landmarks,
                                              landmarks * linear.transpose(), farthest_points(aligned, 40));
  const PointsD probes = 3 * random_points(20, 3);
  EXPECT_TRUE(spline(probes).isApprox(probes * linear.transpose(), 1e-8));
}

TEST(dense_spline, takes_a_place_once) {
  const PointsD points = random_points(30, 4);
  EXPECT_NO_THROW(dense_spline(points, points, points, points, farthest_points(points, 500)));
}

/// A bumpy grid under a similarity: every model is known.
class CarryDeltas : public ::testing::Test {
 protected:
  CarryDeltas() : similarity(some_similarity(2.5)), positions(random_points(60, 5)) {
    deltas = 0.1 * random_points(60, 6);
    deltas.row(7).setZero();
    const PointsD samples = random_points(60, 7);
    landmarks = std::make_unique<ThinPlateSpline>(samples, similarity(samples));
    dense = std::make_unique<ThinPlateSpline>(similarity(samples), similarity(samples));
    maps.positions = positions;
    maps.similarity = similarity;
    maps.aligned = similarity(positions);
    maps.scale = Eigen::VectorXd::Ones(60);
    maps.landmarks = landmarks.get();
    maps.dense = dense.get();
  }
  Similarity similarity;
  PointsD positions, deltas;
  std::unique_ptr<ThinPlateSpline> landmarks, dense;
  DeltaMaps maps;
};

TEST_F(CarryDeltas, all_models_but_copy_follow_a_similarity) {
  const PointsD turned = similarity.of_vectors(deltas);
  for (const DeltaModel model :
       {DeltaModel::automatic, DeltaModel::local, DeltaModel::raw, DeltaModel::warp, DeltaModel::thesis})
    EXPECT_TRUE(carry_deltas(maps, model, 0.3, deltas).isApprox(turned, 1e-9)) << name_of(model);
  EXPECT_TRUE(carry_deltas(maps, DeltaModel::copy, 0, deltas).isApprox(turned / 2.5, 1e-12));
}

TEST_F(CarryDeltas, local_multiplies_by_the_scale) {
  maps.scale = Eigen::VectorXd::LinSpaced(60, 0.5, 2);
  EXPECT_TRUE(carry_deltas(maps, DeltaModel::local, 0, deltas)
                  .isApprox(maps.scale.asDiagonal() * similarity.of_vectors(deltas), 1e-12));
}

TEST_F(CarryDeltas, splines_carry_the_ends_of_displacements) {
  const ThinPlateSpline bent(random_points(20, 8), 1.2 * random_points(20, 9));
  maps.dense = maps.landmarks = &bent;
  const PointsD turned = similarity.of_vectors(deltas);
  EXPECT_TRUE(carry_deltas(maps, DeltaModel::warp, 1, deltas)
                  .isApprox(bent(PointsD(maps.aligned + turned)) - bent(maps.aligned), 1e-9));
  EXPECT_TRUE(carry_deltas(maps, DeltaModel::thesis, 1, deltas)
                  .isApprox(bent(PointsD(positions + deltas)) - bent(positions), 1e-9));
}

TEST_F(CarryDeltas, automatic_blends_local_and_warp) {
  const ThinPlateSpline bent(random_points(20, 8), 1.2 * random_points(20, 9));
  maps.dense = &bent;
  maps.scale *= 1.5;
  const PointsD local = carry_deltas(maps, DeltaModel::local, 0, deltas),
                warp = carry_deltas(maps, DeltaModel::warp, 1, deltas);
  EXPECT_EQ(carry_deltas(maps, DeltaModel::automatic, 0, deltas), local);
  EXPECT_EQ(carry_deltas(maps, DeltaModel::automatic, 1, deltas), warp);
  EXPECT_TRUE(
      carry_deltas(maps, DeltaModel::automatic, 0.25, deltas).isApprox(0.75 * local + 0.25 * warp, 1e-12));
}

TEST_F(CarryDeltas, what_does_not_move_stays) {
  for (const DeltaModel model : {DeltaModel::automatic, DeltaModel::local, DeltaModel::raw, DeltaModel::copy,
                                 DeltaModel::warp, DeltaModel::thesis}) {
    EXPECT_EQ(carry_deltas(maps, model, 0.5, deltas).row(7).norm(), 0) << name_of(model);
    EXPECT_EQ(carry_deltas(maps, model, 0.5, PointsD::Zero(60, 3)).norm(), 0) << name_of(model);
  }
}

}  // namespace
}  // namespace mien::test
