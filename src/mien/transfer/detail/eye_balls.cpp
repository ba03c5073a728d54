#include "mien/transfer/detail/eye_balls.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace mien::detail {
namespace {

constexpr double clearance = 1.015, roundness = 0.08;

/// |p|^2 = 2 c . p + k in least squares, k = r^2 - |c|^2.
Ball fit_ball(const PointsD& points) {
  const Eigen::RowVector3d mean = points.colwise().mean();
  const PointsD p = points.rowwise() - mean;
  Eigen::MatrixXd system(p.rows(), 4);
  system << 2 * p, Eigen::VectorXd::Ones(p.rows());
  const Eigen::Vector4d solution = system.colPivHouseholderQr().solve(p.rowwise().squaredNorm());
  Ball ball;
  ball.radius = std::sqrt(std::max(0.0, solution[3] + solution.head<3>().squaredNorm()));
  ball.centre = solution.head<3>() + mean.transpose();
  return ball;
}

}  // namespace

std::vector<Ball> eye_balls(const PieceInput& input, const std::vector<PiecePlan>& plans) {
  std::vector<Ball> balls;
  for (const PiecePlan& plan : plans) {
    if (plan.kind != PieceKind::eye || plan.vertices.size() < 10) continue;
    const PointsD points = input.target.positions(plan.vertices, Eigen::all);
    const Ball ball = fit_ball(points);
    const Eigen::ArrayXd off =
        (points.rowwise() - ball.centre.transpose()).rowwise().norm().array() - ball.radius;
    if (ball.radius > 0 && ball.radius < input.unit &&
        std::sqrt(off.square().mean()) < roundness * ball.radius)
      balls.push_back(ball);
  }
  return balls;
}

void keep_out_of_eyes(const std::vector<Ball>& balls, const PointsD& positions, PointsD& deltas) {
  for (const Ball& ball : balls)
    for (Eigen::Index v = 0; v < deltas.rows(); ++v) {
      if (!(deltas.row(v).squaredNorm() > 0)) continue;
      const double before = (positions.row(v).transpose() - ball.centre).norm();
      const Eigen::Vector3d moved = (positions.row(v) + deltas.row(v)).transpose() - ball.centre;
      const double now = moved.norm(), least = std::min(before, clearance * ball.radius);
      if (before < ball.radius || now >= least || !(now > 0)) continue;
      deltas.row(v) = (ball.centre + moved * (least / now)).transpose() - positions.row(v);
    }
}

}  // namespace mien::detail
