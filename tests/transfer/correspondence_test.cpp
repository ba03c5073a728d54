#include "mien/transfer/correspondence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/transfer/thesis.h"
#include "transfer/faces.h"

namespace mien::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

mien::Surface plane(int n) {
  const auto g = grid(n);
  return {g.positions, g.triangles};
}

int accepted_count(const std::vector<SourcePoint>& points) {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [](const SourcePoint& p) { return p.accepted; }));
}

Eigen::Vector3d place(const mien::Surface& surface, const SourcePoint& point) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    position +=
        point.barycentric[k] * surface.positions.row(surface.triangles(point.triangle, k)).transpose();
  return position;
}

TEST(find_correspondence, of_a_surface_with_itself_is_itself) {
  const mien::Surface surface = plane(6);
  const auto points = find_correspondence(no_registration(surface, 10), surface, surface);
  for (std::size_t v = 0; v < points.size(); ++v) {
    EXPECT_TRUE(points[v].accepted);
    EXPECT_NEAR(points[v].distance, 0, 1e-12);
    EXPECT_LT((place(surface, points[v]) - surface.positions.row(v).transpose()).norm(), 1e-9);
  }
}

TEST(find_correspondence, nothing_is_taken_from_beyond_reach) {
  const mien::Surface surface = plane(4);
  mien::Surface above = surface;
  above.positions.col(2).setConstant(0.5);
  CorrespondenceOptions options;
  options.reach = 0.06;  // 0.6 at a face of size 10
  EXPECT_EQ(accepted_count(find_correspondence(no_registration(surface, 10), surface, above, options)), 25);
  const auto far = find_correspondence(no_registration(surface, 8), surface, above, options);
  EXPECT_EQ(accepted_count(far), 0);
  for (const SourcePoint& point : far) {
    EXPECT_GE(point.triangle, 0);  // the closest place all the same
    EXPECT_NEAR(point.distance, 0.5, 1e-6);
  }
}

TEST(find_correspondence, what_faces_the_other_way_is_another_place) {
  const mien::Surface surface = plane(4);
  mien::Surface back = surface;
  back.triangles.col(1).swap(back.triangles.col(2));
  EXPECT_EQ(accepted_count(find_correspondence(no_registration(surface, 10), surface, back)), 0);
}

TEST(find_correspondence, skin_and_cavity_are_never_the_same_place) {
  const mien::Surface surface = plane(4);
  Registration registration = no_registration(surface, 10);
  registration.source_openness.setConstant(0.05);
  EXPECT_EQ(accepted_count(find_correspondence(registration, surface, surface)), 0);
  registration.target_openness.setConstant(0.05);
  EXPECT_EQ(accepted_count(find_correspondence(registration, surface, surface)), 25);
  registration.source_openness.setConstant(0.3);  // in between fits both
  EXPECT_EQ(accepted_count(find_correspondence(registration, surface, surface)), 25);
}

TEST(thesis_correspondence, accepts_everything) {
  const mien::Surface surface = plane(4);
  mien::Surface back = surface;
  back.triangles.col(1).swap(back.triangles.col(2));
  back.positions.col(2).setConstant(100);
  EXPECT_EQ(accepted_count(thesis_correspondence(no_registration(surface, 1), surface, back)), 25);
}

TEST(reject_torn, without_shapes_or_joints_nothing_is_torn) {
  const mien::Surface surface = plane(4);
  auto points = find_correspondence(no_registration(surface, 10), surface, surface);
  reject_torn({}, surface, surface, points);
  EXPECT_EQ(accepted_count(points), 25);
}

TEST(reject_torn, takes_back_the_vertex_that_leaves_its_neighbours) {
  const mien::Surface surface = plane(6);
  auto points = find_correspondence(no_registration(surface, 10), surface, surface);
  TearInput tears;
  tears.shapes = 2;
  tears.unit = 10;
  tears.delta = [&](std::size_t s) {
    PointsD delta = PointsD::Zero(49, 3);
    if (s == 0) delta.col(2).setConstant(50);  // all together
    if (s == 1) delta.row(24) << 0, 0, 6;      // the middle alone, more than four edges
    return delta;
  };
  reject_torn(tears, surface, surface, points);
  EXPECT_FALSE(points[24].accepted);
  EXPECT_EQ(accepted_count(points), 48);
}

TEST(reject_torn, a_stretch_below_four_edges_is_none) {
  const mien::Surface surface = plane(6);
  auto points = find_correspondence(no_registration(surface, 10), surface, surface);
  TearInput tears;
  tears.shapes = 1;
  tears.unit = 10;
  tears.delta = [&](std::size_t) {
    PointsD delta = PointsD::Zero(49, 3);
    delta.row(24) << 0, 0, 3.9;
    return delta;
  };
  reject_torn(tears, surface, surface, points);
  EXPECT_EQ(accepted_count(points), 49);
}

TEST(reject_torn, takes_back_the_vertex_that_follows_another_joint) {
  const mien::Surface surface = plane(6);
  auto points = find_correspondence(no_registration(surface, 10), surface, surface);
  Eigen::MatrixXd weights(49, 2);
  weights << Eigen::VectorXd::Ones(49), Eigen::VectorXd::Zero(49);
  weights.row(24) << 0.1, 0.9;
  TearInput tears;
  tears.weights = SparseRows(weights.sparseView());
  reject_torn(tears, surface, surface, points);
  EXPECT_FALSE(points[24].accepted);
  EXPECT_EQ(accepted_count(points), 48);
}

/// A strip of ten whose ends alone are accepted.
class Strip : public ::testing::Test {
 protected:
  Strip()
      : strip(equilateral_strip(10)), points(find_correspondence(no_registration(strip, 50), strip, strip)) {
    for (std::size_t v = 0; v < points.size(); ++v) {
      const double x = strip.positions(static_cast<Eigen::Index>(v), 0);
      points[v].accepted = x < 0.75 || x > 9.25;
    }
  }
  mien::Surface strip;
  std::vector<SourcePoint> points;
};

TEST_F(Strip, is_filled_harmonically) {
  const AttributeCarrier carrier(points, strip, strip);
  EXPECT_THAT(carrier.filled(), SizeIs(21 - 4));
  EXPECT_EQ(carrier.correspondence().size(), 21u);
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(21, 2, 1e6);  // what is not accepted is not looked at
  for (Eigen::Index v = 0; v < 21; ++v)
    if (points[v].accepted) values.row(v) << 3 * strip.positions(v, 0) - 1, 7;
  const Eigen::MatrixXd carried = carrier(values);
  for (Eigen::Index v = 0; v < 21; ++v) {
    EXPECT_NEAR(carried(v, 0), 3 * strip.positions(v, 0) - 1, 1e-9) << v;
    EXPECT_NEAR(carried(v, 1), 7, 1e-9) << v;
  }
}

TEST_F(Strip, is_linear_in_the_values) {
  const AttributeCarrier carrier(points, strip, strip);
  const Eigen::MatrixXd a = random_points(21, 1), b = random_points(21, 2);
  EXPECT_TRUE(carrier(Eigen::MatrixXd(2 * a - 0.5 * b)).isApprox(2 * carrier(a) - 0.5 * carrier(b), 1e-12));
}

TEST_F(Strip, sparse_values_are_carried_as_dense_ones) {
  const AttributeCarrier carrier(points, strip, strip);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(21, 3);
  for (Eigen::Index v = 0; v < 21; ++v) {
    const double t = strip.positions(v, 0) / 10;
    weights.row(v) << 1 - t, t * 0.75, t * 0.25;
  }
  const SparseRows carried = carrier(SparseRows(weights.sparseView()));
  EXPECT_TRUE(Eigen::MatrixXd(carried).isApprox(carrier(weights), 1e-12));
  const Eigen::VectorXd sums = carried * Eigen::VectorXd::Ones(3);
  EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-12);
}

TEST(AttributeCarrier, zeros_stay_away_from_where_nothing_brings_them) {
  const mien::Surface surface = plane(6);
  auto points = find_correspondence(no_registration(surface, 50), surface, surface);
  points[24].accepted = false;
  const AttributeCarrier carrier(points, surface, surface);
  Eigen::MatrixXd weights(49, 2);
  weights << Eigen::VectorXd::Ones(49), Eigen::VectorXd::Zero(49);
  const SparseRows carried = carrier(SparseRows(weights.sparseView()));
  EXPECT_EQ(carried.nonZeros(), 49);
  EXPECT_NEAR(carried.coeff(24, 0), 1, 1e-12);
}

TEST(AttributeCarrier, a_piece_without_any_accepted_vertex_takes_the_closest_point) {
  const mien::Surface surface = plane(4);
  mien::Surface target;
  target.positions.resize(28, 3);
  target.positions << surface.positions, PointsD::Constant(3, 3, 1);
  target.positions.bottomRows(3) << 1, 1, 5, 2, 1, 5, 1, 2, 5;
  target.triangles.resize(33, 3);
  target.triangles << surface.triangles, Eigen::RowVector3i(25, 26, 27);
  Registration registration = no_registration(surface, 10);
  registration.target_openness = Eigen::VectorXd::Ones(28);
  auto points = find_correspondence(registration, surface, target);
  EXPECT_EQ(accepted_count(points), 25);
  const AttributeCarrier carrier(points, surface, target);
  EXPECT_THAT(carrier.filled(), IsEmpty());
  const Eigen::MatrixXd carried = carrier(Eigen::MatrixXd(surface.positions));
  EXPECT_TRUE(carried.row(26).isApprox(Eigen::RowVector3d(2, 1, 0), 1e-9));
}

}  // namespace
}  // namespace mien::test
