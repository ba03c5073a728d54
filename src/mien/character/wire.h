#pragma once
/// Wires: curves whose motion moves the surface around them (Singh and Fiume 1998; Pyun, Shin and Shin 2001).

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/character/surface_point.h"
#include "mien/geometry/bspline.h"

namespace mien {

/// How far a wire reaches on one part: what `bind_wires` writes and a hand may correct, vertex by vertex.
struct WireBinding {
  int part = 0;
  std::vector<int> vertices;      ///< ascending
  std::vector<float> falloff;     ///< f in (0, 1], one a vertex
  std::vector<float> parameters;  ///< where on the reference curve each vertex belongs
  bool operator==(const WireBinding&) const = default;
};

/// An influence object of the character: its reference curve in the neutral, and what it reaches. At rest a wire lies on its
/// reference curve and moves nothing; `WireMove` says how it leaves it.
struct Wire {
  std::string name;
  std::string feature;  ///< the group that it belongs to: "mouth"
  BSpline curve;        ///< the reference curve; model space, neutral, bind pose
  std::vector<SurfacePoint>
      points;  ///< the surface points it was drawn through; none: given by control points
  /// Range, in model units: one for the whole curve, or values at even parameters, linear between them.
  std::vector<double> ranges;
  std::vector<Eigen::Vector2d> falloff;  ///< a drawn falloff: (x, f) by ascending x; none: (x^2 - 1)^2
  double localizing = 3;                 ///< k: the higher, the more the nearest of several wires decides
  bool geodesic = true;                  ///< distances along the surface; false: through space
  int turn_controls = 4;  ///< turn vectors along the curve, four or more; 0: the wire does not turn
  std::vector<WireBinding> bindings;  ///< ascending by part
};

/// How one wire leaves its reference curve. Everything that a wire does is linear in these numbers.
struct WireMove {
  int wire = 0;
  PointsD controls;  ///< displacements of the control points (w - r), model space; or no rows
  double scale = 0;  ///< s - 1: the radial scale less one
  PointsD turns;     ///< rotation vectors of the surface about the curve, to first order, radians; or no rows
};

/// What a user says about a wire.
struct WireSketch {
  std::string name;
  std::string feature;               ///< none: the wire's name
  std::vector<SurfacePoint> points;  ///< four or more, in order, on one piece of surface
  int controls = 10;                 ///< control points of the cubic B-spline, four or more
  double range = 0;                  ///< model units; 0: as far as the curve is long
  int turn_controls = 4;             ///< as Wire::turn_controls
  bool geodesic = true;
};

}  // namespace mien
