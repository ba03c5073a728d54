#pragma once
/// The linear core of registration: displacements of a surface that follow data and bend little.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "mien/geometry/laplacian.h"
#include "mien/geometry/mesh.h"

namespace mien::detail {

/// One wish: the surface point sum_k weights[k] (x + u)[vertices[k]] should be at `goal`. Its cost is
///   along (a . r)^2 + across |r - a (a . r)|^2,   r = point - goal, a = axis (unit).
/// A plane pulls along its normal; a curve pulls across its tangent; a point pulls the same both ways.
struct Wish {
  std::array<int, 3> vertices{0, 0, 0};
  std::array<double, 3> weights{1, 0, 0};
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double along = 0, across = 0;
};

/// Minimises  stiffness 1e-6 |M^-1/2 L u|^2 + sum of wishes  over u (#V x 3): a bi-Laplacian prior on the displacement
/// from `rest`, with cotangent Laplacian L and masses M normalised to sum one.
///
/// The wishes couple x, y and z. The system is solved by conjugate gradients with the uncoupled #V x #V matrix (each
/// wish by its mean weight) as preconditioner, factored once a call by supernodal Cholesky: 2-7 steps.
class DisplacementSolver {
 public:
  /// The pattern is analysed once. Lengths should be in face sizes.
  DisplacementSolver(const PointsD& rest, const Triangles& triangles);
  ~DisplacementSolver();

  /// `start` (#V x 3): where the iteration begins. Cost: one factorisation, about 0.1 s at 14,000 vertices.
  PointsD solve(double stiffness, const std::vector<Wish>& wishes, const PointsD& start) const;

 private:
  struct Factor;
  PointsD rest_;
  Eigen::VectorXd masses_;
  SparseMatrix bending_;  // lower and upper, L M^-1 L
  std::unique_ptr<Factor> factor_;
};

}  // namespace mien::detail
