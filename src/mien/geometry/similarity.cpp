#include "mien/geometry/similarity.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "mien/core/error.h"

namespace mien {

PointsD Similarity::operator()(const PointsD& points) const {
  return (scale * points * rotation.transpose()).rowwise() + translation.transpose();
}

Similarity Similarity::inverse() const {
  Similarity back;
  back.scale = 1 / scale;
  back.rotation = rotation.transpose();
  back.translation = -(back.scale * (back.rotation * translation));
  return back;
}

Similarity fit_similarity(const PointsD& from, const PointsD& to) {
  return fit_similarity(from, to, Eigen::VectorXd::Ones(from.rows()));
}

Similarity fit_similarity(const PointsD& from, const PointsD& to, const Eigen::VectorXd& weights) {
  if (from.rows() != to.rows())
    throw invalid_input("similarity", "point sets of different sizes", "as many points on both sides");
  if (from.rows() < 3) throw invalid_input("similarity", "fewer than 3 point pairs", "3 or more");
  const Eigen::VectorXd share = weights / weights.sum();
  const Eigen::RowVector3d from_mean = share.transpose() * from, to_mean = share.transpose() * to;
  const PointsD a = from.rowwise() - from_mean, b = to.rowwise() - to_mean;
  const Eigen::Matrix3d covariance = b.transpose() * share.asDiagonal() * a;
  Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d s = svd.singularValues();
  if (!(s[1] > 1e-12 * s[0]))
    throw invalid_input("similarity", "all points on one line", "points that span a plane");
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign[2] = -1;
  Similarity result;
  result.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  result.scale = s.dot(sign) / share.dot(a.rowwise().squaredNorm());
  result.translation = to_mean.transpose() - result.scale * (result.rotation * from_mean.transpose());
  return result;
}

Eigen::Matrix3d closest_rotation(const Eigen::Matrix3d& m) {
  Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign[2] = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace mien
