#include "mien/geometry/geodesic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Nearest first, to the digits of a float; of equally near ones the lowest vertex. Distance and vertex share one number, because comparing
/// is most of what a queue does; four children a node, because they lie in one line of the cache and halve the way down.
class Queue {
 public:
  bool empty() const { return heap_.empty(); }
  void push(double distance, int vertex) {
    const auto bits = std::bit_cast<std::uint32_t>(
        static_cast<float>(distance));  // ascend with the distance, which is not negative
    const auto item = static_cast<std::uint64_t>(bits) << 32 | static_cast<std::uint32_t>(vertex);
    std::size_t at = heap_.size();
    heap_.push_back(item);
    for (; at > 0 && item < heap_[(at - 1) / 4]; at = (at - 1) / 4) heap_[at] = heap_[(at - 1) / 4];
    heap_[at] = item;
  }
  int nearest() const { return static_cast<int>(heap_.front() & 0xffffffffu); }
  int pop() {
    const int vertex = nearest();
    const std::uint64_t item = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) sink(item);
    return vertex;
  }

 private:
  /// Puts `item` where the first one was.
  void sink(std::uint64_t item) {
    const std::size_t count = heap_.size();
    std::size_t at = 0;
    for (std::size_t child = 1; child < count; child = 4 * at + 1) {
      const std::size_t end = std::min(child + 4, count);
      std::size_t least = child;
      for (++child; child < end; ++child) least = heap_[child] < heap_[least] ? child : least;
      if (!(heap_[least] < item)) break;
      heap_[at] = heap_[least];
      at = least;
    }
    heap_[at] = item;
  }
  std::vector<std::uint64_t> heap_;
};

/// What is known of a vertex while fronts pass; side by side, as they are asked for together.
struct Node {
  double distance = infinity, place = 0;
  bool fixed = false;
};

/// C's arrival when a plane front passes A and B and reaches C through AB before `known`; otherwise infinitely late. `x`, `y`: C in the frame
/// with A at the origin and B at (c, 0).
Node plane_front(const Node& a, const Node& b, double c, double x, double y, double known) {
  Node arrival;
  const double gx = (b.distance - a.distance) / c, rest = 1 - gx * gx;
  if (!(rest > 0) || !(y > 0)) return arrival;
  const double gy = std::sqrt(rest), distance = a.distance + gx * x + gy * y;
  const double foot = gy * x - gx * y,
               end = gy * c;  // where between A and B the front's path to C starts, times gy
  if (!(distance < known) || foot < 0 || foot > end) return arrival;
  arrival.distance = distance;
  arrival.place = (1 - foot / end) * a.place + foot / end * b.place;
  return arrival;
}

}  // namespace

Geodesics::Geodesics(const PointsD& positions, const Triangles& triangles) : positions_(positions) {
  if (!positions.allFinite()) throw invalid_input("surface", "has a position that is not finite");
  const auto count = static_cast<int>(positions.rows());
  offsets_.assign(static_cast<std::size_t>(count) + 1, 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      require_vertex(triangles(t, k));
      ++offsets_[triangles(t, k) + 1];
    }
  for (int v = 0; v < count; ++v) offsets_[v + 1] += offsets_[v];
  spokes_.resize(static_cast<std::size_t>(3 * triangles.rows()));
  std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = triangles(t, k);
      Spoke& spoke = spokes_[next[v]++];
      spoke.a = triangles(t, (k + 1) % 3);
      spoke.b = triangles(t, (k + 2) % 3);
      const Eigen::Vector3d a = (positions.row(spoke.a) - positions.row(v)).transpose(),
                            b = (positions.row(spoke.b) - positions.row(v)).transpose();
      const double to_a = a.norm(), to_b = b.norm(), along = a.dot(b), area = a.cross(b).norm();
      spoke.to_a = static_cast<float>(to_a);
      spoke.to_b = static_cast<float>(to_b);
      if (to_b > 0) spoke.x_a = static_cast<float>(along / to_b), spoke.y_a = static_cast<float>(area / to_b);
      if (to_a > 0) spoke.x_b = static_cast<float>(along / to_a), spoke.y_b = static_cast<float>(area / to_a);
    }
}

void Geodesics::require_vertex(int vertex) const {
  if (vertex < 0 || vertex >= positions_.rows())
    throw invalid_input("vertex " + std::to_string(vertex), "does not exist",
                        "one from 0 to " + std::to_string(static_cast<int>(positions_.rows()) - 1));
}

GeodesicField Geodesics::distances(std::span<const GeodesicSeed> seeds, double max_distance) const {
  std::vector<Node> nodes(static_cast<std::size_t>(positions_.rows()));
  Queue queue;
  const auto reach = [&](int vertex, double distance, double place) {
    Node& node = nodes[vertex];
    if (!(distance < node.distance)) return;
    node.distance = distance;
    node.place = place;
    queue.push(distance, vertex);
  };
  /// Along the edge from `from`, and with a front between it and `other` if that is known.
  const auto advance = [&](const Node& from, int other, int to, const Spoke& spoke, bool to_is_a) {
    const Node& node = nodes[to];
    if (node.fixed) return;
    const double base = to_is_a ? spoke.to_b : spoke.to_a;
    if (nodes[other].fixed && base > 0) {
      const Node front = plane_front(from, nodes[other], base, to_is_a ? spoke.x_a : spoke.x_b,
                                     to_is_a ? spoke.y_a : spoke.y_b, node.distance);
      reach(to, front.distance, front.place);
    }
    reach(to, from.distance + (to_is_a ? spoke.to_a : spoke.to_b), from.place);
  };
  for (const GeodesicSeed& seed : seeds) {
    require_vertex(seed.vertex);
    if (!(seed.distance >= 0) || !std::isfinite(seed.distance))
      throw invalid_input("seed at vertex " + std::to_string(seed.vertex),
                          "has a distance that is negative or not finite", "0 or more");
    reach(seed.vertex, seed.distance, seed.place);
  }
  while (!queue.empty()) {
    const int vertex = queue.pop();
    if (nodes[vertex].fixed) continue;
    if (nodes[vertex].distance > max_distance) break;
    nodes[vertex].fixed = true;
    if (!queue
             .empty())  // whose triangles are asked for next: they are on their way while this one's are worked on
      __builtin_prefetch(spokes_of(queue.nearest()).data());
    const Node from = nodes[vertex];
    for (const Spoke& spoke : spokes_of(vertex)) {
      advance(from, spoke.b, spoke.a, spoke, true);
      advance(from, spoke.a, spoke.b, spoke, false);
    }
  }
  GeodesicField field{Eigen::VectorXd::Constant(positions_.rows(), infinity),
                      Eigen::VectorXd::Zero(positions_.rows())};
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    if (!nodes[v].fixed) continue;
    field.distance[static_cast<Eigen::Index>(v)] = nodes[v].distance;
    field.place[static_cast<Eigen::Index>(v)] = nodes[v].place;
  }
  return field;
}

/// Dijkstra's search, led on by the straight distance to the end (Hart, Nilsson and Raphael 1968).
std::vector<int> Geodesics::edge_path(int from, int to) const {
  require_vertex(from);
  require_vertex(to);
  const auto count = static_cast<std::size_t>(positions_.rows());
  std::vector<double> distance(count, infinity);
  std::vector<int> before(count, -1);
  std::vector<char> fixed(count, 0);
  Queue queue;
  const auto left = [&](int vertex) { return (positions_.row(vertex) - positions_.row(to)).norm(); };
  distance[from] = 0;
  queue.push(left(from), from);
  while (!queue.empty() && !fixed[to]) {
    const int vertex = queue.pop();
    if (fixed[vertex]) continue;
    fixed[vertex] = 1;
    for (const Spoke& spoke : spokes_of(vertex))
      for (const auto& [other, edge] : {std::pair(spoke.a, spoke.to_a), std::pair(spoke.b, spoke.to_b)}) {
        const double through = distance[vertex] + edge;
        if (fixed[other] || !(through < distance[other])) continue;
        distance[other] = through;
        before[other] = vertex;
        queue.push(through + left(other), other);
      }
  }
  if (!fixed[to]) return {};
  std::vector<int> path;
  for (int v = to; v >= 0; v = before[v]) path.push_back(v);
  std::reverse(path.begin(), path.end());
  return path;
}

int Geodesics::walk_towards(int from, const Eigen::Vector3d& goal) const {
  require_vertex(from);
  const auto far = [&](int vertex) { return (positions_.row(vertex).transpose() - goal).squaredNorm(); };
  int at = from;
  for (int last = -1; last != at;) {
    last = at;
    for (const Spoke& spoke : spokes_of(last))
      for (const int other : {spoke.a, spoke.b})
        if (far(other) < far(at)) at = other;
  }
  return at;
}

Eigen::Vector3d Geodesics::normal_at(int vertex) const {
  require_vertex(vertex);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Spoke& spoke : spokes_of(vertex)) {
    const Eigen::Vector3d a = (positions_.row(spoke.a) - positions_.row(vertex)).transpose(),
                          b = (positions_.row(spoke.b) - positions_.row(vertex)).transpose();
    sum += a.cross(b);
  }
  const double length = sum.norm();
  return length > 0 ? Eigen::Vector3d(sum / length) : sum;
}

}  // namespace mien
