#pragma once
/// All parts of a character as one welded surface in model space, and what each piece of it is.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/landmark_points.h"
#include "mien/geometry/surface_query.h"
#include "mien/transfer/register_surfaces.h"
#include "mien/transfer/twin.h"

namespace mien::detail {

/// Vertices of all parts, seams welded, in model space. Pooled vertices are numbered part after part.
struct Pool {
  PointsD positions;                     ///< #W x 3
  Triangles triangles;                   ///< #T x 3
  std::vector<int> triangle_face;        ///< #T: face of its part
  std::vector<int> triangle_part;        ///< #T
  std::vector<std::vector<int>> welded;  ///< per part, per vertex: its pooled number
  std::vector<int> piece;                ///< #W: connected piece
  int piece_count = 0;
  std::vector<int> piece_part;  ///< per piece: the part it belongs to
  std::vector<std::string>
      piece_name;  ///< the part's name, or "part: group" where the part has several face groups
  std::vector<Eigen::Matrix4d> part_matrix;     ///< per part: part space to model space
  std::vector<std::pair<int, int>> first_copy;  ///< #W: (part, vertex) that stands for the pooled vertex
};

Pool pool(const Character& character);

/// The pooled vertices of one piece.
std::vector<int> vertices_of(const Pool& pool, int piece);

/// A choice of pieces as a surface of its own; row r is pooled vertex `vertices[r]`.
struct PoolSurface {
  Surface surface;
  std::vector<int> vertices;   ///< #V
  std::vector<int> row_of;     ///< #W: row in the surface, -1: not in it
  std::vector<int> triangles;  ///< #T of the surface: triangle of the pool
};
PoolSurface select_pieces(const Pool& pool, const std::vector<char>& pieces);
PoolSurface one_piece(const Pool& pool, int piece);

/// The point at one corner mix of one triangle of `surface`, as its file numbers it.
SurfacePoint surface_point(const Pool& pool, const PoolSurface& surface, const SurfaceQuery::Hit& hit);

/// The twin of two pools as the twin of two of their surfaces: what lies on a piece that is not in `source` is not accepted.
///   triangles  of the source's pool
Twin twin_of_surfaces(const Twin& twin, const PoolSurface& source, const PoolSurface& target,
                      Eigen::Index triangles);

/// The pieces that are the face's skin: those that hold landmarks (a stray landmark or two on a tooth or lash does not
/// make it skin).
std::vector<char> skin_pieces(const Pool& pool, const Character& character,
                              const std::vector<LandmarkPoint>& landmarks);

}  // namespace mien::detail
