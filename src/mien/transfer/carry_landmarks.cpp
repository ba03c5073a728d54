#include "mien/transfer/carry_landmarks.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "mien/character/landmark_points.h"
#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/pool_uvs.h"
#include "mien/transfer/shared_uvs.h"
#include "mien/transfer/twin.h"

namespace mien {
namespace {

using detail::at;
using detail::Pool;
using detail::PoolSurface;

/// How far the chords of a twin's triangles may cut below the source, of its box.
constexpr double chord_reach = 2e-3;

/// Where a point of the source lies on the target, model space to model space; nothing where that is not known.
using Way = std::function<std::optional<Eigen::Vector3d>(const Eigen::Vector3d&)>;

CarriedLandmarks carried(const Character& source, const Pool& from, const Pool& to,
                         const PoolSurface& on_target, const Way& way) {
  const SurfaceQuery query(on_target.surface.positions, on_target.surface.triangles);
  const auto place = [&](const SurfacePoint& point) -> std::optional<SurfacePoint> {
    const Mesh& mesh = source.parts[at(point.part)].mesh;
    const Eigen::Vector3d local = position_of(mesh, mesh.positions, point);
    const Eigen::Vector3d model = (from.part_matrix[at(point.part)] * local.homogeneous()).head<3>();
    const std::optional<Eigen::Vector3d> there = way(model);
    if (!there) return std::nullopt;
    return detail::surface_point(to, on_target, query.closest(*there));
  };
  CarriedLandmarks result;
  for (const Landmark& landmark : source.landmarks)
    if (const auto there = place(landmark.at)) result.landmarks.push_back({landmark.name, *there});
  for (const LandmarkCurve& curve : source.curves) {
    LandmarkCurve own{curve.name, {}, curve.count};
    for (const SurfacePoint& point : curve.points)
      if (const auto there = place(point)) own.points.push_back(*there);
    if (own.points.size() == curve.points.size()) result.curves.push_back(std::move(own));
  }
  return result;
}

CarriedLandmarks carried_by_twin(const Character& source, const Pool& from, const Pool& to,
                                 const Twin& twin) {
  const PoolSurface all = detail::select_pieces(to, std::vector<char>(at(to.piece_count), 1));
  const SurfaceQuery query(all.surface.positions, all.surface.triangles);
  const double reach = chord_reach * bounding_box(all.surface.positions).diagonal();
  return carried(source, from, to, all, [&](const Eigen::Vector3d& point) -> std::optional<Eigen::Vector3d> {
    const Eigen::Vector3d there = twin.placement(point);
    if (query.closest(there, reach).triangle < 0) return std::nullopt;
    return there;
  });
}

/// The pieces by their numbers of vertices, the largest first.
std::vector<int> largest_first(const Pool& pool) {
  std::vector<int> count(at(pool.piece_count), 0), order(count.size());
  for (const int piece : pool.piece) ++count[at(piece)];
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = static_cast<int>(p);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return count[at(a)] > count[at(b)]; });
  return order;
}

std::optional<CarriedLandmarks> carried_by_uvs(const Character& source, const Character& target,
                                               const Pool& from, const Pool& to) {
  const PoolSurface skin =
      detail::select_pieces(from, detail::skin_pieces(from, source, landmark_points(source)));
  const auto uvs = detail::uv_layout(source, from, skin);
  if (!uvs) return std::nullopt;
  const SurfaceQuery query(skin.surface.positions, skin.surface.triangles);
  for (const int piece : largest_first(to)) {
    const PoolSurface there = detail::one_piece(to, piece);
    const auto own = detail::uv_layout(target, to, there);
    if (!own) continue;
    const auto shared = find_shared_uvs(*uvs, *own, there.surface.positions, skin.surface.positions,
                                        std::numeric_limits<double>::infinity());
    if (!shared) continue;
    return carried(source, from, to, there, [&](const Eigen::Vector3d& point) {
      const auto hit = query.closest(point);
      Eigen::Vector3d moved = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        moved += hit.barycentric[k] * shared->guide.row(skin.surface.triangles(hit.triangle, k)).transpose();
      return moved;
    });
  }
  return std::nullopt;
}

}  // namespace

std::optional<CarriedLandmarks> carry_landmarks(const Character& source, const Character& target,
                                                bool by_uvs) {
  const Pool from = detail::pool(source), to = detail::pool(target);
  const auto twin = find_twin({from.positions, from.triangles}, {to.positions, to.triangles}, {Similarity{}});
  if (twin) {
    CarriedLandmarks result = carried_by_twin(source, from, to, *twin);
    // Faces with the same eyes and teeth are one surface there alone.
    if (4 * result.landmarks.size() >= 3 * source.landmarks.size()) return result;
  }
  return by_uvs ? carried_by_uvs(source, target, from, to) : std::nullopt;
}

}  // namespace mien
