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

/// Per vertex a neighbour, the same however the mesh is turned.
std::vector<int> some_neighbours(Eigen::Index vertices, const Triangles& triangles) {
  std::vector<int> neighbour(static_cast<std::size_t>(vertices), -1);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      int& of = neighbour[static_cast<std::size_t>(triangles(t, k))];
      if (of < 0) of = triangles(t, (k + 1) % 3);
    }
  return neighbour;
}

/// A frame with z along `normal` and x towards `edge`.
Eigen::Matrix3d frame_along(const Eigen::Vector3d& normal, const Eigen::Vector3d& edge) {
  if (!(normal.norm() > 0)) return Eigen::Matrix3d::Identity();  // a vertex without triangles
  Eigen::Vector3d x = edge - edge.dot(normal) * normal;
  if (!(x.norm() > 1e-6 * edge.norm())) x = normal.unitOrthogonal();
  Eigen::Matrix3d frame;
  frame << x.normalized(), normal.cross(x.normalized()), normal;
  return frame;
}

}  // namespace

Eigen::VectorXd openness(const PointsD& positions, const Triangles& triangles, int rays) {
  const SurfaceQuery surface(positions, triangles);
  const PointsD normals = vertex_normals(positions, triangles);
  const PointsD directions = hemisphere(rays);
  const double diagonal = bounding_box(positions).diagonal();
  const std::vector<int> neighbours = some_neighbours(positions.rows(), triangles);
  Eigen::VectorXd open(positions.rows());
  parallel_for(static_cast<std::size_t>(positions.rows()), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Index row = static_cast<Eigen::Index>(v);
      const Eigen::Vector3d normal = normals.row(row).transpose();
      const int next = neighbours[v];
      const Eigen::Vector3d edge = next < 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                            : Eigen::Vector3d(positions.row(next) - positions.row(row));
      const Eigen::Matrix3d turn = frame_along(normal, edge);
      const Eigen::Vector3d origin = positions.row(row).transpose() + 1e-4 * diagonal * normal;
      const int free = surface.count_free(origin, directions * turn.transpose(), 10 * diagonal);
      open[row] = static_cast<double>(free) / rays;
    }
  });
  return open;
}

}  // namespace mien
