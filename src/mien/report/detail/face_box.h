#pragma once

#include "mien/geometry/mesh.h"

namespace mien::detail {

/// The box around points, grown on every side by `share` of its diagonal.
inline Box grown_box(const PointsD& points, double share) {
  Box box = bounding_box(points);
  const double by = share * box.diagonal();
  box.low.array() -= by;
  box.high.array() += by;
  return box;
}

}  // namespace mien::detail
