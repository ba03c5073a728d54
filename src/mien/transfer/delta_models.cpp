#include "mien/transfer/delta_models.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/core/error.h"
#include "mien/geometry/laplacian.h"

namespace mien {

std::string_view name_of(DeltaModel model) {
  switch (model) {
    case DeltaModel::automatic:
      return "auto";
    case DeltaModel::local:
      return "local";
    case DeltaModel::raw:
      return "raw";
    case DeltaModel::copy:
      return "copy";
    case DeltaModel::warp:
      return "warp";
    case DeltaModel::thesis:
      return "thesis";
  }
  return "auto";
}

Eigen::VectorXd local_scale(const PointsD& aligned, const PointsD& guide, const Triangles& triangles,
                            double radius) {
  const Eigen::VectorXd before = vertex_areas(aligned, triangles), after = vertex_areas(guide, triangles);
  // A vertex without area (a stray one) gets a little, or its row would be empty.
  const double least = 1e-6 * before.mean();
  const Eigen::VectorXd mass = before.cwiseMax(least);
  SparseMatrix system = radius * radius * cotangent_laplacian(aligned, triangles);
  for (Eigen::Index v = 0; v < mass.size(); ++v) system.coeffRef(v, v) += mass[v];
  Eigen::SimplicialLDLT<SparseMatrix> factor(system);
  Eigen::MatrixXd right(mass.size(), 2);
  right << mass, after.cwiseMax(0.01 * least);
  const Eigen::MatrixXd smooth = factor.solve(right);
  Eigen::VectorXd scale(mass.size());
  for (Eigen::Index v = 0; v < mass.size(); ++v) {
    const double ratio = smooth(v, 1) / smooth(v, 0);
    scale[v] = ratio > 0 && std::isfinite(ratio) ? std::sqrt(ratio) : 1.0;
  }
  return scale;
}

namespace {

/// T(x + d) - T(x) where d is not zero; `image` is T(x) of all rows, or empty.
PointsD through_spline(const ThinPlateSpline& spline, const PointsD& positions, const PointsD& image,
                       const PointsD& deltas) {
  std::vector<int> moving;
  for (Eigen::Index v = 0; v < deltas.rows(); ++v)
    if (deltas.row(v).squaredNorm() > 0) moving.push_back(static_cast<int>(v));
  const PointsD from = positions(moving, Eigen::all), to = from + deltas(moving, Eigen::all);
  const PointsD change = spline(to) - (image.rows() > 0 ? PointsD(image(moving, Eigen::all)) : spline(from));
  PointsD result = PointsD::Zero(deltas.rows(), 3);
  result(moving, Eigen::all) = change;
  return result;
}

}  // namespace

PointsD carry_deltas(const DeltaMaps& maps, DeltaModel model, double warp_share, const PointsD& deltas) {
  const PointsD turned = maps.similarity.of_vectors(deltas);
  const auto local = [&] { return PointsD(maps.scale.asDiagonal() * turned); };
  const auto warp = [&] { return through_spline(*maps.dense, maps.aligned, maps.dense_image, turned); };
  switch (model) {
    case DeltaModel::raw:
      return turned;
    case DeltaModel::copy:
      return turned / maps.similarity.scale;
    case DeltaModel::local:
      return local();
    case DeltaModel::warp:
      return warp();
    case DeltaModel::thesis:
      return through_spline(*maps.landmarks, maps.positions, maps.landmark_image, deltas);
    case DeltaModel::automatic:
      break;
  }
  if (warp_share <= 0) return local();
  if (warp_share >= 1) return warp();
  return (1 - warp_share) * local() + warp_share * warp();
}

std::vector<int> farthest_points(const PointsD& points, int count) {
  std::vector<int> chosen;
  if (points.rows() == 0) return chosen;
  Eigen::Index next = 0;
  const Eigen::RowVector3d middle =
      points.colwise().mean();  // as an expression it would be summed anew for each row
  (points.rowwise() - middle).rowwise().squaredNorm().maxCoeff(&next);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> columns = points;
  Eigen::ArrayXd distance = Eigen::ArrayXd::Constant(points.rows(), std::numeric_limits<double>::infinity());
  while (static_cast<int>(chosen.size()) < std::min<Eigen::Index>(count, points.rows())) {
    chosen.push_back(static_cast<int>(next));
    distance = distance.min((columns.col(0).array() - points(next, 0)).square() +
                            (columns.col(1).array() - points(next, 1)).square() +
                            (columns.col(2).array() - points(next, 2)).square());
    if (distance.maxCoeff(&next) <= 0) break;
  }
  return chosen;
}

ThinPlateSpline dense_spline(const PointsD& aligned, const PointsD& guide, const PointsD& landmarks_from,
                             const PointsD& landmarks_to, std::span<const int> samples) {
  const double diagonal = bounding_box(aligned).diagonal();
  std::vector<Eigen::RowVector3d> from, to;
  const auto add = [&](const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
    const bool near = std::any_of(from.begin(), from.end(), [&](const Eigen::RowVector3d& other) {
      return (other - a).norm() < 1e-3 * diagonal;
    });
    if (near) return;
    from.push_back(a);
    to.push_back(b);
  };
  for (Eigen::Index i = 0; i < landmarks_from.rows(); ++i) add(landmarks_from.row(i), landmarks_to.row(i));
  for (const int v : samples) add(aligned.row(v), guide.row(v));
  PointsD a(static_cast<Eigen::Index>(from.size()), 3), b(a.rows(), 3);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    a.row(i) = from[static_cast<std::size_t>(i)];
    b.row(i) = to[static_cast<std::size_t>(i)];
  }
  return ThinPlateSpline(a, b, {1e-3, -1});
}

}  // namespace mien
