#include "mien/geometry/moving_similarity.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;

Similarity some_similarity(double scale) {
  return {scale, Eigen::AngleAxisd(2.1, Vector3d(1, 0.3, -2).normalized()).toRotationMatrix(), {5, 1, -3}};
}

TEST(MovingSimilarity, refuses_what_cannot_be_fitted) {
  const PointsD four = random_points(4, 1);
  EXPECT_EQ(failure_of([&] { MovingSimilarity(four.topRows(2), four.topRows(2), 1); }),
            "similarity: fewer than 3 point pairs; 3 or more");
  EXPECT_EQ(failure_of([&] { MovingSimilarity(four, four.topRows(3), 1); }),
            "similarity: point sets of different sizes; as many points on both sides");
  PointsD line(3, 3);
  line << 0, 0, 0, 1, 1, 1, 2, 2, 2;
  EXPECT_EQ(failure_of([&] { MovingSimilarity(line, line, 1); }),
            "similarity: all points on one line; points that span a plane");
}

TEST(MovingSimilarity, reproduces_a_similarity_everywhere) {
  const Similarity truth = some_similarity(2.5);
  const PointsD from = random_points(30, 2), probes = 4 * random_points(20, 3);
  const MovingSimilarity moving(from, truth(from), 0.1);
  for (Eigen::Index i = 0; i < probes.rows(); ++i) {
    const Vector3d x = probes.row(i).transpose();
    EXPECT_TRUE(moving(x).isApprox(truth(x), 1e-9));
    EXPECT_NEAR(moving.at(x).scale, 2.5, 1e-9);
    EXPECT_TRUE(moving.at(x).rotation.isApprox(truth.rotation, 1e-9));
  }
}

TEST(MovingSimilarity, commutes_with_similarities_of_either_side) {
  const PointsD from = random_points(30, 4), to = from + 0.2 * random_points(30, 5);
  const MovingSimilarity moving(from, to, 0.2);
  const Similarity before = some_similarity(3), after = some_similarity(0.4);
  const MovingSimilarity mapped(before(from), after(to), 0.2 * 3);
  for (Eigen::Index i = 0; i < 10; ++i) {
    const Vector3d x = 1.5 * random_points(10, 6).row(i).transpose();
    EXPECT_TRUE(mapped(before(x)).isApprox(after(moving(x)), 1e-9));
  }
}

TEST(MovingSimilarity, comes_close_to_its_points_when_it_is_hard) {
  const PointsD from = random_points(30, 7), to = from + 0.1 * random_points(30, 8);
  const MovingSimilarity hard(from, to, 1e-4), soft(from, to, 10);
  const Similarity whole = fit_similarity(from, to);
  for (Eigen::Index i = 0; i < from.rows(); ++i) {
    const Vector3d x = from.row(i).transpose();
    EXPECT_LT((hard(x) - to.row(i).transpose()).norm(), 1e-4);
    EXPECT_LT((soft(x) - whole(x)).norm(), 0.01);  // one similarity for all
  }
}

TEST(MovingSimilarity, a_weight_counts_as_that_many_points) {
  const PointsD from = random_points(12, 3), to = from + 0.1 * random_points(12, 4);
  PointsD twice_from(13, 3), twice_to(13, 3);
  twice_from << from, from.row(5);
  twice_to << to, to.row(5);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(12);
  weights[5] = 2;
  const Vector3d x(0.2, 0.1, -0.3);
  EXPECT_LT(
      (MovingSimilarity(from, to, 0.1, weights)(x) - MovingSimilarity(twice_from, twice_to, 0.1)(x)).norm(),
      1e-12);
}

TEST(MovingSimilarity, stays_a_sane_map_far_away) {
  const PointsD from = random_points(30, 9), to = 2 * from + 0.1 * random_points(30, 10);
  const MovingSimilarity moving(from, to, 0.1);
  const Similarity far = moving.at({1e3, -2e3, 1e3});
  EXPECT_NEAR(far.scale, 2, 0.2);
  EXPECT_NEAR(far.rotation.determinant(), 1, 1e-9);
}

}  // namespace
}  // namespace mien::test
