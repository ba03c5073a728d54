#include "mien/transfer/carry_skin_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mien::test {
namespace {

using ::testing::ElementsAre;

WeightMatrix matrix(const Eigen::MatrixXd& dense) {
  return WeightMatrix(dense.sparseView());
}

TEST(limit_influences, an_empty_matrix_stays_empty) {
  EXPECT_EQ(limit_influences(WeightMatrix(0, 3), 2).rows(), 0);
  EXPECT_EQ(limit_influences(WeightMatrix(4, 3), 2).nonZeros(), 0);
}

TEST(limit_influences, keeps_the_largest_and_divides_by_their_sum) {
  Eigen::MatrixXd weights(2, 4);
  weights << 0.1, 0.5, 0.0, 0.4, 2, 1, 1, 4;
  Eigen::MatrixXd expected(2, 4);
  expected << 0, 5.0 / 9, 0, 4.0 / 9, 1.0 / 3, 0, 0, 2.0 / 3;
  EXPECT_TRUE(Eigen::MatrixXd(limit_influences(matrix(weights), 2)).isApprox(expected, 1e-15));
}

TEST(limit_influences, zero_means_no_limit) {
  Eigen::MatrixXd weights(1, 5);
  weights << 0.1, 0.2, 0.3, 0.2, 0.2;
  EXPECT_TRUE(Eigen::MatrixXd(limit_influences(matrix(weights), 0)).isApprox(weights, 1e-15));
}

TEST(limit_influences, of_equal_shares_the_lower_joint_stays) {
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Constant(1, 5, 0.2);
  Eigen::MatrixXd expected(1, 5);
  expected << 0.5, 0.5, 0, 0, 0;
  EXPECT_TRUE(Eigen::MatrixXd(limit_influences(matrix(weights), 2)).isApprox(expected, 1e-15));
}

TEST(limit_influences, drops_small_shares_but_never_all) {
  Eigen::MatrixXd weights(2, 3);
  weights << 0.9995, 0.0004, 0.0001, 1e-5, 3e-5, 2e-5;
  Eigen::MatrixXd expected(2, 3);
  expected << 1, 0, 0, 0, 1, 0;
  EXPECT_TRUE(Eigen::MatrixXd(limit_influences(matrix(weights), 0)).isApprox(expected, 1e-15));
}

TEST(limit_influences, negative_weights_have_no_share) {
  Eigen::MatrixXd weights(1, 3);
  weights << -0.5, 1.0, 0.5;
  Eigen::MatrixXd expected(1, 3);
  expected << 0, 2.0 / 3, 1.0 / 3;
  EXPECT_TRUE(Eigen::MatrixXd(limit_influences(matrix(weights), 3)).isApprox(expected, 1e-15));
}

TEST(to_skin_weights, follows_the_parts_order) {
  Eigen::MatrixXd weights(2, 3);
  weights << 0.25, 0, 0.75, 0, 1, 0;
  const SkinWeights got = to_skin_weights(matrix(weights), {1, -1, 0, 1});
  EXPECT_THAT(got.offsets, ElementsAre(0, 1, 1, 3, 4));
  EXPECT_THAT(got.joints, ElementsAre(1, 0, 2, 1));
  EXPECT_THAT(got.weights, ElementsAre(1.f, 0.25f, 0.75f, 1.f));
}

}  // namespace
}  // namespace mien::test
