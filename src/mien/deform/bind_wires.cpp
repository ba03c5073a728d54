#include "mien/deform/bind_wires.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "mien/character/weld.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/wires.h"
#include "mien/geometry/bspline.h"
#include "mien/geometry/geodesic.h"

namespace mien {
namespace {

/// One part without its seams, in model space.
struct Surface {
  Weld weld;
  PointsD positions;  ///< #V
  Geodesics geodesics;
};

Surface surface_of(const Character& character, int part) {
  const Mesh& mesh = character.parts[part].mesh;
  Weld weld = weld_seams(character, part);
  const PointsD positions = bind_positions(character, part);
  PointsD welded(static_cast<Eigen::Index>(weld.size()), 3);
  for (std::size_t w = 0; w < weld.size(); ++w)
    welded.row(static_cast<Eigen::Index>(w)) = positions.row(weld.representative[w]);
  Geodesics geodesics(welded, triangulate(weld_faces(mesh.faces, weld)));
  return {std::move(weld), positions, std::move(geodesics)};
}

void check_wire(const Wire& wire) {
  const std::string place = "wire " + wire.name;
  if (wire.ranges.empty()) throw invalid_input(place, "has no range", "a length above 0");
  for (const double range : wire.ranges)
    if (!(range > 0) || !std::isfinite(range))
      throw invalid_input(place, "has range " + std::to_string(range), "a finite length above 0");
  for (std::size_t i = 0; i < wire.falloff.size(); ++i) {
    const Eigen::Vector2d& point = wire.falloff[i];
    if (!point.allFinite() || point.y() < 0 || point.y() > 1 ||
        (i > 0 && point.x() <= wire.falloff[i - 1].x()))
      throw invalid_input(place + ", falloff point " + std::to_string(i),
                          "is out of order or outside of 0 to 1", "ascending x, and f from 0 to 1");
  }
  if (!(wire.localizing >= 0) || !std::isfinite(wire.localizing))
    throw invalid_input(place, "has a localizing exponent that is negative or not finite", "0 or more");
}

/// The corner of the point's face that it is closest to, or its vertex.
int vertex_of(const Character& character, const std::string& name, const SurfacePoint& point) {
  const auto refuse = [&](const std::string& what) {
    return invalid_input("wire " + name, "has a point on " + what, "one that the character has");
  };
  if (point.part < 0 || point.part >= static_cast<int>(character.parts.size()))
    throw refuse("part " + std::to_string(point.part));
  const Mesh& mesh = character.parts[point.part].mesh;
  int vertex = point.vertex;
  if (point.face >= 0) {
    if (point.face >= static_cast<int>(mesh.faces.size())) throw refuse("face " + std::to_string(point.face));
    Eigen::Index best = 0;
    point.barycentric.maxCoeff(&best);
    const int corner = point.corners[best];
    if (corner < 0 || corner >= static_cast<int>(mesh.faces[point.face].size()))
      throw refuse("corner " + std::to_string(corner));
    vertex = mesh.faces[point.face][corner];
  }
  if (vertex < 0 || vertex >= static_cast<int>(mesh.vertex_count()))
    throw refuse("vertex " + std::to_string(vertex));
  return vertex;
}

}  // namespace

struct WireBinder::Surfaces {
  explicit Surfaces(const Character& c) : character(c) {}

  const Surface& of(int part) const {
    auto found = parts.find(part);
    if (found == parts.end()) found = parts.emplace(part, surface_of(character, part)).first;
    return found->second;
  }

  std::vector<int> path(const std::string& name, std::span<const SurfacePoint> points) const;
  std::vector<int> path_under(const Wire& wire, double max_distance, int& part) const;
  WireDistances along(const Wire& wire, double max_distance) const;
  WireDistances through_space(const CurveQuery& query, int part, double max_distance) const;

  const Character& character;
  mutable std::map<int, Surface> parts;
};

/// Welded vertices from one of the wire's points to the next.
std::vector<int> WireBinder::Surfaces::path(const std::string& name,
                                            std::span<const SurfacePoint> points) const {
  const int part = points.front().part;
  std::vector<int> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string place = "wire " + name + ", point " + std::to_string(i);
    const int vertex = vertex_of(character, name, points[i]);
    if (points[i].part != part)
      throw invalid_input(place,
                          "lies on part " + character.parts[points[i].part].name + " and the first on " +
                              character.parts[part].name,
                          "points on one piece of surface");
    const int welded = of(part).weld.of[vertex];
    if (all.empty()) {
      all.push_back(welded);
      continue;
    }
    const std::vector<int> stretch = of(part).geodesics.edge_path(all.back(), welded);
    if (stretch.empty())
      throw invalid_input(place, "lies on another piece of surface than the point before it",
                          "points on one piece of surface");
    all.insert(all.end(), stretch.begin() + 1, stretch.end());
  }
  return all;
}

/// The same for a wire that was not drawn through points: through the vertices closest to it.
std::vector<int> WireBinder::Surfaces::path_under(const Wire& wire, double max_distance, int& part) const {
  const int samples = 4 * wire.curve.control_count();
  std::vector<int> all;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const PointsD positions = bind_positions(character, static_cast<int>(p));
    if (positions.rows() == 0) continue;
    std::vector<int> found;
    double least = std::numeric_limits<double>::infinity();
    for (int s = 0; s <= samples; ++s) {
      const double u = wire.curve.low() + (wire.curve.high() - wire.curve.low()) * s / samples;
      Eigen::Index vertex = 0;
      least = std::min(least, (positions.rowwise() - point_at(wire.curve, u).transpose())
                                  .rowwise()
                                  .squaredNorm()
                                  .minCoeff(&vertex));
      found.push_back(static_cast<int>(vertex));
    }
    if (!(least < nearest)) continue;
    nearest = least;
    part = static_cast<int>(p);
    all = std::move(found);
  }
  if (!(std::sqrt(nearest) <= max_distance))
    throw invalid_input("wire " + wire.name, "is further from the surface than it reaches",
                        "a curve on the surface");
  std::vector<int> path;
  for (const int vertex : all) {
    const int welded = of(part).weld.of[vertex];
    const std::vector<int> stretch =
        path.empty() ? std::vector<int>{} : of(part).geodesics.edge_path(path.back(), welded);
    if (stretch.empty())
      path.push_back(welded);
    else
      path.insert(path.end(), stretch.begin() + 1, stretch.end());
  }
  return path;
}

WireDistances WireBinder::Surfaces::along(const Wire& wire, double max_distance) const {
  WireDistances result;
  result.part = wire.points.empty() ? 0 : wire.points.front().part;
  const std::vector<int> seeds_at =
      wire.points.empty() ? path_under(wire, max_distance, result.part) : path(wire.name, wire.points);
  const Surface& surface = of(result.part);
  const CurveQuery query(wire.curve);
  std::vector<GeodesicSeed> seeds;
  for (const int welded : seeds_at) {
    const auto hit = query.closest(surface.positions.row(surface.weld.representative[welded]).transpose());
    seeds.push_back({welded, hit.distance, hit.parameter});
  }
  const GeodesicField field = surface.geodesics.distances(seeds, max_distance);
  for (std::size_t v = 0; v < surface.weld.of.size(); ++v) {
    const int welded = surface.weld.of[v];
    if (!std::isfinite(field.distance[welded])) continue;
    result.vertices.push_back(static_cast<int>(v));
    result.distances.push_back(field.distance[welded]);
    result.parameters.push_back(field.place[welded]);
  }
  return result;
}

WireDistances WireBinder::Surfaces::through_space(const CurveQuery& query, int part,
                                                  double max_distance) const {
  const PointsD positions = bind_positions(character, part);
  std::vector<CurveQuery::Hit> hits(static_cast<std::size_t>(positions.rows()));
  parallel_for(hits.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      hits[v] = query.closest(positions.row(static_cast<Eigen::Index>(v)).transpose());
  });
  WireDistances result;
  result.part = part;
  for (std::size_t v = 0; v < hits.size(); ++v) {
    if (!(hits[v].distance <= max_distance)) continue;
    result.vertices.push_back(static_cast<int>(v));
    result.distances.push_back(hits[v].distance);
    result.parameters.push_back(hits[v].parameter);
  }
  return result;
}

WireBinder::WireBinder(const Character& character) : surfaces_(std::make_unique<Surfaces>(character)) {}
WireBinder::~WireBinder() = default;

PointsD WireBinder::trace(const std::string& name, std::span<const SurfacePoint> points) const {
  if (points.size() < 2)
    throw invalid_input("wire " + name, "has " + std::to_string(points.size()) + " points", "two or more");
  const std::vector<int> path = surfaces_->path(name, points);
  const Surface& surface = surfaces_->of(points.front().part);
  PointsD traced(static_cast<Eigen::Index>(path.size()), 3);
  for (std::size_t i = 0; i < path.size(); ++i)
    traced.row(static_cast<Eigen::Index>(i)) = surface.positions.row(surface.weld.representative[path[i]]);
  return traced;
}

SurfacePoint WireBinder::between(const SurfacePoint& from, const SurfacePoint& to, double share) const {
  const std::array<SurfacePoint, 2> ends{from, to};
  const std::vector<int> path = surfaces_->path("between two points", ends);
  const auto at = static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * (path.size() - 1.0)));
  SurfacePoint point;
  point.part = from.part;
  point.vertex = surfaces_->of(from.part).weld.representative[path[at]];
  return point;
}

SurfacePoint WireBinder::moved(const SurfacePoint& from, const Eigen::Vector3d& offset) const {
  const Surface& surface = surfaces_->of(from.part);
  const int vertex = vertex_of(surfaces_->character, "moved", from);
  const Eigen::Vector3d goal = surface.positions.row(vertex).transpose() + offset;
  SurfacePoint point;
  point.part = from.part;
  point.vertex = surface.weld.representative[surface.geodesics.walk_towards(surface.weld.of[vertex], goal)];
  return point;
}

WireBinder::Stand WireBinder::stand(const SurfacePoint& point) const {
  const Surface& surface = surfaces_->of(point.part);
  const int vertex = vertex_of(surfaces_->character, "moved", point);
  return {surface.positions.row(vertex).transpose(), surface.geodesics.normal_at(surface.weld.of[vertex])};
}

std::vector<WireDistances> WireBinder::measure(const Wire& wire, double max_distance) const {
  require_valid(wire.curve);
  std::vector<WireDistances> result;
  if (wire.geodesic) {
    result.push_back(surfaces_->along(wire, max_distance));
    return result;
  }
  const CurveQuery query(wire.curve);
  for (std::size_t part = 0; part < surfaces_->character.parts.size(); ++part) {
    WireDistances found = surfaces_->through_space(query, static_cast<int>(part), max_distance);
    if (!found.vertices.empty()) result.push_back(std::move(found));
  }
  return result;
}

std::vector<WireBinding> WireBinder::bind(const Wire& wire) const {
  check_wire(wire);
  const double reach = *std::max_element(wire.ranges.begin(), wire.ranges.end());
  std::vector<WireBinding> bindings = bindings_of(wire, measure(wire, reach));
  if (bindings.empty())
    throw invalid_input("wire " + wire.name, "reaches no vertex", "a longer range or a curve on the surface");
  return bindings;
}

std::vector<WireBinding> bindings_of(const Wire& wire, std::span<const WireDistances> distances) {
  std::vector<WireBinding> bindings;
  for (const WireDistances& measured : distances) {
    WireBinding binding;
    binding.part = measured.part;
    for (std::size_t i = 0; i < measured.vertices.size(); ++i) {
      const double range = range_at(wire, measured.parameters[i]);
      const auto falloff = static_cast<float>(falloff_at(wire, measured.distances[i] / range));
      if (!(falloff > 0)) continue;
      binding.vertices.push_back(measured.vertices[i]);
      binding.falloff.push_back(falloff);
      binding.parameters.push_back(static_cast<float>(measured.parameters[i]));
    }
    if (!binding.vertices.empty()) bindings.push_back(std::move(binding));
  }
  return bindings;
}

std::vector<Wire> bind_wires(const Character& character, std::vector<Wire> wires) {
  const WireBinder binder(character);
  for (Wire& wire : wires) wire.bindings = binder.bind(wire);
  return wires;
}

}  // namespace mien
