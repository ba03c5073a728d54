#include "mien/transfer/detail/landmark_influence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/core/parallel.h"

namespace mien::detail {
namespace {

/// In face sizes; a share of an edge.
constexpr double clicking_error = .005, share_of_edge = .15;

/// #V: the mean length of each vertex's edges.
Eigen::VectorXd edge_lengths(const Surface& surface) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(surface.positions.rows()), count = sum;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = surface.triangles(t, k), b = surface.triangles(t, (k + 1) % 3);
      const double length = (surface.positions.row(a) - surface.positions.row(b)).norm();
      for (const int v : {a, b}) {
        sum[v] += length;
        count[v] += 1;
      }
    }
  return sum.cwiseQuotient(count.cwiseMax(1));
}

}  // namespace

std::vector<SurfaceQuery::Hit> closest_points(const SurfaceQuery& surface, const PointsD& points) {
  std::vector<SurfaceQuery::Hit> hits;
  for (Eigen::Index i = 0; i < points.rows(); ++i) hits.push_back(surface.closest(points.row(i).transpose()));
  return hits;
}

Eigen::MatrixXd facing(const PointsD& positions, const PointsD& normals, double turn) {
  Eigen::MatrixXd places(positions.rows(), 6);
  places << positions, turn * normals;
  return places;
}

Eigen::VectorXd far_from(const Eigen::MatrixXd& landmarks, const Eigen::MatrixXd& places, double near,
                         double far) {
  const Eigen::Index count = places.rows();
  if (landmarks.rows() == 0) return Eigen::VectorXd::Ones(count);
  Eigen::VectorXd result(count);
  parallel_for(static_cast<std::size_t>(count), 256, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin), rows = static_cast<Eigen::Index>(end - begin);
    Eigen::ArrayXd least = Eigen::ArrayXd::Constant(rows, std::numeric_limits<double>::infinity());
    Eigen::ArrayXd square(rows);
    for (Eigen::Index l = 0; l < landmarks.rows(); ++l) {
      square.setZero();
      for (Eigen::Index k = 0; k < places.cols(); ++k)
        square += (places.col(k).segment(first, rows).array() - landmarks(l, k)).square();
      least = least.min(square);
    }
    const Eigen::ArrayXd t = ((least.sqrt() - near) / (far - near)).max(0).min(1);
    result.segment(first, rows) = (t * t * (3 - 2 * t)).matrix();
  });
  return result;
}

Eigen::VectorXd landmark_spread(const std::vector<SurfaceQuery::Hit>& at, const Surface& surface,
                                double unit) {
  constexpr double on_vertex = .999;
  const Eigen::VectorXd edges = edge_lengths(surface);
  Eigen::VectorXd spread = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    int corner = 0;
    if (at[i].barycentric.maxCoeff(&corner) < on_vertex) continue;
    const double error = share_of_edge * edges[surface.triangles(at[i].triangle, corner)] / unit;
    spread[static_cast<Eigen::Index>(i)] += error * error / (clicking_error * clicking_error);
  }
  return spread;
}

}  // namespace mien::detail
