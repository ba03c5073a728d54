#pragma once
/// Rigid motions as dual quaternions: how they are split off a joint's matrix, blended and applied.
///
/// A joint's matrix M x = R (S x) + t is a stretch S, applied first, in the space of the bind pose, and a rigid motion
/// (R, t) after it. Stretches are blended as matrices, rigid motions as dual quaternions (Kavan et al. 2008, Geometric
/// Skinning with Approximate Dual Quaternion Blending, with the scale as its section 4.2 has it): a vertex of one joint
/// goes exactly where the joint's matrix takes it, whatever its scale.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mien/character/character.h"

namespace mien {

/// x -> rotation (stretch x) + translation. The stretch is symmetric up to rounding, and negative definite where the
/// matrix mirrors.
struct StretchedMotion {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
};

/// The polar decomposition of an affine matrix. A singular one has many: the one of its singular vectors is taken.
///   cost  about 50 ns for a rotation with a uniform scale, 1 us otherwise
StretchedMotion split_motion(const Eigen::Matrix4d& matrix);

/// A quaternion for the rotation and one for the translation; not normalised while it is a sum.
struct DualQuaternion {
  Eigen::Vector4d real = Eigen::Vector4d::Zero();  ///< x, y, z, w as Eigen's coeffs()
  Eigen::Vector4d dual = Eigen::Vector4d::Zero();
};
DualQuaternion dual_quaternion(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation);

/// The rigid motion of a sum of unit dual quaternions, as a matrix. Its real part is not zero.
Eigen::Matrix<double, 3, 4> rigid_matrix(const DualQuaternion& sum);

/// How a StretchedMotion and its dual quaternion change with its matrix.
struct MotionSlope {
  DualQuaternion rigid;
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Zero();
};
///   motion  as split_motion gave it
///   slope   the change of the matrix's upper three rows
MotionSlope motion_slope(const StretchedMotion& motion, const Eigen::Matrix<double, 3, 4>& slope);

/// How rigid_matrix(sum) x changes when sum and x do.
Eigen::Vector3d rigid_slope(const DualQuaternion& sum, const DualQuaternion& sum_slope,
                            const Eigen::Vector3d& x, const Eigen::Vector3d& x_slope);

/// q and -q are one rotation: the sign with which `real` joins a sum that started with `pivot`.
inline double antipodal_sign(const Eigen::Vector4d& pivot, const Eigen::Vector4d& real) {
  return pivot.dot(real) < 0 ? -1.0 : 1.0;
}

/// Each vertex moved by the blend of its joints' stretches and then by the blend of their rigid motions.
///   positions  #V x 3, model space, bind pose
///   joints     #J, as joint_matrices gives them
///   returns    #V x 3, model space. A vertex without influences stays
///   throws     invalid_input: as skin_linear
///   cost       about twice skin_linear, and a polar decomposition a joint
/// Every influence takes the sign nearest to the strongest influence's (the first of equals), so that no order of the
/// joints and no full turn of one flips a vertex.
PointsD skin_dual_quaternion(const PointsD& positions, const SkinWeights& weights,
                             const std::vector<Eigen::Matrix4d>& joints);

}  // namespace mien
