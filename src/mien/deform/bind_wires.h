#pragma once
/// What a wire reaches.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// Distances from a wire's reference curve on one part, before range and falloff are applied.
struct WireDistances {
  int part = 0;
  std::vector<int> vertices;  ///< ascending
  std::vector<double> distances, parameters;
};

/// Measures and binds wires on one character; what does not depend on the wire is prepared once.
class WireBinder {
 public:
  explicit WireBinder(const Character& character);
  ~WireBinder();

  /// All vertices within `max_distance` of the wire and the curve parameters nearest to them.
  ///   geodesic wires act on the piece of surface that they are drawn on; copies of a vertex at a UV seam move alike.
  ///            Parameters are carried along the paths: a vertex in the mouth belongs to the lip that leads to it
  ///   others   act on every part in reach
  ///   throws   invalid_input: a curve that is not valid; points on different pieces of the surface; a curve that is further
  ///            from every surface than `max_distance`; a part, vertex or face out of range
  ///   cost     about 1 us a vertex in reach; the first wire on a part welds its seams
  std::vector<WireDistances> measure(const Wire& wire, double max_distance) const;

  /// The way along the surface's edges from one point to the next: #P x 3 vertices, model space.
  ///   name    the wire's, for errors
  ///   throws  invalid_input: fewer than two points; points on different pieces of the surface
  PointsD trace(const std::string& name, std::span<const SurfacePoint> points) const;

  /// The vertex at a `share` of that way, 0 to 1.
  SurfacePoint between(const SurfacePoint& from, const SurfacePoint& to, double share) const;

  /// The vertex that a walk along the surface from `from` towards its place + `offset` ends at.
  SurfacePoint moved(const SurfacePoint& from, const Eigen::Vector3d& offset) const;

  /// Where the vertex closest to a point is, and the surface's unit normal there; model space, neutral.
  struct Stand {
    Eigen::Vector3d position, normal;
  };
  Stand stand(const SurfacePoint& point) const;

  /// The wire's bindings by its ranges and falloff.
  ///   throws  as above; a range that is not positive, a falloff that is not ascending in x or outside of [0, 1]; ranges that
  ///           reach no vertex
  std::vector<WireBinding> bind(const Wire& wire) const;

 private:
  struct Surfaces;
  std::unique_ptr<Surfaces> surfaces_;
};

/// Distances into bindings, by the wire's ranges and falloff. May be empty.
std::vector<WireBinding> bindings_of(const Wire& wire, std::span<const WireDistances> distances);

/// The same wires with their bindings on `character`.
std::vector<Wire> bind_wires(const Character& character, std::vector<Wire> wires);

}  // namespace mien
