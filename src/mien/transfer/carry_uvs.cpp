#include "mien/transfer/carry_uvs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mien/core/parallel.h"
#include "mien/geometry/surface_query.h"
#include "mien/geometry/triangle.h"
#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

Eigen::Vector3d point_at(const PointsD& points, int r) {
  return points.row(r).transpose();
}

/// A corner looks at no more triangles than this around its face's centre.
constexpr std::size_t most_triangles = 400;

class CornerFinder {
 public:
  CornerFinder(const UvLayout& layout, const PointsD& guide)
      : layout_(layout), guide_(guide), neighbours_(chart_neighbours(layout)) {
    middles_.resize(layout.uvs.size());
    for (int t = 0; t < static_cast<int>(layout.uvs.size()); ++t)
      middles_[at(t)] = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
  }

  /// Triangles of the chart around `start`, nearest rings first, no further than `reach` from `centre`.
  std::vector<int> around(int start, const Eigen::Vector3d& centre, double reach) const {
    std::vector<int> found{start};
    for (std::size_t i = 0; i < found.size() && found.size() < most_triangles; ++i)
      for (const int next : neighbours_[at(found[i])]) {
        if (next < 0 || std::find(found.begin(), found.end(), next) != found.end()) continue;
        const double size = (corner(next, 1) - corner(next, 0)).norm();
        if ((middles_[at(next)] - centre).norm() <= reach + size) found.push_back(next);
      }
    return found;
  }

  Eigen::Vector2d uv_at(const Eigen::Vector3d& position, const std::vector<int>& candidates) const {
    int best = candidates.front();
    double distance = std::numeric_limits<double>::infinity();
    for (const int t : candidates) {
      if (is_further(t, position, distance)) continue;
      const auto found = closest_point_on_triangle(position, corner(t, 0), corner(t, 1), corner(t, 2));
      const double d = (found.position - position).squaredNorm();
      if (d < distance) {
        distance = d;
        best = t;
      }
    }
    Eigen::Vector3d weights =
        barycentric_on_plane(position, corner(best, 0), corner(best, 1), corner(best, 2));
    // Beyond the chart's edge the last triangle goes on, but not further than its own size.
    if (weights.minCoeff() < -1 || weights.maxCoeff() > 2)
      weights =
          closest_point_on_triangle(position, corner(best, 0), corner(best, 1), corner(best, 2)).barycentric;
    const auto& uv = layout_.uvs[at(best)];
    return weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2];
  }

 private:
  Eigen::Vector3d corner(int t, int k) const { return point_at(guide_, layout_.triangles(t, k)); }
  /// Whether no point of the triangle can be as near to `position`, by its middle and its reach from there.
  bool is_further(int t, const Eigen::Vector3d& position, double square) const {
    const Eigen::Vector3d& middle = middles_[at(t)];
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach = std::max(reach, (corner(t, k) - middle).squaredNorm());
    const double between = (position - middle).norm() - std::sqrt(reach);
    return between > 0 && between * between > square;
  }
  const UvLayout& layout_;
  const PointsD& guide_;
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<Eigen::Vector3d> middles_;
};

/// Per corner of all faces its UV; NaN where the guide has none.
std::vector<Eigen::Vector2d> corner_uvs(const UvLayout& source, const PointsD& guide,
                                        const PointsD& positions, const Faces& faces) {
  const CornerFinder finder(source, guide);
  const SurfaceQuery query(guide, source.triangles);
  std::vector<Eigen::Vector2d> uvs(faces.corner_count(), Eigen::Vector2d::Constant(std::nan("")));
  const auto facing = [&](const Eigen::Vector3d& normal) {
    return [&, normal](int t, const Eigen::Vector3d&) {
      const Eigen::Vector3d a = point_at(guide, source.triangles(t, 0));
      const Eigen::Vector3d b = point_at(guide, source.triangles(t, 1));
      const Eigen::Vector3d c = point_at(guide, source.triangles(t, 2));
      return (b - a).cross(c - a).dot(normal) > 0;
    };
  };
  const double reach_limit = 0.05 * bounding_box(positions).diagonal();
  parallel_for(faces.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = faces[f];
      if (face.size() < 3) continue;
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const int v : face) centre += point_at(positions, v) / static_cast<double>(face.size());
      double radius = 0;
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      for (std::size_t c = 0; c < face.size(); ++c) {
        const Eigen::Vector3d a = point_at(positions, face[c]) - centre;
        radius = std::max(radius, a.norm());
        normal += a.cross(point_at(positions, face[(c + 1) % face.size()]) - centre);
      }
      auto hit = query.closest(centre);
      const auto same_side = facing(normal);
      if (!same_side(hit.triangle, hit.position)) {
        const auto other = query.closest(centre, reach_limit, same_side);
        if (other.triangle >= 0) hit = other;
      }
      if (!source.has_uv[at(hit.triangle)]) continue;
      const auto candidates = finder.around(hit.triangle, hit.position, 1.05 * radius);
      for (std::size_t c = 0; c < face.size(); ++c)
        uvs[at(faces.offset(f)) + c] = finder.uv_at(point_at(positions, face[c]), candidates);
    }
  });
  return uvs;
}

}  // namespace

UvSet carry_uvs(const UvLayout& source, const PointsD& guide, const PointsD& positions, const Faces& faces) {
  const auto uvs = corner_uvs(source, guide, positions, faces);
  std::vector<std::vector<int>> rows_of(static_cast<std::size_t>(positions.rows()));
  std::vector<Eigen::Vector2d> rows;
  UvSet result;
  result.corners.assign(uvs.size(), -1);
  for (std::size_t c = 0; c < uvs.size(); ++c) {
    if (!uvs[c].allFinite()) continue;
    auto& known = rows_of[at(faces.corners()[c])];
    // Neighbouring faces of one chart find the same place up to rounding of the search.
    const auto same =
        std::find_if(known.begin(), known.end(), [&](int r) { return (rows[at(r)] - uvs[c]).norm() < 2e-3; });
    if (same != known.end()) {
      result.corners[c] = *same;
      continue;
    }
    known.push_back(static_cast<int>(rows.size()));
    result.corners[c] = known.back();
    rows.push_back(uvs[c]);
  }
  result.coordinates.resize(static_cast<Eigen::Index>(rows.size()), 2);
  for (std::size_t r = 0; r < rows.size(); ++r)
    result.coordinates.row(static_cast<Eigen::Index>(r)) = rows[r].transpose().cast<float>();
  return result;
}

}  // namespace mien
