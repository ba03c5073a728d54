// Botsch and Kobbelt 2004, A Remeshing Approach to Multiresolution Modeling, without its splits: merge short edges,
// turn edges towards six neighbours a vertex, let vertices slide to the middle of their neighbours.

#include "mien/sample/detail/remesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>

namespace mien::sample {

namespace {

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

class Remesher {
 public:
  Remesher(const Mesh& mesh, const std::vector<char>& kept, const std::vector<double>& wanted)
      : kept_(kept), wanted_(wanted), around_(mesh.vertex_count()), alive_(mesh.vertex_count(), 1) {
    for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v)
      points_.push_back(mesh.positions.row(v).transpose().cast<double>());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = mesh.faces[f];
      int group = 0;
      while (static_cast<int>(f) >= mesh.groups[group].face_end) ++group;
      // A quad is cut along its shorter diagonal.
      const bool turned = face.size() == 4 && (points_[face[1]] - points_[face[3]]).squaredNorm() <
                                                  (points_[face[0]] - points_[face[2]]).squaredNorm();
      for (std::size_t c = 2; c < face.size(); ++c) {
        const std::size_t shift = turned ? 1 : 0, n = face.size();
        add({face[shift], face[(c - 1 + shift) % n], face[(c + shift) % n]}, group);
      }
    }
  }

  void merge_short_edges() {
    struct Edge {
      double ratio;
      int a, b;
      bool operator<(const Edge& o) const { return std::tie(ratio, a, b) < std::tie(o.ratio, o.a, o.b); }
    };
    std::vector<Edge> edges;
    for (const Triangle& t : triangles_)
      for (int c = 0; c < 3 && t[0] >= 0; ++c) {
        const int a = t[c], b = t[(c + 1) % 3];
        const double ratio = (points_[a] - points_[b]).norm() / std::min(wanted_[a], wanted_[b]);
        if (a < b && ratio < 0.8) edges.push_back({ratio, a, b});
      }
    std::sort(edges.begin(), edges.end());
    std::vector<char> touched(points_.size(), 0);
    for (const Edge& edge : edges) {
      if (touched[edge.a] || touched[edge.b] || !alive_[edge.a] || !alive_[edge.b]) continue;
      const bool a_stays = fixed(edge.a);
      if (a_stays && fixed(edge.b)) continue;
      const int stays = a_stays || !fixed(edge.b) ? edge.a : edge.b, goes = stays == edge.a ? edge.b : edge.a;
      if (merge(stays, goes)) {
        touched[stays] = 1;
        for (int v : neighbours(stays)) touched[v] = 1;
      }
    }
  }

  void turn_edges() {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int c = 0; c < 3; ++c)
        if (triangles_[t][0] >= 0) turn(static_cast<int>(t), c);
  }

  /// Lets free vertices slide in their tangent plane.
  void slide() {
    std::vector<Vector3d> next = points_;
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (!alive_[v] || fixed(static_cast<int>(v)) || around_[v].empty()) continue;
      Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
      const std::set<int> ring = neighbours(static_cast<int>(v));
      for (int other : ring) middle += points_[other] / ring.size();
      for (int t : around_[v]) normal += area_vector(triangles_[t]);
      normal.normalize();
      const Vector3d move = middle - points_[v];
      next[v] += 0.4 * (move - normal * normal.dot(move));
    }
    points_ = next;
  }

  Remeshed finish(const std::vector<FaceGroup>& groups) const {
    Remeshed out;
    out.new_vertex.assign(points_.size(), -1);
    std::vector<Vector3d> points;
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (alive_[v] && !around_[v].empty()) {
        out.new_vertex[v] = static_cast<int>(points.size());
        points.push_back(points_[v]);
      }
    out.mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v) out.mesh.positions.row(v) = points[v].cast<float>();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      FaceGroup group = groups[g];
      group.face_begin = static_cast<int>(out.mesh.faces.size());
      for (std::size_t t = 0; t < triangles_.size(); ++t)
        if (triangles_[t][0] >= 0 && group_[t] == static_cast<int>(g))
          out.mesh.faces.push_back({out.new_vertex[triangles_[t][0]], out.new_vertex[triangles_[t][1]],
                                    out.new_vertex[triangles_[t][2]]});
      group.face_end = static_cast<int>(out.mesh.faces.size());
      group.vertex_end = static_cast<int>(points.size());
      out.mesh.groups.push_back(group);
    }
    return out;
  }

 private:
  void add(const Triangle& t, int group) {
    for (int v : t) around_[v].insert(static_cast<int>(triangles_.size()));
    triangles_.push_back(t);
    group_.push_back(group);
  }
  Vector3d area_vector(const Triangle& t) const {
    return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
  }
  std::set<int> neighbours(int v) const {
    std::set<int> ring;
    for (int t : around_[v])
      for (int w : triangles_[t])
        if (w != v) ring.insert(w);
    return ring;
  }
  bool on_border(int v) const { return neighbours(v).size() != around_[v].size(); }
  /// Kept vertices, borders and the lines between groups stay.
  bool fixed(int v) const {
    if (kept_[v] || on_border(v)) return true;
    for (int t : around_[v])
      if (group_[t] != group_[*around_[v].begin()]) return true;
    return false;
  }

  bool merge(int stays, int goes) {
    const std::set<int> a = neighbours(stays), b = neighbours(goes);
    std::vector<int> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (common.size() != 2 || a.size() + b.size() > 14) return false;
    for (int v : common)
      if (around_[v].size() < 5) return false;
    for (int t : around_[goes]) {
      Triangle after = triangles_[t];
      if (std::count(after.begin(), after.end(), stays)) continue;
      std::replace(after.begin(), after.end(), goes, stays);
      const Vector3d before = area_vector(triangles_[t]), now = area_vector(after);
      if (now.dot(before) < 0.5 * now.norm() * before.norm() || now.norm() < 1e-4) return false;
      for (int c = 0; c < 3; ++c)
        if ((points_[after[c]] - points_[after[(c + 1) % 3]]).norm() > 1.5 * wanted_[stays]) return false;
    }
    for (int t : std::vector<int>(around_[goes].begin(), around_[goes].end())) {
      Triangle& triangle = triangles_[t];
      if (std::count(triangle.begin(), triangle.end(), stays)) {
        for (int v : triangle) around_[v].erase(t);
        triangle = {-1, -1, -1};
      } else {
        std::replace(triangle.begin(), triangle.end(), goes, stays);
        around_[stays].insert(t);
      }
    }
    around_[goes].clear();
    alive_[goes] = 0;
    return true;
  }

  /// Turns the edge from corner c of triangle t to the next, if that brings its four vertices closer to six
  /// neighbours.
  void turn(int t, int c) {
    const int a = triangles_[t][c], b = triangles_[t][(c + 1) % 3], left = triangles_[t][(c + 2) % 3];
    int other = -1;
    for (int s : around_[a])
      if (s != t && around_[b].count(s)) other = s;
    if (other < 0 || group_[other] != group_[t]) return;
    int right = -1;
    for (int v : triangles_[other])
      if (v != a && v != b) right = v;
    if (neighbours(left).count(right) || on_border(a) || on_border(b)) return;
    const auto excess = [&](int v, int change) {
      const int d = static_cast<int>(around_[v].size()) + change - 6;
      return d * d;
    };
    const int before = excess(a, 0) + excess(b, 0) + excess(left, 0) + excess(right, 0);
    const int after = excess(a, -1) + excess(b, -1) + excess(left, 1) + excess(right, 1);
    if (after >= before || around_[a].size() < 5 || around_[b].size() < 5) return;
    const Triangle one = {a, right, left}, two = {right, b, left};
    const Vector3d flat = (area_vector(triangles_[t]) + area_vector(triangles_[other])).normalized();
    for (const Triangle& triangle : {one, two}) {
      const Vector3d n = area_vector(triangle);
      if (n.dot(flat) < 0.8 * n.norm() || n.norm() < 1e-4) return;
    }
    for (int v : triangles_[t]) around_[v].erase(t);
    for (int v : triangles_[other]) around_[v].erase(other);
    triangles_[t] = one;
    triangles_[other] = two;
    for (int v : one) around_[v].insert(t);
    for (int v : two) around_[v].insert(other);
  }

  std::vector<Vector3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<int> group_;
  const std::vector<char>& kept_;
  const std::vector<double>& wanted_;
  std::vector<std::set<int>> around_;  ///< per vertex, its triangles
  std::vector<char> alive_;
};

}  // namespace

Remeshed remesh(const Mesh& mesh, const std::vector<char>& kept, const std::vector<double>& wanted) {
  Remesher remesher(mesh, kept, wanted);
  for (int round = 0; round < 4; ++round) {
    remesher.merge_short_edges();
    remesher.turn_edges();
    remesher.slide();
  }
  return remesher.finish(mesh.groups);
}

}  // namespace mien::sample
