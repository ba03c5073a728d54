#include "mien/transfer/shared_uvs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "mien/core/parallel.h"
#include "mien/geometry/surface_query.h"
#include "mien/geometry/triangle.h"
#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

/// A question goes this share of the way to its triangle's middle, so that charts that touch are told apart.
constexpr double inward = 1e-4;
/// Triangles that are asked whether another one covers them; more of them than this share: the layout lies on itself.
constexpr std::size_t most_asked = 2000;
constexpr double most_covered = 0.02, most_apart = 1e-3;
/// Of a layout's diagonal: vertices of a fine level at its edge may be missing on a coarse one.
constexpr double most_box_apart = 0.05;

Eigen::Vector3d lift(const Eigen::Vector2d& uv) {
  return {uv.x(), uv.y(), 0};
}

/// A layout's charts, to be asked for the place of a UV.
class Charts {
 public:
  explicit Charts(const UvLayout& layout) : layout_(layout), query_(built(layout, rows_)) {}

  /// The charts' place closest to `uv`, on the side that `towards` lies on. `distance` is in the image.
  SourcePoint place(const Eigen::Vector2d& uv, const Eigen::Vector2d& towards) const {
    const auto hit = query_.closest(lift(uv + inward * (towards - uv)));
    const int t = rows_[at(hit.triangle)];
    const auto& corners = layout_.uvs[at(t)];
    const auto exact =
        closest_point_on_triangle(lift(uv), lift(corners[0]), lift(corners[1]), lift(corners[2]));
    return {t, exact.barycentric, (exact.position - lift(uv)).norm(), false};
  }

  /// From `uv` to the nearest corner of triangle `t`.
  double from_vertex(const Eigen::Vector2d& uv, int t) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& corner : layout_.uvs[at(t)])
      nearest = std::min(nearest, (corner - uv).norm());
    return nearest;
  }

  /// Whether parts of the layout lie on others.
  bool lies_on_itself() const {
    const std::size_t asked = std::min(most_asked, rows_.size());
    std::size_t covered = 0;
    for (std::size_t i = 0; i < asked; ++i) {
      const int own = static_cast<int>(i * rows_.size() / asked);
      const auto& uvs = layout_.uvs[at(rows_[at(own)])];
      const auto hit = query_.closest(lift((uvs[0] + uvs[1] + uvs[2]) / 3), most_apart,
                                      [own](int t, const Eigen::Vector3d&) { return t != own; });
      covered += hit.distance <= std::numeric_limits<double>::epsilon();
    }
    return static_cast<double>(covered) > most_covered * static_cast<double>(asked);
  }

 private:
  /// Three points of its own a triangle that has UVs; `rows` says which triangle each is.
  static SurfaceQuery built(const UvLayout& layout, std::vector<int>& rows) {
    for (std::size_t t = 0; t < layout.uvs.size(); ++t)
      if (layout.has_uv[t]) rows.push_back(static_cast<int>(t));
    PointsD corners(3 * static_cast<Eigen::Index>(rows.size()), 3);
    Triangles triangles(static_cast<Eigen::Index>(rows.size()), 3);
    for (Eigen::Index r = 0; r < triangles.rows(); ++r)
      for (int k = 0; k < 3; ++k) {
        triangles(r, k) = static_cast<int>(3 * r) + k;
        corners.row(3 * r + k) = lift(layout.uvs[at(rows[static_cast<std::size_t>(r)])][at(k)]).transpose();
      }
    return {corners, triangles};
  }

  const UvLayout& layout_;
  std::vector<int> rows_;
  SurfaceQuery query_;
};

/// Per vertex its corners, as triangle and corner.
std::vector<std::vector<std::pair<int, int>>> corners_of(const UvLayout& layout, std::size_t vertices) {
  std::vector<std::vector<std::pair<int, int>>> corners(vertices);
  for (int t = 0; t < static_cast<int>(layout.uvs.size()); ++t)
    for (int k = 0; k < 3 && layout.has_uv[at(t)]; ++k)
      corners[at(layout.triangles(t, k))].emplace_back(t, k);
  return corners;
}

/// What the vertices of one side find on the other's charts.
struct Places {
  std::vector<SourcePoint> points;  // #V; accepted within the tolerance
  double on_charts = 0;             // share of them
  double on_vertices = 0;           // share of those that are vertices there too
};

/// On a seam one side is as good as the other.
Places find_places(const UvLayout& asking, std::size_t vertices, const Charts& charts,
                   const SharedUvsOptions& options) {
  const auto corners = corners_of(asking, vertices);
  Places places;
  std::vector<SourcePoint>& points = places.points;
  points.resize(vertices);
  std::vector<char> on_vertex(vertices, 0);
  parallel_for(vertices, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      for (const auto& [t, k] : corners[v]) {
        const auto& uvs = asking.uvs[at(t)];
        SourcePoint place = charts.place(uvs[at(k)], (uvs[0] + uvs[1] + uvs[2]) / 3);
        if (place.distance > options.tolerance) continue;
        on_vertex[v] = charts.from_vertex(uvs[at(k)], place.triangle) <= options.same_vertex;
        place.distance = 0;
        place.accepted = true;
        points[v] = place;
        break;
      }
  });
  const auto share = [&](auto count) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(vertices, 1));
  };
  places.on_charts =
      share(std::count_if(points.begin(), points.end(), [](const SourcePoint& p) { return p.accepted; }));
  places.on_vertices = share(std::count(on_vertex.begin(), on_vertex.end(), 1));
  return places;
}

Eigen::AlignedBox2d box_of(const UvLayout& layout) {
  Eigen::AlignedBox2d box;
  for (std::size_t t = 0; t < layout.uvs.size(); ++t)
    for (std::size_t k = 0; k < 3 && layout.has_uv[t]; ++k) box.extend(layout.uvs[t][k]);
  return box;
}

/// What layouts that are shared surely are: in the same place of the image.
bool may_be_shared(const UvLayout& one, const UvLayout& other) {
  const Eigen::AlignedBox2d a = box_of(one), b = box_of(other);
  if (a.isEmpty() || b.isEmpty()) return false;
  const double apart = (a.min() - b.min()).cwiseAbs().maxCoeff() + (a.max() - b.max()).cwiseAbs().maxCoeff();
  return apart <= most_box_apart * std::max(a.diagonal().norm(), b.diagonal().norm());
}

}  // namespace

std::optional<SharedUvs> find_shared_uvs(const UvLayout& source, const UvLayout& target,
                                         const PointsD& target_positions, const PointsD& expected,
                                         double reach, const SharedUvsOptions& options) {
  if (!may_be_shared(source, target)) return std::nullopt;
  const Charts source_charts(source), target_charts(target);
  if (source_charts.lies_on_itself() || target_charts.lies_on_itself()) return std::nullopt;
  const Places ahead =
      find_places(target, static_cast<std::size_t>(target_positions.rows()), source_charts, options);
  const Places back = find_places(source, static_cast<std::size_t>(expected.rows()), target_charts, options);
  if (ahead.on_charts < options.least_target || back.on_charts < options.least_source ||
      std::max(ahead.on_vertices, back.on_vertices) < options.least_vertices)
    return std::nullopt;

  SharedUvs shared;
  shared.points = ahead.points;
  shared.guide = expected;
  std::vector<double> off;
  for (std::size_t v = 0; v < back.points.size(); ++v) {
    const SourcePoint& point = back.points[v];
    shared.known.push_back(point.accepted);
    if (!point.accepted) continue;
    Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 3; ++k)
      place += point.barycentric[k] * target_positions.row(target.triangles(point.triangle, k));
    const auto row = static_cast<Eigen::Index>(v);
    off.push_back((place - expected.row(row)).norm());
    shared.guide.row(row) = place;
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  if (*middle > reach) return std::nullopt;
  return shared;
}

}  // namespace mien
