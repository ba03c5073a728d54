#pragma once
/// Non-uniform rational B-spline surfaces over a grid of control vertices (Piegl and Tiller 1997, chapters 3 and 4).

#include <string>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// All of a surface but its control vertices, which move: grid vertex (i, j) is vertex i + count_u j.
struct NurbsSurface {
  int degree_u = 3, degree_v = 3;
  int count_u = 0, count_v = 0;  ///< control vertices along u and v, each above its degree
  std::vector<double> knots_u,
      knots_v;  ///< count + degree + 1, not descending; the domain is [knots[degree], knots[count]]
  std::vector<double> weights;  ///< count_u count_v, > 0; none: all 1 (not rational)
  bool operator==(const NurbsSurface&) const = default;
};

/// What is wrong with a descriptor for this many control vertices, in words; empty: nothing.
std::string fault_of(const NurbsSurface& surface, std::size_t vertex_count);

/// The share of each control vertex in the point at (u, v): the rational basis functions, which sum to one. (u, v) outside the
/// domain is taken at its border.
///   returns  count_u count_v
///   cost     (degree_u + 1)(degree_v + 1) that are not zero
Eigen::VectorXd nurbs_basis(const NurbsSurface& surface, double u, double v);

/// The surface's points at `samples_u` x `samples_v` even parameters, corner to corner, and the quads between them.
///   controls  count_u count_v x 3
///   throws    invalid_input: what fault_of finds, fewer than 2 samples
Mesh tessellate(const NurbsSurface& surface, const PointsD& controls, int samples_u, int samples_v);

}  // namespace mien
