#include "mien/transfer/detail/landmark_influence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mien/transfer/detail/matching.h"

namespace mien::detail {
namespace {

using ::testing::ElementsAre;

/// Two triangles, one edge of length 5 and those of a rectangle of 3 by 4.
Surface rectangle() {
  Surface surface;
  surface.positions.resize(4, 3);
  surface.positions << 0, 0, 0, 3, 0, 0, 3, 4, 0, 0, 4, 0;
  surface.triangles.resize(2, 3);
  surface.triangles << 0, 1, 2, 0, 2, 3;
  return surface;
}

TEST(landmark_influence, a_vertex_may_belong_a_seventh_of_an_edge_away) {
  const Surface surface = rectangle();
  PointsD points(3, 3);
  points << 3, 0, 0, 0, 0, 0, 1.5, 1, 0;  // a corner of one triangle, of both, none
  const double unit = 100;
  const Eigen::VectorXd spread = landmark_spread(
      closest_points(SurfaceQuery(surface.positions, surface.triangles), points), surface, unit);
  const auto expected = [&](double edge) { return 1 + std::pow(.15 * edge / (.005 * unit), 2); };
  EXPECT_NEAR(spread[0], expected((3 + 4) / 2.0), 1e-12);
  EXPECT_NEAR(spread[1], expected((3 + 5 + 5 + 4) / 4.0), 1e-12) << "an edge counts once a triangle";
  EXPECT_EQ(spread[2], 1);
}

TEST(landmark_influence, reaches_from_near_to_far) {
  PointsD landmarks(2, 3), places(4, 3);
  landmarks << 0, 0, 0, 10, 0, 0;
  places << 0, 1, 0, 0, 2, 0, 0, 3, 0, 10, 0.5, 0;
  const Eigen::VectorXd far = far_from(landmarks, places, 1, 3);
  EXPECT_THAT(std::vector<double>(far.begin(), far.end()), ElementsAre(0, 0.5, 1, 0));
  EXPECT_EQ(far_from(PointsD(0, 3), places, 1, 3), Eigen::VectorXd::Ones(4));
}

TEST(landmark_influence, what_is_turned_away_is_further) {
  const Surface surface = rectangle();
  const PointsD up = Eigen::RowVector3d(0, 0, 1).replicate(4, 1);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(4);
  const MatchSurface matched(surface.positions, surface.triangles, ones, ones, std::vector<char>(4, 0));
  const auto at = closest_points(matched.query, surface.positions.topRows(1));
  const PointsD normal = matched.normal_at(at[0]).transpose();
  EXPECT_TRUE(normal.isApprox(up.topRows(1)));
  const PointsD place = PointsD::Zero(2, 3);
  PointsD normals(2, 3);
  normals << 0, 0, 1, 0, 0, -1;
  const Eigen::VectorXd far = far_from(facing(place.topRows(1), normal, 1), facing(place, normals, 1), 0, 4);
  EXPECT_EQ(far[0], 0);
  EXPECT_NEAR(far[1], 0.5, 1e-12) << "half of 4 away, which is half way";
}

}  // namespace
}  // namespace mien::detail
