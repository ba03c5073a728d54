#include "mien/transfer/detail/relief.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "mien/geometry/laplacian.h"

namespace mien::detail {

Eigen::VectorXd relief(const Surface& surface, const PointsD& normals, double radius) {
  Eigen::VectorXd areas = vertex_areas(surface.positions, surface.triangles);
  areas = areas.cwiseMax(1e-6 * areas.mean());
  SparseMatrix system = radius * radius * cotangent_laplacian(surface.positions, surface.triangles);
  for (Eigen::Index v = 0; v < areas.size(); ++v) system.coeffRef(v, v) += areas[v];
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  if (solver.info() != Eigen::Success) return Eigen::VectorXd::Zero(areas.size());
  const Eigen::MatrixXd smooth = solver.solve(Eigen::MatrixXd(areas.asDiagonal() * surface.positions));
  return (surface.positions - PointsD(smooth)).cwiseProduct(normals).rowwise().sum() / radius;
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& weights) {
  const double total = weights.sum();
  if (!(total > 0)) return 0;
  const Eigen::ArrayXd x = a.array() - a.dot(weights) / total, y = b.array() - b.dot(weights) / total;
  const double size = std::sqrt((weights.array() * x * x).sum() * (weights.array() * y * y).sum());
  return size > 1e-9 * total ? std::clamp((weights.array() * x * y).sum() / size, -1.0, 1.0) : 0;
}

}  // namespace mien::detail
