// Registration brings two surfaces together to a few thousandths of the face, which is poor where they are equal: a rig that was
// worked on by hand would lose that work's fine points with each new mesh. So agreement is looked for first, by plain closest
// points, and what agrees needs no registration.
#include "mien/transfer/twin.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"

namespace mien {
namespace {

constexpr double least_cosine = 0.3;
constexpr std::size_t glances = 400, first_samples = 400, samples = 1500;
constexpr int most_rounds = 60, first_rounds = 8;
/// Of the box: a median distance above it after the first rounds is another face.
constexpr double hopeless = 3e-3;

PointsD triangle_normals(const PointsD& positions, const Triangles& triangles) {
  PointsD normals(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0)).transpose(),
                          b = positions.row(triangles(t, 1)).transpose(),
                          c = positions.row(triangles(t, 2)).transpose();
    normals.row(t) = (b - a).cross(c - a).normalized().transpose();
  }
  return normals;
}

/// Evenly chosen rows.
std::vector<Eigen::Index> choose(Eigen::Index rows, std::size_t count) {
  std::vector<Eigen::Index> chosen;
  const std::size_t all = static_cast<std::size_t>(rows), wanted = std::min(all, count);
  for (std::size_t i = 0; i < wanted; ++i) chosen.push_back(static_cast<Eigen::Index>(i * all / wanted));
  return chosen;
}

/// Share of a few target vertices that lie on the source.
double glance(const SurfaceQuery& source, const Similarity& to_source, const Surface& target,
              double tolerance) {
  const auto rows = choose(target.positions.rows(), glances);
  std::size_t close = 0;
  for (const Eigen::Index row : rows) {
    const Eigen::Vector3d position = to_source(Eigen::Vector3d(target.positions.row(row).transpose()));
    close += source.closest(position, tolerance * to_source.scale).triangle >= 0;
  }
  return rows.empty() ? 0 : static_cast<double>(close) / static_cast<double>(rows.size());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// One step of point-to-plane closest points over turn, move and scale, far pairs counting little. Returns the median distance
/// before it, in source units.
double improve(const SurfaceQuery& source, const PointsD& normals, const Surface& target,
               const std::vector<Eigen::Index>& rows, double least, Similarity& to_source) {
  std::vector<SurfaceQuery::Hit> hits(rows.size());
  std::vector<Eigen::Vector3d> places(rows.size());
  std::vector<double> distances(rows.size());
  parallel_for(rows.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      places[i] = to_source(Eigen::Vector3d(target.positions.row(rows[i]).transpose()));
      hits[i] = source.closest(places[i]);
      distances[i] = hits[i].distance;
    }
  });
  const double middle = median(distances), scale = std::max(least, 2 * middle);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : places) centre += place / static_cast<double>(places.size());
  Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d n = normals.row(hits[i].triangle).transpose(), y = places[i] - centre;
    const double ratio = distances[i] / scale, weight = 1 / std::pow(1 + ratio * ratio, 2);
    Eigen::Matrix<double, 7, 1> row;
    row << y.cross(n), n, n.dot(y);
    normal += weight * row * row.transpose();
    right -= weight * n.dot(places[i] - hits[i].position) * row;
  }
  normal.diagonal() *= 1 + 1e-12;
  const Eigen::Matrix<double, 7, 1> change = normal.ldlt().solve(right);
  if (!change.allFinite()) return middle;
  const double angle = change.head<3>().norm();
  const Eigen::Matrix3d turn = angle > 0
                                   ? Eigen::AngleAxisd(angle, change.head<3>() / angle).toRotationMatrix()
                                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const double growth = std::exp(change[6]);
  to_source.translation = growth * (turn * (to_source.translation - centre)) + centre + change.segment<3>(3);
  to_source.rotation = turn * to_source.rotation;
  to_source.scale *= growth;
  return middle;
}

/// Improves a placement until it stands; false when it comes to nothing.
bool refine(const SurfaceQuery& source, const PointsD& normals, const Surface& target, double tolerance,
            Similarity& to_source) {
  const auto few = choose(target.positions.rows(), first_samples),
             many = choose(target.positions.rows(), samples);
  if (few.size() < 7) return false;
  const double size = bounding_box(target.positions).diagonal();
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const double middle = improve(source, normals, target, round < first_rounds ? few : many,
                                  0.1 * tolerance * to_source.scale, to_source);
    if (round + 1 >= first_rounds && middle > hopeless * size * to_source.scale) return false;
    // What is one surface comes together fast; what is alike stays apart.
    if (round >= first_rounds && middle > 0.9 * last && middle >= tolerance * to_source.scale) return false;
    if (round >= first_rounds && middle < 1e-3 * tolerance * to_source.scale) return true;
    if (round > first_rounds && middle > 0.999 * last && middle < tolerance * to_source.scale) return true;
    last = middle;
  }
  return last < tolerance * to_source.scale;
}

/// A vertex alone among others that do not lie on the source is where two surfaces cross.
void drop_lone(const Triangles& triangles, std::vector<SourcePoint>& points) {
  std::vector<int> edges(points.size(), 0), close(points.size(), 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const int step : {1, 2}) {
        const auto v = static_cast<std::size_t>(triangles(t, k));
        ++edges[v];
        close[v] += points[static_cast<std::size_t>(triangles(t, (k + step) % 3))].accepted;
      }
  for (std::size_t v = 0; v < points.size(); ++v)
    if (2 * close[v] < edges[v]) points[v].accepted = false;
}

Twin look(const SurfaceQuery& source, const PointsD& source_normals, const Surface& target,
          const Similarity& to_source, double tolerance) {
  Twin twin;
  twin.placement = to_source.inverse();
  twin.points.resize(static_cast<std::size_t>(target.positions.rows()));
  const PointsD normals = vertex_normals(target.positions, target.triangles) * to_source.rotation.transpose();
  const double reach = tolerance * to_source.scale;
  parallel_for(twin.points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto row = static_cast<Eigen::Index>(v);
      const Eigen::Vector3d place = to_source(Eigen::Vector3d(target.positions.row(row).transpose()));
      auto hit = source.closest(place, reach, [&](int t, const Eigen::Vector3d&) {
        return source_normals.row(t).dot(normals.row(row)) > least_cosine;
      });
      if (hit.triangle < 0) hit = source.closest(place, reach);
      if (hit.triangle < 0) continue;
      twin.points[v] = {hit.triangle, hit.barycentric, hit.distance / to_source.scale, true};
    }
  });
  drop_lone(target.triangles, twin.points);
  const auto close = std::count_if(twin.points.begin(), twin.points.end(),
                                   [](const SourcePoint& point) { return point.accepted; });
  twin.share = static_cast<double>(close) / static_cast<double>(std::max<std::size_t>(1, twin.points.size()));
  return twin;
}

}  // namespace

std::optional<Twin> find_twin(const Surface& source, const Surface& target,
                              const std::vector<Similarity>& starts, const TwinOptions& options) {
  if (source.triangles.rows() == 0 || target.positions.rows() == 0) return std::nullopt;
  const SurfaceQuery query(source.positions, source.triangles, SurfaceQuery::Build::fast);
  const PointsD normals = triangle_normals(source.positions, source.triangles);
  const double tolerance = options.tolerance * bounding_box(target.positions).diagonal();
  const double hope = options.least_share / 2;
  const auto fits = [&](const Similarity& to_source) {
    return glance(query, to_source, target, tolerance) >= hope;
  };
  const auto found = [&](const Similarity& to_source) -> std::optional<Twin> {
    Twin twin = look(query, normals, target, to_source, tolerance);
    if (twin.share < options.least_share) return std::nullopt;
    return twin;
  };
  for (const Similarity& start : starts)
    if (fits(start.inverse()))
      if (auto twin = found(start.inverse())) return twin;
  if (starts.empty()) return std::nullopt;
  Similarity to_source = starts.back().inverse();
  if (!refine(query, normals, target, tolerance, to_source) || !fits(to_source)) return std::nullopt;
  return found(to_source);
}

std::vector<char> kept_vertices(const Twin& twin, const Surface& source, const Surface& target,
                                double reach) {
  std::vector<char> kept(static_cast<std::size_t>(source.positions.rows()), 0);
  const SurfaceQuery query(target.positions, target.triangles);
  const PointsD placed = twin.placement(source.positions);
  const PointsD normals = vertex_normals(placed, source.triangles),
                target_normals = triangle_normals(target.positions, target.triangles);
  parallel_for(kept.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto row = static_cast<Eigen::Index>(v);
      const auto hit = query.closest(placed.row(row).transpose(), reach, [&](int t, const Eigen::Vector3d&) {
        return target_normals.row(t).dot(normals.row(row)) > least_cosine;
      });
      if (hit.triangle < 0) continue;
      kept[v] = 1;
      for (int k = 0; k < 3; ++k)
        if (!twin.points[static_cast<std::size_t>(target.triangles(hit.triangle, k))].accepted) kept[v] = 0;
    }
  });
  return kept;
}

void settle_guide(const PointsD& places, const std::vector<char>& kept, const Surface& source,
                  PointsD& guide) {
  std::vector<int> slot(kept.size(), -1), free;
  for (std::size_t v = 0; v < kept.size(); ++v)
    if (!kept[v]) {
      slot[v] = static_cast<int>(free.size());
      free.push_back(static_cast<int>(v));
    }
  PointsD change = places - guide;
  for (const int v : free) change.row(v).setZero();
  if (!free.empty()) {
    const SparseMatrix laplacian = cotangent_laplacian(source.positions, source.triangles);
    std::vector<Eigen::Triplet<double>> inner;
    PointsD right = PointsD::Zero(static_cast<Eigen::Index>(free.size()), 3);
    for (std::size_t s = 0; s < free.size(); ++s) {
      // A stray piece without a kept vertex stays where it is.
      inner.emplace_back(static_cast<int>(s), static_cast<int>(s), 1e-9);
      for (SparseMatrix::InnerIterator entry(laplacian, free[s]); entry; ++entry) {
        const auto other = static_cast<std::size_t>(entry.row());
        if (slot[other] >= 0)
          inner.emplace_back(static_cast<int>(s), slot[other], entry.value());
        else
          right.row(static_cast<Eigen::Index>(s)) -= entry.value() * change.row(entry.row());
      }
    }
    SparseMatrix system(right.rows(), right.rows());
    system.setFromTriplets(inner.begin(), inner.end());
    const Eigen::SimplicialLDLT<SparseMatrix> factor(system);
    const Eigen::MatrixXd solved = factor.solve(Eigen::MatrixXd(right));
    if (factor.info() == Eigen::Success && solved.allFinite())
      for (std::size_t s = 0; s < free.size(); ++s)
        change.row(free[s]) = solved.row(static_cast<Eigen::Index>(s));
  }
  for (std::size_t v = 0; v < kept.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    guide.row(row) =
        kept[v] ? Eigen::RowVector3d(places.row(row)) : Eigen::RowVector3d(guide.row(row) + change.row(row));
  }
}

void set_twin_rows(const Twin& twin, const Triangles& triangles, const PointsD& values, PointsD& target) {
  for (std::size_t v = 0; v < twin.points.size(); ++v) {
    const SourcePoint& point = twin.points[v];
    if (!point.accepted) continue;
    Eigen::RowVector3d row = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 3; ++k) row += point.barycentric[k] * values.row(triangles(point.triangle, k));
    target.row(static_cast<Eigen::Index>(v)) = row;
  }
}

WeightMatrix with_twin_rows(const Twin& twin, const Triangles& triangles, const WeightMatrix& values,
                            const WeightMatrix& target) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < twin.points.size(); ++v) {
    const SourcePoint& point = twin.points[v];
    const int row = static_cast<int>(v);
    if (!point.accepted)
      for (WeightMatrix::InnerIterator entry(target, row); entry; ++entry)
        entries.emplace_back(row, static_cast<int>(entry.col()), entry.value());
    for (int k = 0; k < 3 && point.accepted; ++k)
      for (WeightMatrix::InnerIterator entry(values, triangles(point.triangle, k)); entry; ++entry)
        if (point.barycentric[k] != 0)
          entries.emplace_back(row, static_cast<int>(entry.col()), point.barycentric[k] * entry.value());
  }
  WeightMatrix result(target.rows(), target.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void keep_scale(const std::vector<char>& kept, const PointsD& positions, const Triangles& triangles,
                double unit, Eigen::VectorXd& scale) {
  const double band = 0.05 * unit;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    if (kept[static_cast<std::size_t>(triangles(t, 0))] && kept[static_cast<std::size_t>(triangles(t, 1))] &&
        kept[static_cast<std::size_t>(triangles(t, 2))])
      rows.push_back(t);
  if (rows.empty()) return;
  const SurfaceQuery query(positions, Triangles(triangles(rows, Eigen::all)));
  for (Eigen::Index v = 0; v < scale.size(); ++v) {
    const double away =
        kept[static_cast<std::size_t>(v)] ? 0 : query.closest(positions.row(v).transpose()).distance;
    scale[v] = 1 + (scale[v] - 1) * std::min(1.0, away / band);
  }
}

}  // namespace mien
