#include "mien/transfer/detail/eye_balls.h"

#include <gtest/gtest.h>

#include <numeric>

#include "transfer/faces.h"

namespace mien::detail {
namespace {

using test::random_points;

/// Balls found among pooled points that are one piece of this kind.
std::vector<Ball> balls_of(const PointsD& points, PieceKind kind, double unit = 10) {
  const Pool source;
  Pool target;
  target.positions = points;
  const PoolSurface surface;
  const std::vector<char> skins;
  const Similarity similarity;
  const std::vector<PieceMotion> motions;
  PiecePlan plan;
  plan.kind = kind;
  plan.vertices.resize(static_cast<std::size_t>(points.rows()));
  std::iota(plan.vertices.begin(), plan.vertices.end(), 0);
  return eye_balls({source, target, skins, skins, surface, points, similarity, motions, unit}, {plan});
}

/// Points on a sphere around (1, 2, 3).
PointsD sphere(int count, double radius) {
  return (radius * random_points(count, 1).rowwise().normalized()).rowwise() + Eigen::RowVector3d(1, 2, 3);
}

TEST(eye_balls, are_the_spheres_of_eyes) {
  const auto balls = balls_of(sphere(40, 0.5), PieceKind::eye);
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_NEAR(balls[0].radius, 0.5, 1e-9);
  EXPECT_TRUE(balls[0].centre.isApprox(Eigen::Vector3d(1, 2, 3), 1e-9));
  PointsD front = sphere(200, 0.5);  // a cap says as much
  front.col(2) = front.col(2).array().max(3.2).matrix();
  for (Eigen::Index v = 0; v < front.rows(); ++v) {
    const Eigen::RowVector3d out = front.row(v) - Eigen::RowVector3d(1, 2, 3);
    front.row(v) = Eigen::RowVector3d(1, 2, 3) + 0.5 * out.normalized();
  }
  EXPECT_NEAR(balls_of(front, PieceKind::eye).at(0).radius, 0.5, 1e-9);
}

TEST(eye_balls, are_nothing_else) {
  EXPECT_TRUE(balls_of(sphere(40, 0.5), PieceKind::teeth).empty());
  EXPECT_TRUE(balls_of(sphere(9, 0.5), PieceKind::eye).empty());        // too few to say
  EXPECT_TRUE(balls_of(sphere(40, 0.5), PieceKind::eye, 0.4).empty());  // larger than the face
  PointsD stretched = sphere(60, 0.5);
  stretched.col(0) *= 3;
  EXPECT_TRUE(balls_of(stretched, PieceKind::eye).empty());
  PointsD flat = random_points(60, 2);
  flat.col(2).setZero();
  for (const Ball& ball : balls_of(flat, PieceKind::eye)) EXPECT_TRUE(std::isfinite(ball.radius));
}

TEST(keep_out_of_eyes, pushes_out_along_the_radius_and_leaves_the_rest) {
  const std::vector<Ball> balls{{{0, 0, 0}, 1}};
  PointsD positions(5, 3), deltas(5, 3);
  positions << 0, 2, 0,  // sinks in
      0, 1.01, 0,        // lay close already
      0, 0.9, 0,         // lay inside
      0, 2, 0,           // stays above
      0, 1.005, 0;       // does not move
  deltas << 0, -1.5, 0, 0, -0.5, 0, 0, -0.5, 0, 0, -0.9, 0, 0, 0, 0;
  const PointsD before = deltas;
  keep_out_of_eyes(balls, positions, deltas);
  EXPECT_NEAR(positions(0, 1) + deltas(0, 1), 1.015, 1e-12);
  EXPECT_NEAR(positions(1, 1) + deltas(1, 1), 1.01, 1e-12);
  EXPECT_EQ(deltas.bottomRows(3), before.bottomRows(3));
  PointsD untouched = before;
  keep_out_of_eyes({}, positions, untouched);
  EXPECT_EQ(untouched, before);
}

TEST(keep_out_of_eyes, never_leaves_skin_deeper_than_it_lay) {
  const std::vector<Ball> balls{{{0.2, 0, 0}, 0.6}};
  const PointsD positions = random_points(500, 3);
  PointsD deltas = 0.7 * random_points(500, 4);
  keep_out_of_eyes(balls, positions, deltas);
  for (Eigen::Index v = 0; v < 500; ++v) {
    const double before = (positions.row(v).transpose() - balls[0].centre).norm();
    const double after = ((positions + deltas).row(v).transpose() - balls[0].centre).norm();
    if (before < 0.6) continue;
    EXPECT_GE(after, std::min(before, 1.015 * 0.6) - 1e-12) << v;
  }
}

}  // namespace
}  // namespace mien::detail
