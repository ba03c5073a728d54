#include "mien/transfer/detail/correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace mien::detail {
namespace {

/// How far a residual speaks for its surroundings, face sizes.
constexpr double reach = 0.25;
/// Variance of a clicked point's error over that of a found point's.
constexpr double noise = 0.05;

double kernel(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
  return std::exp(-(a - b).norm() / reach);
}

}  // namespace

std::vector<Residual> with_mirror_images(const std::vector<Residual>& given, const PointsD& points,
                                         const std::vector<int>& mirror) {
  std::vector<Residual> all = given;
  for (const Residual& residual : given) {
    const int other = mirror[static_cast<std::size_t>(residual.row)];
    if (other < 0 ||
        std::any_of(given.begin(), given.end(), [&](const Residual& r) { return r.row == other; }))
      continue;
    Residual image{other, points.row(other), residual.value};
    image.value.x() *= -1;
    all.push_back(image);
  }
  return all;
}

PointsD correction(const std::vector<Residual>& residuals, const PointsD& points) {
  PointsD field = PointsD::Zero(points.rows(), 3);
  if (residuals.empty()) return field;
  const Eigen::Index count = static_cast<Eigen::Index>(residuals.size());
  Eigen::MatrixXd covariance(count, count), across(points.rows(), count), values(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Residual& residual = residuals[static_cast<std::size_t>(i)];
    values.row(i) = residual.value;
    for (Eigen::Index j = 0; j < count; ++j)
      covariance(i, j) =
          kernel(residual.at, residuals[static_cast<std::size_t>(j)].at) + (i == j ? noise : 0);
    for (Eigen::Index p = 0; p < points.rows(); ++p) across(p, i) = kernel(points.row(p), residual.at);
  }
  field = across * covariance.ldlt().solve(values);
  return field;
}

PointsD surprises(const std::vector<Residual>& given, const PointsD& points, const std::vector<int>& mirror) {
  PointsD result(static_cast<Eigen::Index>(given.size()), 3);
  for (std::size_t i = 0; i < given.size(); ++i) {
    std::vector<Residual> others = given;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const PointsD expected = correction(with_mirror_images(others, points, mirror), given[i].at);
    result.row(static_cast<Eigen::Index>(i)) = given[i].value - expected.row(0);
  }
  return result;
}

}  // namespace mien::detail
