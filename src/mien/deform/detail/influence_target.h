#pragma once
/// An influence object as a vertex that is to be bound sees it.

#include <memory>
#include <utility>
#include <vector>

#include "mien/character/influence_object.h"

namespace mien::detail {

using ControlShares = std::vector<std::pair<int, double>>;  ///< (control point, coefficient)

/// What a vertex asks of an object: how far it is, and which control points its point of the object has.
class InfluenceTarget {
 public:
  virtual ~InfluenceTarget() = default;
  virtual double distance(const Eigen::Vector3d& point) const = 0;
  /// Nothing for frames, and outside of a lattice.
  virtual ControlShares shares(const Eigen::Vector3d& point) const = 0;
  /// Points all over the object.
  virtual PointsD samples() const = 0;
};

/// The target of an object whose form fits its control points.
///   smoothing  how many of a mesh's nearest triangles share a vertex
std::unique_ptr<InfluenceTarget> target_of(const InfluenceObject& object, int smoothing);

}  // namespace mien::detail
