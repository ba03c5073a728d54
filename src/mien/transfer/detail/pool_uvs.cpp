#include "mien/transfer/detail/pool_uvs.h"

#include "mien/transfer/detail/at.h"

namespace mien::detail {

std::optional<UvLayout> uv_layout(const Character& character, const Pool& pool, const PoolSurface& surface) {
  UvLayout result;
  result.triangles = surface.surface.triangles;
  bool any = false;
  int last_part = -1, last_face = -1, fan = 0;
  std::vector<int> fan_of(pool.triangle_face.size());
  for (std::size_t t = 0; t < pool.triangle_face.size(); ++t) {
    const bool same = pool.triangle_part[t] == last_part && pool.triangle_face[t] == last_face;
    fan = same ? fan + 1 : 0;
    fan_of[t] = fan;
    last_part = pool.triangle_part[t];
    last_face = pool.triangle_face[t];
  }
  for (const int t : surface.triangles) {
    const Mesh& mesh = character.parts[at(pool.triangle_part[at(t)])].mesh;
    std::array<Eigen::Vector2d, 3> uv{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                      Eigen::Vector2d::Zero()};
    bool has = !mesh.uvs.empty();
    const std::size_t face = at(pool.triangle_face[at(t)]);
    const std::array<int, 3> corner{0, fan_of[at(t)] + 1, fan_of[at(t)] + 2};
    for (std::size_t k = 0; k < 3 && has; ++k) {
      const UvSet& set = mesh.uvs.front();
      const int row = set.corners.empty() ? mesh.faces[face][at(corner[k])]
                                          : set.corners[at(mesh.faces.offset(face) + corner[k])];
      has = row >= 0;
      if (has) uv[k] = set.coordinates.row(row).transpose().cast<double>();
    }
    result.uvs.push_back(uv);
    result.has_uv.push_back(has);
    any = any || has;
  }
  if (!any) return std::nullopt;
  return result;
}

}  // namespace mien::detail
