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
