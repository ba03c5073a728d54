#include "mien/geometry/openness.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"

namespace mien {
namespace {

/// Cosine-distributed directions around +z by a golden-angle spiral: even coverage with few rays.
PointsD hemisphere(int rays) {
  PointsD directions(rays, 3);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < rays; ++i) {
    const double radius = std::sqrt((i + 0.5) / rays), angle = golden * i;
    directions.row(i) << radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - radius * radius);
  }
  return directions;
}

}  // namespace

Eigen::VectorXd openness(const PointsD& positions, const Triangles& triangles, int rays) {
  const SurfaceQuery surface(positions, triangles);
  const PointsD normals = vertex_normals(positions, triangles);
  const PointsD directions = hemisphere(rays);
  const double diagonal = (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
  Eigen::VectorXd open(positions.rows());
  parallel_for(static_cast<std::size_t>(positions.rows()), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Index row = static_cast<Eigen::Index>(v);
      const Eigen::Vector3d normal = normals.row(row).transpose();
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
      const Eigen::Vector3d origin = positions.row(row).transpose() + 1e-4 * diagonal * normal;
      int free = 0;
      for (int r = 0; r < rays; ++r)
        free += !surface.occluded(origin, turn * Eigen::Vector3d(directions.row(r)), 0, 10 * diagonal);
      open[row] = static_cast<double>(free) / rays;
    }
  });
  return open;
}

}  // namespace mien
