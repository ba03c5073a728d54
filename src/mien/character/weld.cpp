#include "mien/character/weld.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "mien/core/error.h"

// Position alone cannot tell a seam from two lips that touch, so only the open edges speak: a seam leaves two
// of them, running in opposite directions through the same two points, while touching parts of a closed
// surface leave none.

namespace mien {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  /// The lower number stays the root, so that representatives do not depend on the order of joining.
  void join(int a, int b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// A boundary edge from vertex a to vertex b, with the numbers of their positions.
struct OpenEdge {
  int position_a, position_b, a, b, piece;
};

/// One number for each distinct position among `vertices`, -1 elsewhere.
std::vector<int> number_positions(const Points& positions, std::vector<int> vertices) {
  const auto row = [&](int v) {  // adding zero turns -0 into +0
    return std::array<float, 3>{positions(v, 0) + 0.f, positions(v, 1) + 0.f, positions(v, 2) + 0.f};
  };
  std::vector<int> number(static_cast<std::size_t>(positions.rows()), -1);
  std::sort(vertices.begin(), vertices.end(), [&](int a, int b) {
    const auto row_a = row(a), row_b = row(b);
    return row_a != row_b ? row_a < row_b : a < b;
  });
  int next = -1;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i == 0 || row(vertices[i]) != row(vertices[i - 1])) ++next;
    number[vertices[i]] = next;
  }
  return number;
}

/// Edges that no face runs back along, ascending by their vertices; their ends lie at different positions.
std::vector<OpenEdge> open_edges(const Mesh& mesh, DisjointSets& pieces) {
  const std::size_t count = mesh.vertex_count();
  std::vector<int> offsets(count + 1, 0), heads(mesh.faces.corner_count());
  const auto each_edge = [&](const auto& use) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = mesh.faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) use(face[c], face[(c + 1) % face.size()]);
    }
  };
  each_edge([&](int a, int b) {
    ++offsets[a + 1];
    pieces.join(a, b);
  });
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<int> next(offsets.begin(), offsets.end() - 1);
  each_edge([&](int a, int b) { heads[next[a]++] = b; });
  const auto from = [&](int a) { return std::span(heads).subspan(offsets[a], offsets[a + 1] - offsets[a]); };
  std::vector<OpenEdge> open;
  std::vector<int> ends;
  for (int a = 0; a < static_cast<int>(count); ++a) {
    std::sort(from(a).begin(), from(a).end());
    for (const int b : from(a)) {
      if (std::find(from(b).begin(), from(b).end(), a) != from(b).end()) continue;
      open.push_back({0, 0, a, b, 0});
      ends.insert(ends.end(), {a, b});
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const std::vector<int> position = number_positions(mesh.positions, std::move(ends));
  for (OpenEdge& edge : open) {
    edge.position_a = position[edge.a];
    edge.position_b = position[edge.b];
  }
  std::erase_if(open, [](const OpenEdge& edge) { return edge.position_a == edge.position_b; });
  return open;
}

using MayJoin = std::function<bool(int, int)>;

/// Joins each open edge with the one that runs back through the same positions (and in the same piece).
/// Returns the edges that found several partners.
std::vector<OpenEdge> join_opposite(std::vector<OpenEdge> open, DisjointSets& welded,
                                    const MayJoin& may_join) {
  const auto key = [](const OpenEdge& e) { return std::array<int, 3>{e.piece, e.position_a, e.position_b}; };
  const auto before = [&](const OpenEdge& x, const OpenEdge& y) { return key(x) < key(y); };
  std::stable_sort(open.begin(), open.end(), before);
  std::vector<OpenEdge> ambiguous;
  for (const OpenEdge& edge : open) {
    const auto same = std::equal_range(open.begin(), open.end(), edge, before);
    const OpenEdge back{edge.position_b, edge.position_a, -1, -1, edge.piece};
    const auto partners = std::equal_range(open.begin(), open.end(), back, before);
    if (partners.first == partners.second) continue;
    if (same.second - same.first > 1 || partners.second - partners.first > 1) {
      ambiguous.push_back(edge);
      continue;
    }
    if (may_join(edge.a, partners.first->b)) welded.join(edge.a, partners.first->b);
    if (may_join(edge.b, partners.first->a)) welded.join(edge.b, partners.first->a);
  }
  return ambiguous;
}

void check_corners(const Mesh& mesh) {
  for (const int corner : mesh.faces.corners())
    if (corner < 0 || corner >= mesh.positions.rows())
      throw invalid_input("face", "names vertex " + std::to_string(corner),
                          "there are " + std::to_string(mesh.positions.rows()) + " vertices");
}

Weld number_welded(std::size_t count, DisjointSets& welded) {
  Weld weld;
  weld.of.assign(count, -1);
  for (int v = 0; v < static_cast<int>(count); ++v) {
    const int root = welded.root(v);
    if (root == v) {
      weld.of[v] = static_cast<int>(weld.representative.size());
      weld.representative.push_back(v);
    } else {
      weld.of[v] = weld.of[root];
    }
  }
  return weld;
}

Weld weld_where(const Mesh& mesh, const MayJoin& may_join) {
  check_corners(mesh);
  const std::size_t count = mesh.vertex_count();
  DisjointSets welded(count), pieces(count);
  std::vector<OpenEdge> ambiguous = join_opposite(open_edges(mesh, pieces), welded, may_join);
  if (!ambiguous.empty()) {
    for (int v = 0; v < static_cast<int>(count); ++v) pieces.join(v, welded.root(v));
    for (OpenEdge& edge : ambiguous) edge.piece = pieces.root(edge.a);
    join_opposite(std::move(ambiguous), welded, may_join);
  }
  return number_welded(count, welded);
}

/// The row of a vertex in a sparse delta, -1: it does not move.
int row_of(const PartDelta& delta, int vertex) {
  const auto found = std::lower_bound(delta.vertices.begin(), delta.vertices.end(), vertex);
  return found != delta.vertices.end() && *found == vertex ? static_cast<int>(found - delta.vertices.begin())
                                                           : -1;
}

bool moves_alike(const PartDelta& delta, int a, int b, double tolerance) {
  const int row_a = row_of(delta, a), row_b = row_of(delta, b);
  const Eigen::RowVector3f zero = Eigen::RowVector3f::Zero();
  const Eigen::RowVector3f move_a = row_a < 0 ? zero : Eigen::RowVector3f(delta.deltas.row(row_a));
  const Eigen::RowVector3f move_b = row_b < 0 ? zero : Eigen::RowVector3f(delta.deltas.row(row_b));
  return (move_a - move_b).norm() <= tolerance;
}

bool bound_alike(const SkinWeights& skin, int a, int b) {
  constexpr float tolerance = 0.02f;  // files store weights in as little as eight bits
  const auto weight_of = [&](int vertex, int joint) {
    float sum = 0;
    for (int i = skin.offsets[vertex]; i < skin.offsets[vertex + 1]; ++i)
      if (skin.joints[i] == joint) sum += skin.weights[i];
    return sum;
  };
  for (const int vertex : {a, b})
    for (int i = skin.offsets[vertex]; i < skin.offsets[vertex + 1]; ++i)
      if (std::abs(weight_of(a, skin.joints[i]) - weight_of(b, skin.joints[i])) > tolerance) return false;
  return true;
}

}  // namespace

Weld weld_seams(const Mesh& mesh) {
  return weld_where(mesh, [](int, int) { return true; });
}

Weld weld_seams(const Character& character, int part) {
  const Part& welded = character.parts.at(part);
  const double tolerance = 1e-4 * bounding_box(welded.mesh.positions).diagonal();
  std::vector<const PartDelta*> deltas;
  for (const Shape& shape : character.shapes)
    for (const PartDelta& delta : shape.parts)
      if (delta.part == part) deltas.push_back(&delta);
  return weld_where(welded.mesh, [&](int a, int b) {
    if (!welded.skin_weights.empty() && !bound_alike(welded.skin_weights, a, b)) return false;
    return std::all_of(deltas.begin(), deltas.end(),
                       [&](const PartDelta* delta) { return moves_alike(*delta, a, b, tolerance); });
  });
}

Faces weld_faces(const Faces& faces, const Weld& weld) {
  Faces result = faces;
  for (int& corner : result.corners()) corner = weld.of[corner];
  return result;
}

}  // namespace mien
