#include "mien/transfer/detail/bake_places.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "mien/character/shown_parts.h"
#include "mien/character/weld.h"
#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/transfer/detail/at.h"

// A pixel asks for the closest point of the guide that faces its way, on those pieces of the source that the target's piece
// lies on: without the second, the lids would paint the eyes that touch them.

namespace mien::detail {
namespace {

Eigen::Vector3d flat_normal(const BakeSurface& surface, int t) {
  const Eigen::Vector3d a = surface.positions.row(surface.triangles(t, 0));
  const Eigen::Vector3d b = surface.positions.row(surface.triangles(t, 1));
  const Eigen::Vector3d c = surface.positions.row(surface.triangles(t, 2));
  return (b - a).cross(c - a);
}

std::vector<int> material_of_faces(const Mesh& mesh) {
  std::vector<int> material(mesh.faces.size(), -1);
  for (const FaceGroup& group : mesh.groups)
    for (int f = std::max(group.face_begin, 0);
         f < std::min(group.face_end, static_cast<int>(material.size())); ++f)
      material[at(f)] = group.material;
  return material;
}

/// A target's piece asks this many of its triangles where it lies.
constexpr std::size_t most_asked = 400;
/// A piece of the source belongs to one of the target when this share of them lies on it.
constexpr double least_share = 0.08;

}  // namespace

std::vector<Points> in_model_space(const Character& character) {
  const std::vector<Eigen::Matrix4d> model = model_matrices(character);
  std::vector<Points> result;
  for (const Part& part : character.parts) {
    const Eigen::Matrix4d matrix =
        part.node >= 0 && part.skin < 0 ? model[at(part.node)] : Eigen::Matrix4d(Eigen::Matrix4d::Identity());
    const PointsD local = part.mesh.positions.cast<double>();
    result.push_back(((local * matrix.topLeftCorner<3, 3>().transpose()).rowwise() +
                      matrix.topRightCorner<3, 1>().transpose())
                         .cast<float>());
  }
  return result;
}

BakeSurface bake_surface(const Character& character, const std::vector<Points>& positions) {
  BakeSurface surface;
  std::vector<Eigen::RowVector3d> rows;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<std::vector<int>> row_of(shown_part_count(character));
  for (std::size_t p = 0; p < row_of.size(); ++p) {
    const Mesh& mesh = character.parts[p].mesh;
    const Weld weld = weld_seams(character, static_cast<int>(p));
    const std::vector<int> material = material_of_faces(mesh);
    const int first = static_cast<int>(rows.size());
    for (const int v : weld.representative) rows.push_back(positions[p].row(v).cast<double>());
    for (const int row : weld.of) row_of[p].push_back(first + row);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (int c = 2; c < static_cast<int>(mesh.faces[f].size()); ++c) {
        const std::array<int, 3> corners{0, c - 1, c};
        Eigen::Vector3i triangle;
        for (int k = 0; k < 3; ++k) triangle[k] = row_of[p][at(mesh.faces[f][at(corners[at(k)])])];
        triangles.push_back(triangle);
        surface.part.push_back(static_cast<int>(p));
        surface.face.push_back(static_cast<int>(f));
        surface.material.push_back(material[f]);
        surface.corners.push_back(corners);
      }
  }
  surface.positions.resize(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t v = 0; v < rows.size(); ++v) surface.positions.row(static_cast<Eigen::Index>(v)) = rows[v];
  surface.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    surface.triangles.row(static_cast<Eigen::Index>(t)) = triangles[t];
  surface.normals = vertex_normals(surface.positions, surface.triangles);
  const std::vector<int> piece_of_vertex = connected_components(rows.size(), surface.triangles);
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    surface.piece.push_back(piece_of_vertex[at(surface.triangles(t, 0))]);
    surface.piece_count = std::max(surface.piece_count, surface.piece.back() + 1);
  }
  surface.skin.assign(at(surface.piece_count), 0);
  for (const Landmark& landmark : character.landmarks) {
    if (at(landmark.at.part) >= row_of.size()) continue;
    const Mesh& mesh = character.parts[at(landmark.at.part)].mesh;
    const int vertex = landmark.at.face < 0 ? landmark.at.vertex
                                            : mesh.faces[at(landmark.at.face)][at(landmark.at.corners[0])];
    const int piece = piece_of_vertex[at(row_of[at(landmark.at.part)][at(vertex)])];
    if (piece < surface.piece_count) surface.skin[at(piece)] = 1;
  }
  return surface;
}

/// Some pieces of the guide.
struct PlaceFinder::Part {
  std::vector<int> triangles;  ///< of the guide
  std::unique_ptr<SurfaceQuery> query;
};

PlaceFinder::PlaceFinder(const BakeSurface& guide, const BakeSurface& target)
    : guide_(guide), target_(target), part_of_piece_(at(target.piece_count), nullptr) {
  const Box box = bounding_box(target.positions);
  reach_ = 0.06 * box.diagonal();
  std::vector<std::vector<int>> triangles(at(target.piece_count));
  for (Eigen::Index t = 0; t < target.triangles.rows(); ++t)
    triangles[at(target.piece[at(t)])].push_back(static_cast<int>(t));
  const auto make = [&](const std::vector<char>& pieces) {
    std::unique_ptr<Part>& part = parts_[pieces];
    if (part) return part.get();
    part = std::make_unique<Part>();
    for (Eigen::Index t = 0; t < guide.triangles.rows(); ++t)
      if (pieces[at(guide.piece[at(t)])]) part->triangles.push_back(static_cast<int>(t));
    part->query = std::make_unique<SurfaceQuery>(guide.positions,
                                                 Triangles(guide.triangles(part->triangles, Eigen::all)));
    return part.get();
  };
  for (int piece = 0; piece < target.piece_count; ++piece) {
    const std::vector<char> alike = pieces_like(piece);
    if (triangles[at(piece)].empty() || std::find(alike.begin(), alike.end(), 1) == alike.end()) continue;
    part_of_piece_[at(piece)] = make(pieces_under(*make(alike), triangles[at(piece)]));
  }
}

PlaceFinder::~PlaceFinder() = default;

/// The guide's pieces of the same kind; all of them where one side has no landmarks to tell by.
std::vector<char> PlaceFinder::pieces_like(int target_piece) const {
  const auto knows = [](const std::vector<char>& skin) {
    return std::find(skin.begin(), skin.end(), 1) != skin.end();
  };
  std::vector<char> alike(at(guide_.piece_count), 1);
  if (knows(guide_.skin) && knows(target_.skin))
    for (std::size_t p = 0; p < alike.size(); ++p)
      alike[p] = guide_.skin[p] == target_.skin[at(target_piece)];
  return alike;
}

/// Those of the candidates that a piece of the target lies on.
std::vector<char> PlaceFinder::pieces_under(const Part& candidates, const std::vector<int>& triangles) const {
  std::vector<int> votes(at(guide_.piece_count), 0);
  const std::size_t step = std::max<std::size_t>(1, triangles.size() / most_asked);
  int asked = 0;
  for (std::size_t i = 0; i < triangles.size(); i += step) {
    const auto corners = target_.triangles.row(triangles[i]);
    const Eigen::Vector3d middle = (target_.positions.row(corners[0]) + target_.positions.row(corners[1]) +
                                    target_.positions.row(corners[2]))
                                       .transpose() /
                                   3;
    const Place place = find(candidates, middle, flat_normal(target_, triangles[i]));
    if (place.triangle < 0) continue;
    ++votes[at(guide_.piece[at(place.triangle)])];
    ++asked;
  }
  std::vector<char> pieces(votes.size(), 0);
  for (std::size_t p = 0; p < votes.size(); ++p) pieces[p] = votes[p] > least_share * asked;
  if (std::find(pieces.begin(), pieces.end(), 1) == pieces.end())
    for (const int t : candidates.triangles) pieces[at(guide_.piece[at(t)])] = 1;
  return pieces;
}

Place PlaceFinder::find(const Part& part, const Eigen::Vector3d& position,
                        const Eigen::Vector3d& normal) const {
  const auto faces_alike = [&](int t, const Eigen::Vector3d&) {
    return flat_normal(guide_, part.triangles[at(t)]).dot(normal) > 0;
  };
  SurfaceQuery::Hit hit = part.query->closest(position);
  bool facing = faces_alike(hit.triangle, hit.position);
  if (!facing) {
    const SurfaceQuery::Hit other = part.query->closest(position, reach_, faces_alike);
    facing = other.triangle >= 0;
    if (facing) hit = other;
  }
  return {part.triangles[at(hit.triangle)], hit.barycentric.cast<float>(), facing};
}

std::vector<Place> PlaceFinder::find(const TexelGrid& grid, const std::vector<int>& triangle_of) const {
  std::vector<Place> places(grid.triangle.size());
  parallel_for(places.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (grid.triangle[pixel] < 0) continue;
      const int t = triangle_of[at(grid.triangle[pixel])];
      const Part* part = part_of_piece_[at(target_.piece[at(t)])];
      if (!part) continue;
      Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        position += grid.barycentric[pixel][k] * target_.positions.row(target_.triangles(t, k)).transpose();
        normal += grid.barycentric[pixel][k] * target_.normals.row(target_.triangles(t, k)).transpose();
      }
      places[pixel] = find(*part, position, normal);
    }
  });
  return places;
}

}  // namespace mien::detail
