#include "mien/transfer/detail/feature_curves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "mien/geometry/laplacian.h"

namespace mien::detail {
namespace {

constexpr std::array<double, 3> levels{0.3, 0.5, 0.7};
constexpr int border_level = static_cast<int>(levels.size());
constexpr std::size_t cavities = 3;
/// What a difference of normals counts as, in face sizes.
constexpr double normal_length = 0.03;

/// Connected regions of vertices below `level`: a label a vertex, -1 above.
std::vector<int> regions_below(const Surface& surface, const Eigen::VectorXd& openness, double level) {
  Triangles inside(surface.triangles.rows(), 3);
  Eigen::Index count = 0;
  // Edges between two low vertices join; a triangle with one low vertex joins nothing.
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    std::vector<int> low;
    for (int k = 0; k < 3; ++k)
      if (openness[surface.triangles(t, k)] < level) low.push_back(surface.triangles(t, k));
    if (low.size() >= 2) inside.row(count++) << low[0], low[1], low.back();
  }
  std::vector<int> label =
      connected_components(static_cast<std::size_t>(openness.size()), inside.topRows(count));
  for (Eigen::Index v = 0; v < openness.size(); ++v)
    if (openness[v] >= level) label[static_cast<std::size_t>(v)] = -1;
  return label;
}

/// One vertex of each of the largest regions below the lowest level, by area.
std::vector<int> cavity_seeds(const Surface& surface, const Eigen::VectorXd& openness) {
  const std::vector<int> label = regions_below(surface, openness, levels[0]);
  const Eigen::VectorXd areas = vertex_areas(surface.positions, surface.triangles);
  std::vector<double> size(label.size(), 0);
  std::vector<int> seed(label.size(), -1);
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] < 0) continue;
    size[static_cast<std::size_t>(label[v])] += areas[static_cast<Eigen::Index>(v)];
    if (seed[static_cast<std::size_t>(label[v])] < 0)
      seed[static_cast<std::size_t>(label[v])] = static_cast<int>(v);
  }
  std::vector<int> order(label.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)];
  });
  std::vector<int> seeds;
  for (std::size_t i = 0; i < order.size() && seeds.size() < cavities; ++i)
    if (seed[static_cast<std::size_t>(order[i])] >= 0)
      seeds.push_back(seed[static_cast<std::size_t>(order[i])]);
  return seeds;
}

/// The level's crossing of one triangle, if it has one.
bool cross(const Eigen::Vector3d& open, double level, CurvePiece& piece) {
  int ends = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if ((open[k] < level) == (open[next] < level)) continue;
    const double t = (level - open[k]) / (open[next] - open[k]);
    std::array<double, 3>& end = ends++ == 0 ? piece.from : piece.to;
    end = {0, 0, 0};
    end[static_cast<std::size_t>(k)] = 1 - t;
    end[static_cast<std::size_t>(next)] = t;
  }
  return ends == 2;
}

/// The edges with one triangle, of connected borders that are long enough.
std::vector<CurvePiece> long_borders(const Surface& surface, double least_border) {
  const std::vector<char> boundary =
      boundary_vertices(static_cast<std::size_t>(surface.positions.rows()), surface.triangles);
  std::map<std::pair<int, int>, int> uses;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = surface.triangles(t, k), b = surface.triangles(t, (k + 1) % 3);
      if (boundary[static_cast<std::size_t>(a)] && boundary[static_cast<std::size_t>(b)])
        ++uses[{std::min(a, b), std::max(a, b)}];
    }
  std::vector<CurvePiece> pieces;
  Triangles edges(static_cast<Eigen::Index>(uses.size()), 3);
  Eigen::Index count = 0;
  for (const auto& [edge, triangles] : uses) {
    if (triangles != 1) continue;
    edges.row(count++) << edge.first, edge.second, edge.second;
    pieces.push_back({{edge.first, edge.second, edge.second}, {1, 0, 0}, {0, 1, 0}, border_level});
  }
  const std::vector<int> label = connected_components(boundary.size(), edges.topRows(count));
  std::map<int, double> length;
  const auto edge_length = [&](const CurvePiece& piece) {
    return (surface.positions.row(piece.vertices[0]) - surface.positions.row(piece.vertices[1])).norm();
  };
  const auto loop = [&](const CurvePiece& piece) {
    return label[static_cast<std::size_t>(piece.vertices[0])];
  };
  for (const CurvePiece& piece : pieces) length[loop(piece)] += edge_length(piece);
  std::erase_if(pieces, [&](const CurvePiece& piece) { return length[loop(piece)] < least_border; });
  return pieces;
}

/// A piece on a posed surface.
struct PosedPiece {
  Eigen::Vector3d middle, tangent, normal;
  double length = 0;
};

std::vector<PosedPiece> pose(const std::vector<CurvePiece>& pieces, const Surface& surface,
                             const PointsD& normals) {
  std::vector<PosedPiece> posed;
  for (const CurvePiece& piece : pieces) {
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = from, normal = from;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d corner = surface.positions.row(piece.vertices[k]).transpose();
      from += piece.from[k] * corner;
      to += piece.to[k] * corner;
      normal += (piece.from[k] + piece.to[k]) / 2 * normals.row(piece.vertices[k]).transpose();
    }
    const double length = (to - from).norm();
    posed.push_back({(from + to) / 2,
                     length > 0 ? Eigen::Vector3d((to - from) / length) : Eigen::Vector3d::UnitX(),
                     normal.normalized(), length});
  }
  return posed;
}

struct Match {
  int other = -1;
  double distance = 0;
};

std::vector<Match> nearest(const std::vector<PosedPiece>& from, const std::vector<CurvePiece>& from_pieces,
                           const std::vector<PosedPiece>& to, const std::vector<CurvePiece>& to_pieces,
                           int level) {
  std::vector<Match> matches(from.size());
  std::vector<double> distances;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from_pieces[i].level != level) continue;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < to.size(); ++j) {
      if (to_pieces[j].level != level) continue;
      const double d = (from[i].middle - to[j].middle).squaredNorm() +
                       normal_length * normal_length * (from[i].normal - to[j].normal).squaredNorm();
      if (d >= best) continue;
      best = d;
      matches[i] = {static_cast<int>(j), (from[i].middle - to[j].middle).norm()};
    }
    if (matches[i].other >= 0) distances.push_back(matches[i].distance);
  }
  if (distances.empty()) return matches;
  std::nth_element(distances.begin(), distances.begin() + static_cast<long>(distances.size() / 2),
                   distances.end());
  const double limit = std::min(0.05, std::max(0.015, 3 * distances[distances.size() / 2]));
  for (Match& match : matches)
    if (match.distance > limit) match.other = -1;
  return matches;
}

Wish wish_for(const CurvePiece& moving, const Eigen::Vector3d& goal, const Eigen::Vector3d& tangent,
              double weight) {
  Wish wish;
  for (std::size_t k = 0; k < 3; ++k) {
    wish.vertices[k] = moving.vertices[k];
    wish.weights[k] = (moving.from[k] + moving.to[k]) / 2;
  }
  wish.goal = goal;
  wish.axis = tangent;
  wish.along = 0.1 * weight;
  wish.across = weight;
  return wish;
}

}  // namespace

std::vector<CurvePiece> feature_curves(const Surface& surface, const Eigen::VectorXd& openness,
                                       double least_border) {
  std::vector<CurvePiece> pieces = long_borders(surface, least_border);
  const std::vector<int> seeds = cavity_seeds(surface, openness);
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const std::vector<int> label = regions_below(surface, openness, levels[l]);
    for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
      CurvePiece piece;
      Eigen::Vector3d open;
      bool around_cavity = false;
      for (int k = 0; k < 3; ++k) {
        const int v = surface.triangles(t, k);
        piece.vertices[static_cast<std::size_t>(k)] = v;
        open[k] = openness[v];
        for (const int seed : seeds)
          around_cavity =
              around_cavity || (label[static_cast<std::size_t>(v)] >= 0 &&
                                label[static_cast<std::size_t>(v)] == label[static_cast<std::size_t>(seed)]);
      }
      piece.level = static_cast<int>(l);
      if (around_cavity && cross(open, levels[l], piece)) pieces.push_back(piece);
    }
  }
  return pieces;
}

std::vector<Wish> match_curves(const std::vector<CurvePiece>& moving, const Surface& moving_surface,
                               const std::vector<CurvePiece>& fixed, const Surface& fixed_surface,
                               double weight) {
  std::vector<Wish> wishes;
  const auto posed_moving =
      pose(moving, moving_surface, vertex_normals(moving_surface.positions, moving_surface.triangles));
  const auto posed_fixed =
      pose(fixed, fixed_surface, vertex_normals(fixed_surface.positions, fixed_surface.triangles));
  for (int level = 0; level <= border_level; ++level) {
    double moving_length = 0, fixed_length = 0;
    for (std::size_t i = 0; i < moving.size(); ++i)
      if (moving[i].level == level) moving_length += posed_moving[i].length;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i].level == level) fixed_length += posed_fixed[i].length;
    if (!(moving_length > 0) || !(fixed_length > 0)) continue;
    const auto forward = nearest(posed_moving, moving, posed_fixed, fixed, level);
    for (std::size_t i = 0; i < forward.size(); ++i)
      if (forward[i].other >= 0) {
        const PosedPiece& to = posed_fixed[static_cast<std::size_t>(forward[i].other)];
        wishes.push_back(
            wish_for(moving[i], to.middle, to.tangent, weight * posed_moving[i].length / moving_length));
      }
    const auto backward = nearest(posed_fixed, fixed, posed_moving, moving, level);
    for (std::size_t i = 0; i < backward.size(); ++i)
      if (backward[i].other >= 0)
        wishes.push_back(wish_for(moving[static_cast<std::size_t>(backward[i].other)], posed_fixed[i].middle,
                                  posed_fixed[i].tangent, weight * posed_fixed[i].length / fixed_length));
  }
  return wishes;
}

}  // namespace mien::detail
