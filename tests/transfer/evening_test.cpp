#include "mien/transfer/detail/evening.h"

#include <gtest/gtest.h>

#include "transfer/faces.h"

namespace mien::test {
namespace {

/// Each vertex of a flat grid at itself.
std::vector<SourcePoint> own_places(const mien::Surface& surface) {
  std::vector<SourcePoint> points(static_cast<std::size_t>(surface.positions.rows()));
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      points[static_cast<std::size_t>(surface.triangles(t, k))] = {static_cast<int>(t),
                                                                   Eigen::Vector3d::Unit(k), 0, true};
  return points;
}

struct Flat {
  mien::Surface surface;
  std::vector<SourcePoint> points;
  Flat() {
    const auto made = grid(6);
    surface = {made.positions, made.triangles};
    points = own_places(surface);
  }
  Eigen::MatrixXd matrix(const PointsD& aligned) const {
    return detail::evening(points, aligned, surface.triangles, surface);
  }
};
constexpr int middle = 3 * 7 + 3;

TEST(evening, places_that_lie_evenly_stay_as_they_are) {
  const Flat flat;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(49, 49);
  EXPECT_LT((flat.matrix(flat.surface.positions) - identity).norm(), 1e-12);
  const PointsD moved = flat.surface.positions.rowwise() + Eigen::RowVector3d(1, 2, 3);
  EXPECT_LT((flat.matrix(moved) - identity).norm(), 1e-12);
}

TEST(evening, a_place_that_sticks_out_is_moved_towards_its_neighbours) {
  const Flat flat;
  PointsD rough = flat.surface.positions;
  rough(middle, 0) += 0.1;
  const Eigen::MatrixXd matrix = flat.matrix(rough);
  const double edge = (4 + 2 * std::sqrt(2)) / 6;  // four sides and two diagonals
  const double share = 1.4 * 0.1 / edge;
  EXPECT_NEAR(matrix(middle, middle), 1 - share, 1e-12);
  EXPECT_NEAR(matrix(middle, middle + 1), share / 6, 1e-12);
  EXPECT_LT((matrix.rowwise().sum() - Eigen::VectorXd::Ones(49)).norm(), 1e-12);
  EXPECT_GE(matrix.minCoeff(), 0);
}

TEST(evening, never_takes_more_than_most_of_it) {
  const Flat flat;
  PointsD rough = flat.surface.positions;
  rough(middle, 2) += 100;
  EXPECT_NEAR(flat.matrix(rough)(middle, middle), 0.3, 1e-12);
}

TEST(evening, size_and_turn_do_not_matter) {
  const Flat flat;
  PointsD rough = flat.surface.positions;
  rough(middle, 1) += 0.2;
  const Similarity by = some_similarity(8);
  Flat other = flat;
  other.surface.positions = by(flat.surface.positions);
  EXPECT_LT((other.matrix(by(rough)) - flat.matrix(rough)).norm(), 1e-9);
}

TEST(evening, what_is_filled_in_keeps_what_it_has) {
  Flat flat;
  flat.points[middle].accepted = false;
  PointsD rough = flat.surface.positions;
  rough(middle, 2) += 1;
  EXPECT_EQ(flat.matrix(rough)(middle, middle), 1);
}

}  // namespace
}  // namespace mien::test
