#include "mien/transfer/uv_layout.h"

#include <algorithm>
#include <tuple>

#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

constexpr double same_uv = 1e-5;

struct ChartEdge {
  int low, high, triangle, k;
  bool operator<(const ChartEdge& other) const {
    return std::tie(low, high, triangle, k) < std::tie(other.low, other.high, other.triangle, other.k);
  }
};

}  // namespace

std::vector<std::array<int, 3>> chart_neighbours(const UvLayout& layout) {
  std::vector<std::array<int, 3>> neighbours(layout.uvs.size(), {-1, -1, -1});
  std::vector<ChartEdge> edges;
  edges.reserve(3 * layout.uvs.size());
  for (int t = 0; t < static_cast<int>(layout.uvs.size()); ++t)
    for (int k = 0; k < 3 && layout.has_uv[at(t)]; ++k) {
      const int a = layout.triangles(t, k), b = layout.triangles(t, (k + 1) % 3);
      edges.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  std::sort(edges.begin(), edges.end());
  // The UV of the edge's lower or higher vertex in its triangle.
  const auto uv = [&](const ChartEdge& edge, int vertex) {
    const bool first = layout.triangles(edge.triangle, edge.k) == vertex;
    return layout.uvs[at(edge.triangle)][at(first ? edge.k : (edge.k + 1) % 3)];
  };
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const ChartEdge &one = edges[e], &two = edges[e + 1];
    const bool same_edge = one.low == two.low && one.high == two.high;
    if (!same_edge || (uv(one, one.low) - uv(two, one.low)).norm() >= same_uv ||
        (uv(one, one.high) - uv(two, one.high)).norm() >= same_uv)
      continue;
    neighbours[at(one.triangle)][at(one.k)] = two.triangle;
    neighbours[at(two.triangle)][at(two.k)] = one.triangle;
  }
  return neighbours;
}

}  // namespace mien
