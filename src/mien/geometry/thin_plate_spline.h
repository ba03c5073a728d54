#pragma once
/// The smooth map of space that brings landmarks onto landmarks (Bookstein 1989; thesis section 4.7.1).

#include <Eigen/Core>

#include "mien/geometry/mesh.h"

namespace mien {

/// T(x) = A' (1, x) + sum_i w_i |x - l_i|: of all maps with T(l_i) = m_i the one of least bending energy; |r|
/// is the biharmonic kernel in three dimensions (eq. 4.1). Coefficients solve [K P; P' 0] [W; A] = [Q; 0]
/// (eq. 4.2) with K_ij = |l_i - l_j|, P_i = (1, l_i), Q_i = m_i. Affine maps are reproduced exactly.
class ThinPlateSpline {
 public:
  struct Options {
    /// 0: exact at the landmarks. Above: K - smoothing I (|r| is conditionally negative), so that landmarks
    /// are approached, not met. In units of the landmark box's diagonal.
    double smoothing = 0;
    /// The number of principal warps kept, from the largest scale down (eigenvectors of the bending energy
    /// matrix L_n^-1 K L_n^-1 = L_n^-1, smallest eigenvalues first); -1: all. 0 leaves the affine part of the
    /// whole map.
    int principal_warps = -1;
    /// #L factors of the smoothing, 0 or more: a landmark with a larger one may be missed by more. Empty: 1.
    Eigen::VectorXd spread = {};
  };

  ///   from, to  #L x 3 landmarks before and after
  ///   throws    invalid_input: fewer than 4 landmarks, sizes that differ, numbers that are not finite, two
  ///             coincident landmarks, or all landmarks in one plane (the affine part is then not determined);
  ///             names the rows; a spread of another length or below 0
  ///   cost      O(#L^3) once, O(#L) a point
  ThinPlateSpline(const PointsD& from, const PointsD& to, const Options& options);
  ThinPlateSpline(const PointsD& from, const PointsD& to) : ThinPlateSpline(from, to, Options{}) {}

  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const;
  /// All rows at once, on all cores.
  PointsD operator()(const PointsD& points) const;
  /// dT/dx, 3 x 3. At a landmark the kernel has a cone's tip: its own term is left out there.
  Eigen::Matrix3d jacobian(const Eigen::Vector3d& x) const;
  /// The affine part alone: its 3 x 3 matrix.
  Eigen::Matrix3d affine() const { return affine_.bottomRows<3>().transpose(); }
  /// Bending energy -trace(W' K W), 0 for an affine map, in the landmarks' units (|r| is conditionally
  /// negative).
  double bending_energy() const;

  /// The bending energies (#L - 4, ascending) of the principal warps and the warps themselves as columns (#L
  /// rows): orthonormal coefficients w of sum_i w_i |x - l_i|.
  struct PrincipalWarps {
    Eigen::VectorXd energies;
    Eigen::MatrixXd warps;
  };
  static PrincipalWarps principal_warps(const PointsD& landmarks);

 private:
  PointsD centres_;                     // #L, normalised
  PointsD weights_;                     // #L x 3
  Eigen::Matrix<double, 4, 3> affine_;  // rows: constant, x, y, z, of normalised coordinates
  Eigen::RowVector3d shift_ = Eigen::RowVector3d::Zero();
  double scale_ = 1;  // normalised = (x - shift) * scale
};

}  // namespace mien
