#include "mien/transfer/correspondence.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"

namespace mien {
namespace {

/// Openness of outer skin; below `cavity` nothing but the inside of mouth, socket or nostril.
constexpr double skin = 0.4, cavity = 0.15;

bool same_kind(double a, double b) {
  return !((a < cavity && b > skin) || (a > skin && b < cavity));
}

PointsD triangle_normals(const PointsD& positions, const Triangles& triangles) {
  PointsD normals(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0)).transpose();
    const Eigen::Vector3d b = positions.row(triangles(t, 1)).transpose();
    const Eigen::Vector3d c = positions.row(triangles(t, 2)).transpose();
    normals.row(t) = (b - a).cross(c - a).normalized().transpose();
  }
  return normals;
}

}  // namespace

std::vector<SourcePoint> find_correspondence(const Registration& registration, const Surface& source,
                                             const Surface& target, const CorrespondenceOptions& options) {
  const SurfaceQuery guide(registration.guide, source.triangles);
  const PointsD guide_normals = triangle_normals(registration.guide, source.triangles);
  const PointsD normals = vertex_normals(target.positions, target.triangles);
  const double normal_length = options.normal_length * registration.unit;
  const SurfaceQuery::Attributes weighed_normals =
      guide.with(normal_length * vertex_normals(registration.guide, source.triangles));
  const auto triangle_openness = [&](int t) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += registration.source_openness[source.triangles(t, k)] / 3;
    return sum;
  };
  std::vector<SourcePoint> points(static_cast<std::size_t>(target.positions.rows()));
  parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Index row = static_cast<Eigen::Index>(v);
      const Eigen::Vector3d position = target.positions.row(row).transpose();
      const Eigen::Vector3d normal = normals.row(row).transpose();
      const double open = registration.target_openness[row];
      const auto alike = [&](int t, const Eigen::Vector3d&) {
        return guide_normals.row(t).dot(normal) > options.least_cosine &&
               same_kind(open, triangle_openness(t));
      };
      const double reach = options.reach * registration.unit;
      SurfaceQuery::Hit hit = guide.most_alike(position, normal_length * normal, weighed_normals);
      if (hit.distance > reach || !alike(hit.triangle, hit.position))
        hit = guide.closest(position, reach, alike);
      points[v].accepted = hit.triangle >= 0;
      if (!points[v].accepted) hit = guide.closest(position);
      points[v].triangle = hit.triangle;
      points[v].barycentric = hit.barycentric;
      points[v].distance = hit.distance;
    }
  });
  return points;
}

namespace {

/// Marks the edges (three a triangle) whose ends a shape pulls apart.
void mark_torn(const PointsD& delta, const Triangles& source_triangles, const Surface& target, double unit,
               const std::vector<SourcePoint>& points, std::vector<char>& torn) {
  if (!(delta.cwiseAbs().maxCoeff() > 0.02 * unit / 2)) return;
  PointsD carried(target.positions.rows(), 3);
  for (std::size_t v = 0; v < points.size(); ++v) {
    carried.row(static_cast<Eigen::Index>(v)).setZero();
    for (int k = 0; k < 3; ++k)
      carried.row(static_cast<Eigen::Index>(v)) +=
          points[v].barycentric[k] * delta.row(source_triangles(points[v].triangle, k));
  }
  parallel_for(
      static_cast<std::size_t>(target.triangles.rows()), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
          for (int k = 0; k < 3; ++k) {
            const int a = target.triangles(static_cast<Eigen::Index>(t), k);
            const int b = target.triangles(static_cast<Eigen::Index>(t), (k + 1) % 3);
            const double apart = (carried.row(a) - carried.row(b)).norm();
            if (apart > 0.02 * unit && apart > 4 * (target.positions.row(a) - target.positions.row(b)).norm())
              torn[3 * t + static_cast<std::size_t>(k)] = 1;
          }
      });
}

void mark_torn_by_weights(const TearInput& input, const Triangles& source_triangles, const Surface& target,
                          const std::vector<SourcePoint>& points, std::vector<char>& torn) {
  Eigen::VectorXd a(input.weights.cols());
  const auto add = [&](int vertex, double sign) {
    const SourcePoint& point = points[static_cast<std::size_t>(vertex)];
    for (int k = 0; k < 3; ++k)
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(
               input.weights, source_triangles(point.triangle, k));
           entry; ++entry)
        a[entry.col()] += sign * point.barycentric[k] * entry.value();
  };
  for (Eigen::Index t = 0; t < target.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      a.setZero();
      add(target.triangles(t, k), 1);
      add(target.triangles(t, (k + 1) % 3), -1);
      if (a.lpNorm<1>() > 1.2) torn[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k)] = 1;
    }
}

}  // namespace

void reject_torn(const TearInput& input, const Surface& source, const Surface& target,
                 std::vector<SourcePoint>& points) {
  std::vector<char> torn(3 * static_cast<std::size_t>(target.triangles.rows()), 0);
  for (std::size_t s = 0; s < input.shapes; ++s)
    mark_torn(input.delta(s), source.triangles, target, input.unit, points, torn);
  if (input.weights.rows() > 0) mark_torn_by_weights(input, source.triangles, target, points, torn);
  constexpr int rounds = 3;
  constexpr double share = 0.4;
  for (int round = 0; round < rounds; ++round) {
    std::vector<int> edges(points.size(), 0), bad(points.size(), 0);
    for (std::size_t e = 0; e < torn.size(); ++e) {
      const Eigen::Index t = static_cast<Eigen::Index>(e / 3);
      const int a = target.triangles(t, static_cast<int>(e % 3)),
                b = target.triangles(t, static_cast<int>((e + 1) % 3));
      if (!points[static_cast<std::size_t>(a)].accepted || !points[static_cast<std::size_t>(b)].accepted)
        continue;
      for (const int v : {a, b}) {
        ++edges[static_cast<std::size_t>(v)];
        bad[static_cast<std::size_t>(v)] += torn[e];
      }
    }
    for (std::size_t v = 0; v < points.size(); ++v)
      if (bad[v] > 0 && bad[v] >= share * edges[v]) points[v].accepted = false;
  }
}

struct AttributeCarrier::State {
  std::vector<SourcePoint> correspondence;
  Triangles source_triangles;
  std::vector<int> filled;
  SparseMatrix from_accepted;  // #filled x #V: minus the Laplacian's rows at accepted vertices
  Eigen::SimplicialLDLT<SparseMatrix> inner;
};

AttributeCarrier::AttributeCarrier(std::vector<SourcePoint> correspondence, const Surface& source,
                                   const Surface& target)
    : state_(std::make_unique<State>()) {
  const std::vector<int> component =
      connected_components(static_cast<std::size_t>(target.positions.rows()), target.triangles);
  std::vector<char> known(component.size(), 0);
  for (std::size_t v = 0; v < correspondence.size(); ++v)
    if (correspondence[v].accepted) known[component[v]] = 1;
  std::vector<int> slot(correspondence.size(), -1);
  for (std::size_t v = 0; v < correspondence.size(); ++v)
    if (!correspondence[v].accepted && known[component[v]]) {
      slot[v] = static_cast<int>(state_->filled.size());
      state_->filled.push_back(static_cast<int>(v));
    }
  state_->correspondence = std::move(correspondence);
  state_->source_triangles = source.triangles;
  if (state_->filled.empty()) return;

  const SparseMatrix laplacian = cotangent_laplacian(target.positions, target.triangles);
  std::vector<Eigen::Triplet<double>> inner, outer;
  for (std::size_t s = 0; s < state_->filled.size(); ++s)
    for (SparseMatrix::InnerIterator entry(laplacian, state_->filled[s]); entry; ++entry) {
      const int other = static_cast<int>(entry.row());
      if (slot[other] >= 0)
        inner.emplace_back(static_cast<int>(s), slot[other], entry.value());
      else
        outer.emplace_back(static_cast<int>(s), other, -entry.value());
    }
  const Eigen::Index count = static_cast<Eigen::Index>(state_->filled.size());
  SparseMatrix block(count, count);
  block.setFromTriplets(inner.begin(), inner.end());
  state_->from_accepted.resize(count, target.positions.rows());
  state_->from_accepted.setFromTriplets(outer.begin(), outer.end());
  state_->inner.compute(block);
}

AttributeCarrier::~AttributeCarrier() = default;
AttributeCarrier::AttributeCarrier(AttributeCarrier&&) noexcept = default;

Eigen::MatrixXd AttributeCarrier::operator()(const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd carried =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(state_->correspondence.size()), values.cols());
  for (std::size_t v = 0; v < state_->correspondence.size(); ++v) {
    const SourcePoint& point = state_->correspondence[v];
    for (int k = 0; k < 3; ++k)
      carried.row(static_cast<Eigen::Index>(v)) +=
          point.barycentric[k] * values.row(state_->source_triangles(point.triangle, k));
  }
  if (state_->filled.empty()) return carried;
  for (const int v : state_->filled) carried.row(v).setZero();
  const Eigen::MatrixXd inner = state_->inner.solve(state_->from_accepted * carried);
  for (std::size_t s = 0; s < state_->filled.size(); ++s)
    carried.row(state_->filled[s]) = inner.row(static_cast<Eigen::Index>(s));
  return carried;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> AttributeCarrier::operator()(
    const Eigen::SparseMatrix<double, Eigen::RowMajor>& values) const {
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const Eigen::Index count = static_cast<Eigen::Index>(state_->correspondence.size());
  std::vector<char> is_filled(state_->correspondence.size(), 0);
  for (const int v : state_->filled) is_filled[static_cast<std::size_t>(v)] = 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < state_->correspondence.size(); ++v) {
    const SourcePoint& point = state_->correspondence[v];
    for (int k = 0; k < 3 && !is_filled[v]; ++k)
      for (Rows::InnerIterator entry(values, state_->source_triangles(point.triangle, k)); entry; ++entry)
        entries.emplace_back(static_cast<int>(v), static_cast<int>(entry.col()),
                             point.barycentric[k] * entry.value());
  }
  Rows carried(count, values.cols());
  carried.setFromTriplets(entries.begin(), entries.end());
  if (state_->filled.empty()) return carried;
  const SparseMatrix right = state_->from_accepted * SparseMatrix(carried);
  const SparseMatrix inner = state_->inner.solve(right);
  for (Eigen::Index column = 0; column < inner.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(inner, column); entry; ++entry)
      entries.emplace_back(state_->filled[static_cast<std::size_t>(entry.row())], static_cast<int>(column),
                           entry.value());
  carried.setFromTriplets(entries.begin(), entries.end());
  return carried;
}

const std::vector<int>& AttributeCarrier::filled() const {
  return state_->filled;
}
const std::vector<SourcePoint>& AttributeCarrier::correspondence() const {
  return state_->correspondence;
}

}  // namespace mien
