#pragma once
/// Discrete Laplacian and areas of a triangle mesh.

#include <Eigen/Core>
#include <Eigen/Sparse>

#include "mien/geometry/mesh.h"

namespace mien {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Cotangent Laplacian, #V x #V, symmetric, positive semi-definite, rows sum to zero: u' L u is the Dirichlet
/// energy. Edge weights (cot a + cot b) / 2 below `least_weight` are raised to it, so that obtuse triangles
/// cannot make the matrix indefinite.
SparseMatrix cotangent_laplacian(const PointsD& positions, const Triangles& triangles,
                                 double least_weight = 0.02);

/// #V: a third of the area of each vertex's triangles (barycentric areas).
Eigen::VectorXd vertex_areas(const PointsD& positions, const Triangles& triangles);

/// Connected components: #V labels 0..C-1 in order of each component's lowest vertex.
std::vector<int> connected_components(std::size_t vertices, const Triangles& triangles);

/// #V: true where the vertex lies on an edge with only one triangle.
std::vector<char> boundary_vertices(std::size_t vertices, const Triangles& triangles);

/// #V x 3 area-weighted unit normals in double; zero where no triangle of positive area meets.
PointsD vertex_normals(const PointsD& positions, const Triangles& triangles);

}  // namespace mien
