#include "mien/geometry/geodesic.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Nearest first; of equally near ones the lowest vertex.
using Queue = std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                                  std::greater<std::pair<double, int>>>;

struct Front {
  double distance = infinity;
  double foot = 0;  ///< where between A and B, from 0 to 1, the front's path to C starts
};

/// The distance of C when a plane front passes A at `a` and B at `b`; infinite when no such front reaches C through AB.
/// `x`, `y`: C in the frame with A at the origin and B at (c, 0).
Front plane_front(double a, double b, double c, double x, double y) {
  const double gx = (b - a) / c, rest = 1 - gx * gx;
  if (!(rest > 0) || !(y > 0)) return {};
  const double gy = std::sqrt(rest), foot = x - y * gx / gy;
  if (foot < 0 || foot > c) return {};
  return {a + gx * x + gy * y, foot / c};
}

}  // namespace

Geodesics::Geodesics(const PointsD& positions, const Triangles& triangles)
    : positions_(positions), triangles_(triangles) {
  if (!positions.allFinite()) throw invalid_input("surface", "has a position that is not finite");
  const auto count = static_cast<int>(positions.rows());
  corner_offsets_.assign(static_cast<std::size_t>(count) + 1, 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      require_vertex(triangles(t, k));
      ++corner_offsets_[triangles(t, k) + 1];
    }
  for (int v = 0; v < count; ++v) corner_offsets_[v + 1] += corner_offsets_[v];
  corner_triangles_.resize(static_cast<std::size_t>(3 * triangles.rows()));
  std::vector<int> next(corner_offsets_.begin(), corner_offsets_.end() - 1);
  lengths_.resize(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      corner_triangles_[next[triangles(t, k)]++] = static_cast<int>(t);
      lengths_(t, k) =
          (positions.row(triangles(t, (k + 1) % 3)) - positions.row(triangles(t, (k + 2) % 3))).norm();
    }
}

void Geodesics::require_vertex(int vertex) const {
  if (vertex < 0 || vertex >= positions_.rows())
    throw invalid_input("vertex " + std::to_string(vertex), "does not exist",
                        "one from 0 to " + std::to_string(static_cast<int>(positions_.rows()) - 1));
}

/// What `triangle` says about `vertex`, from its two other corners.
Geodesics::Arrival Geodesics::across(int triangle, int vertex, const GeodesicField& field,
                                     const std::vector<char>& fixed) const {
  int k = 0;
  while (triangles_(triangle, k) != vertex) ++k;
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const int a = triangles_(triangle, i), b = triangles_(triangle, j);
  const double to_a = lengths_(triangle, j), to_b = lengths_(triangle, i), base = lengths_(triangle, k);
  Arrival best;
  if (fixed[a]) best = {field.distance[a] + to_a, field.place[a]};
  if (fixed[b] && field.distance[b] + to_b < best.distance) best = {field.distance[b] + to_b, field.place[b]};
  if (fixed[a] && fixed[b] && base > 0) {
    const double x = (to_a * to_a - to_b * to_b + base * base) / (2 * base);
    const double y = std::sqrt(std::max(0.0, to_a * to_a - x * x));
    const Front front = plane_front(field.distance[a], field.distance[b], base, x, y);
    if (front.distance < best.distance)
      best = {front.distance, (1 - front.foot) * field.place[a] + front.foot * field.place[b]};
  }
  return best;
}

GeodesicField Geodesics::distances(std::span<const GeodesicSeed> seeds, double max_distance) const {
  const auto count = static_cast<std::size_t>(positions_.rows());
  GeodesicField field{Eigen::VectorXd::Constant(positions_.rows(), infinity),
                      Eigen::VectorXd::Zero(positions_.rows())};
  std::vector<char> fixed(count, 0);
  Queue queue;
  const auto reach = [&](int vertex, const Arrival& arrival) {
    if (!(arrival.distance < field.distance[vertex])) return;
    field.distance[vertex] = arrival.distance;
    field.place[vertex] = arrival.place;
    queue.emplace(arrival.distance, vertex);
  };
  for (const GeodesicSeed& seed : seeds) {
    require_vertex(seed.vertex);
    if (!(seed.distance >= 0) || !std::isfinite(seed.distance))
      throw invalid_input("seed at vertex " + std::to_string(seed.vertex),
                          "has a distance that is negative or not finite", "0 or more");
    reach(seed.vertex, {seed.distance, seed.place});
  }
  while (!queue.empty()) {
    const auto [at, vertex] = queue.top();
    queue.pop();
    if (fixed[vertex]) continue;
    if (at > max_distance) break;
    fixed[vertex] = 1;
    for (const int triangle : triangles_at(vertex))
      for (int k = 0; k < 3; ++k) {
        const int corner = triangles_(triangle, k);
        if (!fixed[corner]) reach(corner, across(triangle, corner, field, fixed));
      }
  }
  for (std::size_t v = 0; v < count; ++v)
    if (!fixed[v]) field.distance[static_cast<Eigen::Index>(v)] = infinity;
  return field;
}

std::vector<int> Geodesics::edge_path(int from, int to) const {
  require_vertex(from);
  require_vertex(to);
  const auto count = static_cast<std::size_t>(positions_.rows());
  std::vector<double> distance(count, infinity);
  std::vector<int> before(count, -1);
  std::vector<char> fixed(count, 0);
  Queue queue;
  queue.emplace(distance[from] = 0, from);
  while (!queue.empty() && !fixed[to]) {
    const auto [at, vertex] = queue.top();
    queue.pop();
    if (fixed[vertex]) continue;
    fixed[vertex] = 1;
    for (const int triangle : triangles_at(vertex))
      for (int k = 0; k < 3; ++k) {
        const int other = triangles_(triangle, k);
        const double through = at + (positions_.row(other) - positions_.row(vertex)).norm();
        if (through < distance[other]) {
          distance[other] = through;
          before[other] = vertex;
          queue.emplace(through, other);
        }
      }
  }
  if (!fixed[to]) return {};
  std::vector<int> path;
  for (int v = to; v >= 0; v = before[v]) path.push_back(v);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace mien
