#include "mien/transfer/detail/pool.h"

#include <algorithm>

#include "mien/character/weld.h"
#include "mien/geometry/laplacian.h"

namespace mien::detail {
namespace {

/// The part's name, and behind it the name of the group that holds face `face` where there are several.
std::string name_of_piece(const Part& part, int face) {
  for (const FaceGroup& group : part.mesh.groups)
    if (part.mesh.groups.size() > 1 && face >= group.face_begin && face < group.face_end &&
        !group.name.empty())
      return part.name + ": " + group.name;
  return part.name;
}

}  // namespace

Pool pool(const Character& character) {
  Pool result;
  const auto model = model_matrices(character);
  std::vector<Eigen::RowVector3d> positions;
  std::vector<Triangles> triangles;
  Eigen::Index triangle_count = 0;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Part& part = character.parts[p];
    const bool in_node = part.skin < 0 && part.node >= 0;
    const Eigen::Matrix4d matrix =
        in_node ? model[static_cast<std::size_t>(part.node)] : Eigen::Matrix4d(Eigen::Matrix4d::Identity());
    result.part_matrix.push_back(matrix);
    const Weld weld = weld_seams(character, static_cast<int>(p));
    const int first = static_cast<int>(positions.size());
    std::vector<int> numbers(weld.of.size());
    for (std::size_t v = 0; v < numbers.size(); ++v) numbers[v] = first + weld.of[v];
    for (const int v : weld.representative) {
      const Eigen::Vector3d local = part.mesh.positions.row(v).transpose().cast<double>();
      positions.push_back((matrix * local.homogeneous()).head<3>().transpose());
      result.first_copy.emplace_back(static_cast<int>(p), v);
    }
    triangles.push_back(triangulate(part.mesh.faces));
    for (Eigen::Index t = 0; t < triangles.back().rows(); ++t)
      for (int k = 0; k < 3; ++k)
        triangles.back()(t, k) = numbers[static_cast<std::size_t>(triangles.back()(t, k))];
    triangle_count += triangles.back().rows();
    const std::vector<int> faces = face_of_triangle(part.mesh.faces);
    result.triangle_face.insert(result.triangle_face.end(), faces.begin(), faces.end());
    result.triangle_part.insert(result.triangle_part.end(), faces.size(), static_cast<int>(p));
    result.welded.push_back(std::move(numbers));
  }
  result.positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v)
    result.positions.row(static_cast<Eigen::Index>(v)) = positions[v];
  result.triangles.resize(triangle_count, 3);
  Eigen::Index row = 0;
  for (const Triangles& t : triangles) {
    result.triangles.middleRows(row, t.rows()) = t;
    row += t.rows();
  }
  result.piece = connected_components(positions.size(), result.triangles);
  for (const int p : result.piece) result.piece_count = std::max(result.piece_count, p + 1);
  result.piece_part.assign(static_cast<std::size_t>(result.piece_count), 0);
  result.piece_name.assign(static_cast<std::size_t>(result.piece_count), "");
  for (std::size_t v = 0; v < positions.size(); ++v)
    result.piece_part[static_cast<std::size_t>(result.piece[v])] = result.first_copy[v].first;
  for (Eigen::Index t = triangle_count - 1; t >= 0; --t) {
    const std::size_t piece =
        static_cast<std::size_t>(result.piece[static_cast<std::size_t>(result.triangles(t, 0))]);
    const std::size_t tri = static_cast<std::size_t>(t);
    result.piece_name[piece] = name_of_piece(
        character.parts[static_cast<std::size_t>(result.triangle_part[tri])], result.triangle_face[tri]);
  }
  return result;
}

std::vector<int> vertices_of(const Pool& pool, int piece) {
  std::vector<int> result;
  for (std::size_t v = 0; v < pool.piece.size(); ++v)
    if (pool.piece[v] == piece) result.push_back(static_cast<int>(v));
  return result;
}

PoolSurface select_pieces(const Pool& pool, const std::vector<char>& pieces) {
  PoolSurface result;
  result.row_of.assign(pool.piece.size(), -1);
  for (Eigen::Index t = 0; t < pool.triangles.rows(); ++t)
    if (pieces[static_cast<std::size_t>(pool.piece[static_cast<std::size_t>(pool.triangles(t, 0))])])
      result.triangles.push_back(static_cast<int>(t));
  for (const int t : result.triangles)
    for (int k = 0; k < 3; ++k) result.row_of[static_cast<std::size_t>(pool.triangles(t, k))] = 0;
  for (std::size_t v = 0; v < result.row_of.size(); ++v)
    if (result.row_of[v] == 0) {
      result.row_of[v] = static_cast<int>(result.vertices.size());
      result.vertices.push_back(static_cast<int>(v));
    }
  result.surface.positions.resize(static_cast<Eigen::Index>(result.vertices.size()), 3);
  for (std::size_t r = 0; r < result.vertices.size(); ++r)
    result.surface.positions.row(static_cast<Eigen::Index>(r)) = pool.positions.row(result.vertices[r]);
  result.surface.triangles.resize(static_cast<Eigen::Index>(result.triangles.size()), 3);
  for (std::size_t t = 0; t < result.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      result.surface.triangles(static_cast<Eigen::Index>(t), k) =
          result.row_of[static_cast<std::size_t>(pool.triangles(result.triangles[t], k))];
  return result;
}

PoolSurface one_piece(const Pool& pool, int piece) {
  std::vector<char> pieces(static_cast<std::size_t>(pool.piece_count), 0);
  pieces[static_cast<std::size_t>(piece)] = 1;
  return select_pieces(pool, pieces);
}

SurfacePoint surface_point(const Pool& pool, const PoolSurface& surface, const SurfaceQuery::Hit& hit) {
  const auto at = [](int index) { return static_cast<std::size_t>(index); };
  const int triangle = surface.triangles[at(hit.triangle)];
  SurfacePoint point;
  point.part = pool.triangle_part[at(triangle)];
  point.face = pool.triangle_face[at(triangle)];
  point.barycentric = hit.barycentric;
  // Triangles of a face are a fan in order: this one's number within it.
  int fan = 0;
  for (int t = triangle;
       t > 0 && pool.triangle_face[at(t - 1)] == point.face && pool.triangle_part[at(t - 1)] == point.part;
       --t)
    ++fan;
  point.corners = {0, fan + 1, fan + 2};
  return point;
}

Twin twin_of_surfaces(const Twin& twin, const PoolSurface& source, const PoolSurface& target,
                      Eigen::Index triangles) {
  std::vector<int> row_of(static_cast<std::size_t>(triangles), -1);
  for (std::size_t t = 0; t < source.triangles.size(); ++t)
    row_of[static_cast<std::size_t>(source.triangles[t])] = static_cast<int>(t);
  Twin result;
  result.placement = twin.placement;
  std::size_t close = 0;
  for (const int vertex : target.vertices) {
    SourcePoint point = twin.points[static_cast<std::size_t>(vertex)];
    if (point.accepted) point.triangle = row_of[static_cast<std::size_t>(point.triangle)];
    point.accepted = point.accepted && point.triangle >= 0;
    close += point.accepted;
    result.points.push_back(point);
  }
  result.share =
      static_cast<double>(close) / static_cast<double>(std::max<std::size_t>(1, result.points.size()));
  return result;
}

std::vector<char> skin_pieces(const Pool& pool, const Character& character,
                              const std::vector<LandmarkPoint>& landmarks) {
  std::vector<int> count(static_cast<std::size_t>(pool.piece_count), 0);
  for (const LandmarkPoint& landmark : landmarks) {
    const SurfacePoint& at = landmark.at;
    const Mesh& mesh = character.parts[static_cast<std::size_t>(at.part)].mesh;
    const int vertex =
        at.face >= 0 ? mesh.faces[static_cast<std::size_t>(at.face)][at.corners[0]] : at.vertex;
    const int pooled = pool.welded[static_cast<std::size_t>(at.part)][static_cast<std::size_t>(vertex)];
    ++count[static_cast<std::size_t>(pool.piece[static_cast<std::size_t>(pooled)])];
  }
  const int most = *std::max_element(count.begin(), count.end());
  std::vector<char> skin(count.size());
  for (std::size_t p = 0; p < count.size(); ++p)
    skin[p] = count[p] > 0 && (count[p] == most || count[p] >= 0.15 * landmarks.size());
  return skin;
}

}  // namespace mien::detail
