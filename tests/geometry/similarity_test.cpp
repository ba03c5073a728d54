#include "mien/geometry/similarity.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;

Similarity some_similarity() {
  return {2.5, Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix(), {3, -4, 5}};
}

TEST(fit_similarity, invalid_input_is_named) {
  const PointsD three = random_points(3, 1), four = random_points(4, 1);
  EXPECT_EQ(failure_of([&] { fit_similarity(three, four); }),
            "similarity: point sets of different sizes; as many points on both sides");
  EXPECT_EQ(failure_of([&] { fit_similarity(three.topRows(2), three.topRows(2)); }),
            "similarity: fewer than 3 point pairs; 3 or more");
  PointsD line(3, 3);
  line << 0, 0, 0, 1, 1, 1, 2, 2, 2;
  EXPECT_EQ(failure_of([&] { fit_similarity(line, three); }),
            "similarity: all points on one line; points that span a plane");
}

TEST(fit_similarity, finds_the_one_that_was_applied) {
  const Similarity truth = some_similarity();
  const PointsD points = random_points(10, 2);
  const Similarity found = fit_similarity(points, truth(points));
  EXPECT_NEAR(found.scale, truth.scale, 1e-12);
  EXPECT_TRUE(found.rotation.isApprox(truth.rotation, 1e-12));
  EXPECT_TRUE(found.translation.isApprox(truth.translation, 1e-12));
}

TEST(fit_similarity, equal_weights_say_nothing) {
  const PointsD from = random_points(10, 5), to = random_points(10, 6);
  const Similarity plain = fit_similarity(from, to),
                   weighted = fit_similarity(from, to, Eigen::VectorXd::Constant(10, 7.5));
  EXPECT_NEAR(plain.scale, weighted.scale, 1e-12);
  EXPECT_TRUE(plain.rotation.isApprox(weighted.rotation, 1e-12));
  EXPECT_TRUE(plain.translation.isApprox(weighted.translation, 1e-12));
}

TEST(fit_similarity, a_weight_of_two_is_the_pair_twice) {
  const PointsD from = random_points(8, 7), to = random_points(8, 8);
  PointsD from_twice(9, 3), to_twice(9, 3);
  from_twice << from, from.row(3);
  to_twice << to, to.row(3);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(8);
  weights[3] = 2;
  const Similarity plain = fit_similarity(from_twice, to_twice), weighted = fit_similarity(from, to, weights);
  EXPECT_NEAR(plain.scale, weighted.scale, 1e-12);
  EXPECT_TRUE(plain.rotation.isApprox(weighted.rotation, 1e-12));
  EXPECT_TRUE(plain.translation.isApprox(weighted.translation, 1e-12));
}

TEST(fit_similarity, pairs_of_little_weight_hardly_count) {
  const Similarity truth = some_similarity();
  const PointsD from = random_points(10, 9);
  PointsD to = truth(from);
  to.row(0) += Eigen::RowVector3d(5, -5, 5);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(10);
  weights[0] = 1e-9;
  EXPECT_NEAR(fit_similarity(from, to, weights).scale, truth.scale, 1e-6);
  EXPECT_GT(std::abs(fit_similarity(from, to).scale - truth.scale), 1e-2);
}

TEST(fit_similarity, never_mirrors) {
  const PointsD points = random_points(10, 3);
  PointsD mirrored = points;
  mirrored.col(0) *= -1;
  EXPECT_NEAR(fit_similarity(points, mirrored).rotation.determinant(), 1, 1e-12);
}

TEST(similarity, inverse_undoes) {
  const Similarity s = some_similarity();
  const PointsD points = random_points(10, 4);
  EXPECT_TRUE(s.inverse()(s(points)).isApprox(points, 1e-12));
  EXPECT_TRUE(s.inverse().of_vectors(s.of_vectors(points)).isApprox(points, 1e-12));
}

TEST(closest_rotation, of_a_stretched_rotation_is_the_rotation) {
  const Eigen::Matrix3d rotation = some_similarity().rotation;
  EXPECT_TRUE(closest_rotation(rotation * Vector3d(1, 2, 3).asDiagonal() * 4).determinant() > 0.999);
  const Eigen::Matrix3d symmetric = Vector3d(1, 2, 3).asDiagonal();
  EXPECT_TRUE(closest_rotation(rotation * symmetric).isApprox(rotation, 1e-12));
}

}  // namespace
}  // namespace mien::test
