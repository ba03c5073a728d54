#include "mien/transfer/detail/evening.h"

#include <algorithm>

#include "mien/transfer/detail/at.h"

namespace mien::detail {
namespace {

constexpr double per_roughness = 1.4, most = 0.7;

std::vector<std::vector<int>> neighbours_of(const Surface& surface) {
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(surface.positions.rows()));
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const int step : {1, 2})
        neighbours[at(surface.triangles(t, k))].push_back(surface.triangles(t, (k + step) % 3));
  for (std::vector<int>& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

}  // namespace

SparseMatrix evening(const std::vector<SourcePoint>& points, const PointsD& aligned,
                     const Triangles& triangles, const Surface& target) {
  PointsD shift = target.positions;
  for (std::size_t v = 0; v < points.size(); ++v)
    for (int k = 0; k < 3; ++k)
      shift.row(static_cast<Eigen::Index>(v)) -=
          points[v].barycentric[k] * aligned.row(triangles(points[v].triangle, k));
  const auto neighbours = neighbours_of(target);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const int row = static_cast<int>(v);
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    double edges = 0;
    for (const int n : neighbours[v]) {
      mean += shift.row(n);
      edges += (target.positions.row(n) - target.positions.row(row)).norm();
    }
    const double count = static_cast<double>(neighbours[v].size());
    const bool even = !points[v].accepted || !(edges > 0);
    const double share =
        even ? 0 : std::min(most, per_roughness * (mean / count - shift.row(row)).norm() / (edges / count));
    entries.emplace_back(row, row, 1 - share);
    for (const int n : neighbours[v])
      if (share > 0) entries.emplace_back(row, n, share / count);
  }
  SparseMatrix matrix(target.positions.rows(), target.positions.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace mien::detail
