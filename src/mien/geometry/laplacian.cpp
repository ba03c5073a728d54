#include "mien/geometry/laplacian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

namespace mien {
namespace {

Eigen::Vector3d at(const PointsD& positions, int vertex) {
  return positions.row(vertex).transpose();
}

/// Cotangent of the angle at `apex` of the triangle (apex, a, b).
double cotangent(const Eigen::Vector3d& apex, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d u = a - apex, v = b - apex;
  const double sine = u.cross(v).norm();
  return sine > 0 ? u.dot(v) / sine : 0;
}

}  // namespace

SparseMatrix cotangent_laplacian(const PointsD& positions, const Triangles& triangles, double least_weight) {
  const Eigen::Index n = positions.rows();
  std::vector<Eigen::Triplet<double>> half;
  half.reserve(static_cast<std::size_t>(triangles.rows()) * 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int apex = triangles(t, k), a = triangles(t, (k + 1) % 3), b = triangles(t, (k + 2) % 3);
      if (a == b || a == apex || b == apex) continue;
      half.emplace_back(std::max(a, b), std::min(a, b),
                        cotangent(at(positions, apex), at(positions, a), at(positions, b)) / 2);
    }
  SparseMatrix edges(n, n);
  edges.setFromTriplets(half.begin(), half.end());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(edges.nonZeros()) * 2 + static_cast<std::size_t>(n));
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n);
  for (Eigen::Index column = 0; column < n; ++column)
    for (SparseMatrix::InnerIterator edge(edges, column); edge; ++edge) {
      const double weight = std::max(edge.value(), least_weight);
      entries.emplace_back(edge.row(), edge.col(), -weight);
      entries.emplace_back(edge.col(), edge.row(), -weight);
      diagonal[edge.row()] += weight;
      diagonal[edge.col()] += weight;
    }
  for (Eigen::Index v = 0; v < n; ++v) entries.emplace_back(v, v, diagonal[v]);
  SparseMatrix laplacian(n, n);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

Eigen::VectorXd vertex_areas(const PointsD& positions, const Triangles& triangles) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(positions.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = at(positions, triangles(t, 0));
    const double area =
        (at(positions, triangles(t, 1)) - a).cross(at(positions, triangles(t, 2)) - a).norm() / 2;
    for (int k = 0; k < 3; ++k) areas[triangles(t, k)] += area / 3;
  }
  return areas;
}

std::vector<int> connected_components(std::size_t vertices, const Triangles& triangles) {
  std::vector<int> root(vertices);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 2; ++k) {
      const int a = find(triangles(t, k)), b = find(triangles(t, k + 1));
      root[std::max(a, b)] = std::min(a, b);
    }
  std::vector<int> label(vertices, -1);
  int count = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const int r = find(static_cast<int>(v));
    if (label[r] < 0) label[r] = count++;
    label[v] = label[r];
  }
  return label;
}

std::vector<char> boundary_vertices(std::size_t vertices, const Triangles& triangles) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(triangles.rows()) * 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(t, k), b = triangles(t, (k + 1) % 3);
      edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  std::vector<char> boundary(vertices, 0);
  for (std::size_t e = 0; e < edges.size();) {
    std::size_t next = e + 1;
    while (next < edges.size() && edges[next] == edges[e]) ++next;
    if (next == e + 1) boundary[edges[e].first] = boundary[edges[e].second] = 1;
    e = next;
  }
  return boundary;
}

PointsD vertex_normals(const PointsD& positions, const Triangles& triangles) {
  PointsD normals = PointsD::Zero(positions.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = at(positions, triangles(t, 0));
    const Eigen::Vector3d twice_area =
        (at(positions, triangles(t, 1)) - a).cross(at(positions, triangles(t, 2)) - a);
    for (int k = 0; k < 3; ++k) normals.row(triangles(t, k)) += twice_area.transpose();
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const double length = normals.row(v).norm();
    if (length > 0) normals.row(v) /= length;
  }
  return normals;
}

}  // namespace mien
