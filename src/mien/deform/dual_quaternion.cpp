#include "mien/deform/dual_quaternion.h"

#include <Eigen/SVD>
#include <vector>

#include "mien/core/parallel.h"
#include "mien/deform/skin.h"

namespace mien {
namespace {

/// Largest departure of A'A from a multiple of the identity, of that multiple, at which A is taken for a rotation with a
/// uniform scale: float noise of a file's matrices stays below it, and what remains goes into the stretch.
constexpr double similarity_tolerance = 1e-4;

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& a) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  return rotation.determinant() < 0 ? Eigen::Matrix3d(-rotation) : rotation;
}

struct JointMotion {
  DualQuaternion rigid;
  Eigen::Matrix3d stretch;
};

struct Blend {
  DualQuaternion rigid;
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Zero();
  double total = 0;
};

Blend blend(const SkinWeights& weights, int begin, int end, const std::vector<JointMotion>& motions) {
  if (begin == end) return {};
  int strongest = begin;
  for (int i = begin; i < end; ++i)
    if (weights.weights[i] > weights.weights[strongest]) strongest = i;
  const Eigen::Vector4d pivot = motions[weights.joints[strongest]].rigid.real;
  Blend sum;
  for (int i = begin; i < end; ++i) {
    const JointMotion& motion = motions[weights.joints[i]];
    const double weight = weights.weights[i], turned = weight * antipodal_sign(pivot, motion.rigid.real);
    sum.rigid.real += turned * motion.rigid.real;
    sum.rigid.dual += turned * motion.rigid.dual;
    sum.stretch += weight * motion.stretch;
    sum.total += weight;
  }
  return sum;
}

}  // namespace

StretchedMotion split_motion(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d a = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d gram = a.transpose() * a;
  const double square = gram.trace() / 3;
  const bool is_similarity =
      (gram - square * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= similarity_tolerance * square;
  const double scale = a.determinant() < 0 ? -std::sqrt(square) : std::sqrt(square);
  const Eigen::Matrix3d rotation =
      is_similarity && square > 0 ? Eigen::Matrix3d(a / scale) : nearest_rotation(a);
  StretchedMotion motion;
  motion.rotation = Eigen::Quaterniond(rotation).normalized();
  motion.translation = matrix.topRightCorner<3, 1>();
  motion.stretch = motion.rotation.toRotationMatrix().transpose() * a;
  return motion;
}

DualQuaternion dual_quaternion(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
  const Eigen::Quaterniond shift(0, translation.x(), translation.y(), translation.z());
  return {rotation.coeffs(), 0.5 * (shift * rotation).coeffs()};
}

Eigen::Matrix<double, 3, 4> rigid_matrix(const DualQuaternion& sum) {
  const double square = sum.real.squaredNorm();
  const Eigen::Quaterniond real(sum.real), dual(sum.dual);
  Eigen::Matrix<double, 3, 4> matrix;
  matrix.leftCols<3>() = real.normalized().toRotationMatrix();
  matrix.col(3) = 2 / square * (dual * real.conjugate()).vec();
  return matrix;
}

// R'dA = [w]x P + dP with dP symmetric: its skew part gives (tr(P) 1 - P) w = axial(R'dA).
MotionSlope motion_slope(const StretchedMotion& motion, const Eigen::Matrix<double, 3, 4>& slope) {
  const Eigen::Matrix3d turned = motion.rotation.toRotationMatrix().transpose() * slope.leftCols<3>();
  const Eigen::Matrix3d skew = turned - turned.transpose();
  const Eigen::Matrix3d inertia = motion.stretch.trace() * Eigen::Matrix3d::Identity() - motion.stretch;
  const Eigen::Vector3d spin = inertia.fullPivLu().solve(Eigen::Vector3d(skew(2, 1), skew(0, 2), skew(1, 0)));
  const Eigen::Quaterniond half(0, spin.x() / 2, spin.y() / 2, spin.z() / 2);
  const Eigen::Quaterniond rotation(motion.rotation * half);
  const Eigen::Vector3d &t = motion.translation, dt = slope.col(3);
  const Eigen::Quaterniond shift(0, t.x(), t.y(), t.z()), shift_slope(0, dt.x(), dt.y(), dt.z());
  Eigen::Matrix3d cross;
  cross << 0, -spin.z(), spin.y(), spin.z(), 0, -spin.x(), -spin.y(), spin.x(), 0;
  MotionSlope result;
  result.rigid.real = rotation.coeffs();
  result.rigid.dual = 0.5 * ((shift_slope * motion.rotation).coeffs() + (shift * rotation).coeffs());
  result.stretch = turned - cross * motion.stretch;
  return result;
}

// With r and d the real and the dual part: y = (r x r* + 2 d r*) / |r|^2.
Eigen::Vector3d rigid_slope(const DualQuaternion& sum, const DualQuaternion& sum_slope,
                            const Eigen::Vector3d& x, const Eigen::Vector3d& x_slope) {
  const Eigen::Matrix<double, 3, 4> matrix = rigid_matrix(sum);
  const Eigen::Quaterniond r(sum.real), d(sum.dual), dr(sum_slope.real), dd(sum_slope.dual);
  const Eigen::Quaterniond point(0, x.x(), x.y(), x.z());
  const Eigen::Vector3d numerator = (dr * point * r.conjugate()).vec() + (r * point * dr.conjugate()).vec() +
                                    2 * ((dd * r.conjugate()).vec() + (d * dr.conjugate()).vec());
  const double square = sum.real.squaredNorm();
  const Eigen::Vector3d y = matrix * x.homogeneous();
  return numerator / square - 2 * sum.real.dot(sum_slope.real) / square * y + matrix.leftCols<3>() * x_slope;
}

PointsD skin_dual_quaternion(const PointsD& positions, const SkinWeights& weights,
                             const std::vector<Eigen::Matrix4d>& joints) {
  check_skin_weights(positions.rows(), weights, joints.size());
  std::vector<JointMotion> motions;
  motions.reserve(joints.size());
  for (const Eigen::Matrix4d& joint : joints) {
    const StretchedMotion split = split_motion(joint);
    motions.push_back({dual_quaternion(split.rotation, split.translation), split.stretch});
  }
  PointsD moved = positions;
  parallel_for(static_cast<std::size_t>(positions.rows()), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Blend sum = blend(weights, weights.offsets[v], weights.offsets[v + 1], motions);
      if (sum.total <= 0) continue;
      const auto row = static_cast<Eigen::Index>(v);
      const Eigen::Vector3d stretched = sum.stretch * positions.row(row).transpose() / sum.total;
      moved.row(row) = (rigid_matrix(sum.rigid) * stretched.homogeneous()).transpose();
    }
  });
  return moved;
}

}  // namespace mien
