#pragma once
/// Where two faces share a UV layout their UVs say which place is which: the artist's own correspondence, exact where
/// closest points guess. So it is for characters of one base mesh, in any vertex order and triangulation, and for a
/// character's levels of detail.

#include <optional>
#include <vector>

#include "mien/transfer/correspondence.h"
#include "mien/transfer/uv_layout.h"

namespace mien {

struct SharedUvsOptions {
  /// Of the image's side: how far from the other layout's charts a UV may be and still lie on them.
  double tolerance = 1e-3;
  /// Shares of the vertices of target and source that have to lie on the other's charts.
  double least_target = 0.98, least_source = 0.9;
  /// Share of the vertices of one side that have to be vertices of the other in the image: two layouts that both fill the
  /// image cover each other by chance, and drawn alike they still are not the same; `same_vertex` of the image's side apart.
  double least_vertices = 0.9, same_vertex = 2e-4;
};

struct SharedUvs {
  /// #V target; accepted where the vertex's UV lies on the source's charts, without a triangle where it has none.
  std::vector<SourcePoint> points;
  std::vector<char> known;  ///< #V source: 1 where the vertex's UV lies on the target's charts
  PointsD guide;            ///< #V source: its place on the target where known, `expected` elsewhere
};

/// The correspondence by UVs, or nothing: where the layouts differ, where one lies on itself (mirrored halves, say: a UV
/// then names several places), and where half of the source's vertices end further than `reach` from where they
/// are expected.
///   target_positions  #V target x 3
///   expected          #V source x 3: roughly where its vertices lie on the target
///   cost              a closest point a vertex of either side
std::optional<SharedUvs> find_shared_uvs(const UvLayout& source, const UvLayout& target,
                                         const PointsD& target_positions, const PointsD& expected,
                                         double reach, const SharedUvsOptions& options = {});

}  // namespace mien
