#include "mien/transfer/detail/matching.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "mien/core/parallel.h"

namespace mien::detail {
namespace {

/// Outer skin, cavity, or the rim between, which goes with both.
bool may_match(double a, double b) {
  constexpr double cavity = 0.15, skin = 0.4;
  return !((a < cavity && b > skin) || (a > skin && b < cavity));
}

double interpolate(const Eigen::VectorXd& values, const Triangles& triangles, const SurfaceQuery::Hit& hit) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += hit.barycentric[k] * values[triangles(hit.triangle, k)];
  return sum;
}

bool on_border(const MatchSurface& surface, const SurfaceQuery::Hit& hit) {
  for (int k = 0; k < 3; ++k)
    if (hit.barycentric[k] > 1e-6 && !surface.boundary[surface.triangles(hit.triangle, k)]) return false;
  return true;
}

/// The vertices that ask: all, or every k-th.
struct Asking {
  Eigen::Index step, count;
  Eigen::Index vertex(std::size_t i) const { return static_cast<Eigen::Index>(i) * step; }
};
Asking asking(const MatchSurface& surface, int most) {
  const Eigen::Index all = surface.positions.rows(), step = (all + most - 1) / most;
  return {step, (all + step - 1) / step};
}

/// Normals times what a difference of them counts as.
PointsD weighed_normals(const MatchSurface& surface, const MatchOptions& options) {
  if (surface.far.size() == 0) return options.normal_length * surface.normals;
  const Eigen::VectorXd length =
      (options.normal_length + (options.far_normal_length - options.normal_length) * surface.far.array())
          .matrix();
  return length.asDiagonal() * surface.normals;
}

std::vector<SurfaceQuery::Hit> nearest(const MatchSurface& from, const MatchSurface& to, const Asking& ask,
                                       const MatchOptions& options, std::vector<int>& last) {
  std::vector<SurfaceQuery::Hit> hits(static_cast<std::size_t>(ask.count));
  const bool by_normals = options.normal_length > 0 || options.far_normal_length > 0;
  PointsD from_normals;
  SurfaceQuery::Attributes to_normals;
  if (by_normals) {
    from_normals = weighed_normals(from, options);
    to_normals = to.query.with(weighed_normals(to, options));
  }
  last.resize(static_cast<std::size_t>(from.positions.rows()), -1);
  parallel_for(hits.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Index v = ask.vertex(i);
      const Eigen::Vector3d point = from.positions.row(v).transpose();
      int& guess = last[static_cast<std::size_t>(v)];
      hits[i] = by_normals ? to.query.most_alike(point, from_normals.row(v).transpose(), to_normals, guess)
                           : to.query.closest(point);
      guess = hits[i].triangle;
    }
  });
  return hits;
}

/// For each asking vertex of `from` its match on `to`; triangle -1 where the gates reject.
std::vector<SurfaceQuery::Hit> match(const MatchSurface& from, const MatchSurface& to,
                                     const MatchOptions& options, std::vector<int>& last) {
  const Asking ask = asking(from, options.most_vertices);
  std::vector<SurfaceQuery::Hit> hits = nearest(from, to, ask, options, last);
  std::vector<double> distances(hits.size());
  std::transform(hits.begin(), hits.end(), distances.begin(), [](const auto& hit) { return hit.distance; });
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
  const double reach = std::max(options.least_reach, 3 * distances[distances.size() / 2]);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    SurfaceQuery::Hit& hit = hits[i];
    const Eigen::Index row = ask.vertex(i);
    const bool take = hit.distance <= reach && !on_border(to, hit) &&
                      from.normals.row(row).dot(to.triangle_normal(hit.triangle)) > options.least_cosine &&
                      may_match(from.openness[row], interpolate(to.openness, to.triangles, hit));
    if (!take) hit.triangle = -1;
  }
  return hits;
}

/// The tangential share of a pull onto this place.
double across(const MatchSurface& surface, const SurfaceQuery::Hit& hit, const MatchOptions& options) {
  double bend = 0;
  for (int k = 0; k < 3 && options.bend_length > 0; ++k) {
    const int a = surface.triangles(hit.triangle, k), b = surface.triangles(hit.triangle, (k + 1) % 3);
    const double length = (surface.positions.row(a) - surface.positions.row(b)).norm();
    if (length > 0) bend = std::max(bend, (surface.normals.row(a) - surface.normals.row(b)).norm() / length);
  }
  const double turn = options.bend_length * bend;
  return options.tangential + (1 - options.tangential) * turn * turn / (1 + turn * turn);
}

}  // namespace

MatchSurface::MatchSurface(const PointsD& p, const Triangles& t, const Eigen::VectorXd& o,
                           const Eigen::VectorXd& m, const std::vector<char>& b, SurfaceQuery::Build build)
    : positions(p),
      normals(vertex_normals(p, t)),
      triangles(t),
      openness(o),
      masses(m),
      boundary(b),
      query(p, t, build) {}

Eigen::Vector3d MatchSurface::triangle_normal(int triangle) const {
  const Eigen::Vector3d a = positions.row(triangles(triangle, 0)).transpose();
  const Eigen::Vector3d b = positions.row(triangles(triangle, 1)).transpose();
  const Eigen::Vector3d c = positions.row(triangles(triangle, 2)).transpose();
  return (b - a).cross(c - a).normalized();
}

Eigen::Vector3d MatchSurface::normal_at(const SurfaceQuery::Hit& place) const {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    normal += place.barycentric[k] * normals.row(triangles(place.triangle, k)).transpose();
  const double length = normal.norm();
  return length > 0 ? Eigen::Vector3d(normal / length) : triangle_normal(place.triangle);
}

std::vector<Wish> match_both_ways(const MatchSurface& moving, const MatchSurface& fixed,
                                  const MatchOptions& options, MatchMemory& memory) {
  std::vector<Wish> wishes;
  wishes.reserve(static_cast<std::size_t>(moving.positions.rows() + fixed.positions.rows()));
  const auto forward = match(moving, fixed, options, memory.forward);
  const Asking forward_ask = asking(moving, options.most_vertices);
  for (std::size_t i = 0; i < forward.size(); ++i) {
    const SurfaceQuery::Hit& hit = forward[i];
    if (hit.triangle < 0) continue;
    const int vertex = static_cast<int>(forward_ask.vertex(i));
    const double mass = moving.masses[vertex] * static_cast<double>(forward_ask.step);
    wishes.push_back({{vertex, vertex, vertex},
                      {1, 0, 0},
                      hit.position,
                      fixed.normal_at(hit),
                      mass,
                      across(fixed, hit, options) * mass});
  }
  const auto backward = match(fixed, moving, options, memory.backward);
  const Asking backward_ask = asking(fixed, options.most_vertices);
  for (std::size_t i = 0; i < backward.size(); ++i) {
    const SurfaceQuery::Hit& hit = backward[i];
    if (hit.triangle < 0) continue;
    const Eigen::Index row = backward_ask.vertex(i);
    const double mass = fixed.masses[row] * static_cast<double>(backward_ask.step);
    Wish wish;
    for (int k = 0; k < 3; ++k) {
      wish.vertices[k] = moving.triangles(hit.triangle, k);
      wish.weights[k] = hit.barycentric[k];
    }
    wish.goal = fixed.positions.row(row).transpose();
    wish.axis = fixed.normals.row(row).transpose();
    wish.along = mass;
    wish.across = across(moving, hit, options) * mass;
    wishes.push_back(wish);
  }
  return wishes;
}

}  // namespace mien::detail
