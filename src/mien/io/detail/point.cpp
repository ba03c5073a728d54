#include "mien/io/detail/point.h"

#include <fmt/format.h>

#include <cmath>

#include "mien/core/error.h"

namespace mien::detail {

namespace {

/// The vertex of a control vertex (i, j) of a spline surface.
int read_control(const JsonObject& source, const Part& part) {
  if (!part.surface)
    throw io_error(source.place_of("control"), fmt::format("asks for a control vertex of part {}", part.name),
                   "name a part that is a spline surface, or give a vertex");
  const std::vector<double> at = source.numbers("control", 2);
  const int count_u = part.surface->count_u, count_v = part.surface->count_v;
  for (std::size_t k = 0; k < 2; ++k)
    if (at[k] != std::floor(at[k]) || at[k] < 0 || at[k] >= (k == 0 ? count_u : count_v))
      throw io_error(source.place_of("control"), fmt::format("is [{}, {}]", at[0], at[1]),
                     fmt::format("give [i, j] below [{}, {}]", count_u, count_v));
  return static_cast<int>(at[0]) + count_u * static_cast<int>(at[1]);
}

}  // namespace

SurfacePoint PointReader::read(const JsonObject& source) {
  source.expect_only({"part", "vertex", "face", "barycentric", "corners", "position", "control"});
  int part = -1;
  if (source.has("part")) {
    const std::string name = source.text("part");
    part = find_part(character_, name);
    if (part < 0)
      throw io_error(
          source.place_of("part"), fmt::format("is \"{}\", which the character does not have", name),
          fmt::format("its first part is \"{}\"", character_.parts.empty() ? "" : character_.parts[0].name));
  }
  if (character_.parts.empty())
    throw io_error(source.place(), "has no surface to be on", "give a character with parts");
  if (source.has("position")) return read_position(source, part);
  SurfacePoint point;
  point.part = std::max(part, 0);
  const Mesh& mesh = character_.parts[point.part].mesh;
  if (source.has("vertex")) {
    point.vertex = source.index("vertex", mesh.vertex_count());
    return point;
  }
  if (source.has("control")) {
    point.vertex = read_control(source, character_.parts[point.part]);
    return point;
  }
  if (!source.has("face"))
    throw io_error(source.place(), "is no point", "give a vertex, a face with barycentric, or a position");
  point.face = source.index("face", mesh.faces.size());
  const std::vector<double> weights = source.numbers("barycentric", 3);
  if (weights.empty()) throw io_error(source.place(), "has no \"barycentric\"", "give three weights");
  point.barycentric = Eigen::Map<const Eigen::Vector3d>(weights.data());
  if (point.barycentric.minCoeff() < -1e-6)
    throw io_error(source.place_of("barycentric"), "has a negative weight", "give three weights in [0, 1]");
  if (std::abs(point.barycentric.sum() - 1) > 1e-3)
    throw io_error(source.place_of("barycentric"), fmt::format("sums to {}", point.barycentric.sum()),
                   "the three weights sum to 1");
  const std::vector<int> corners = source.indices("corners", mesh.faces[point.face].size());
  if (!corners.empty() && corners.size() != 3)
    throw io_error(source.place_of("corners"), fmt::format("has {} numbers", corners.size()), "give three");
  for (std::size_t k = 0; k < corners.size(); ++k) point.corners[k] = corners[k];
  return point;
}

const PointReader::Surface& PointReader::surface_of(int wanted) {
  const auto known = surfaces_.find(wanted);
  if (known != surfaces_.end()) return known->second;
  Surface surface;
  const std::vector<Eigen::Matrix4d> matrices = model_matrices(character_);
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> triangles;
  for (int p = 0; p < static_cast<int>(character_.parts.size()); ++p) {
    const Part& part = character_.parts[p];
    if (wanted >= 0 ? wanted != p : !part.shown) continue;
    const int first = static_cast<int>(positions.size());
    const Eigen::Matrix4d matrix =
        part.node >= 0 && part.skin < 0 ? matrices[part.node] : Eigen::Matrix4d::Identity();
    for (Eigen::Index v = 0; v < part.mesh.positions.rows(); ++v)
      positions.push_back(
          (matrix * part.mesh.positions.row(v).transpose().cast<double>().homogeneous()).head<3>());
    for (std::size_t f = 0; f < part.mesh.faces.size(); ++f) {
      const auto face = part.mesh.faces[f];
      for (int c = 2; c < static_cast<int>(face.size()); ++c) {
        triangles.emplace_back(first + face[0], first + face[c - 1], first + face[c]);
        SurfacePoint at;
        at.part = p;
        at.face = static_cast<int>(f);
        at.corners = {0, c - 1, c};
        surface.triangles.push_back(at);
      }
    }
  }
  PointsD rows(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) rows.row(v) = positions[v].transpose();
  Triangles corners(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) corners.row(t) = triangles[t].transpose();
  surface.query = std::make_unique<SurfaceQuery>(rows, corners);
  return surfaces_[wanted] = std::move(surface);
}

SurfacePoint PointReader::read_position(const JsonObject& source, int part) {
  const std::vector<double> numbers = source.numbers("position", 3);
  const Surface& surface = surface_of(part);
  const SurfaceQuery::Hit hit = surface.query->closest(Eigen::Map<const Eigen::Vector3d>(numbers.data()));
  if (hit.triangle < 0)
    throw io_error(source.place_of("position"), "is near no surface", "move it to the face");
  SurfacePoint point = surface.triangles[hit.triangle];
  point.barycentric = hit.barycentric;
  return point;
}

void add_place_on_part(const SurfacePoint& point, Json& json) {
  if (point.face < 0) {
    json["vertex"] = point.vertex;
    return;
  }
  json["face"] = point.face;
  json["barycentric"] = {point.barycentric[0], point.barycentric[1], point.barycentric[2]};
  if (point.corners != std::array{0, 1, 2}) json["corners"] = point.corners;
}

Json point_json(const SurfacePoint& point, const Character& character) {
  Json json = Json::object();
  if (point.part > 0) json["part"] = character.parts[point.part].name;
  add_place_on_part(point, json);
  return json;
}

}  // namespace mien::detail
