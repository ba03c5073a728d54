#pragma once
/// What a user says about an influence object. Data only; deform makes the object of it.

#include <vector>

#include "mien/character/influence_object.h"
#include "mien/character/surface_point.h"

namespace mien {

/// A weight map drawn by hand.
struct VertexWeights {
  int part = 0;
  std::vector<int> vertices;   ///< ascending
  std::vector<float> weights;  ///< (0, 1]
};

/// How far an object acts. The weight is `strength` up to the distance `full` and falls as (x^2 - 1)^2 to 0 at `range`.
struct InfluenceReach {
  double range = 0;     ///< model units, above `full`; lattices and drawn weights need none
  double full = 0;      ///< model units
  double strength = 1;  ///< (0, 1]
  /// Distances along the skin from where the object is nearest to it; false: through space.
  bool geodesic = true;
  /// Ascending; none: the part nearest to the object, or all in reach when distances go through space.
  std::vector<int> parts;
  /// Lattices: share of each side over which the weight rises from 0 at the border, [0, 0.5].
  double fade = 0.25;
  int smoothing = 8;  ///< meshes: how many of the nearest triangles share a vertex; 1: the nearest alone
  std::vector<VertexWeights> drawn;  ///< ascending by part; some: these in place of distances
};

/// An object to be made.
struct ObjectSketch {
  /// Without bindings; without control points where `through` gives them.
  InfluenceObject object;
  /// Curves: points of the skin that it comes closest to, in order, as many as control points or more. Surfaces: a grid of as many as
  /// control vertices, u fastest, that it passes through. Clusters, locators: where it is.
  std::vector<SurfacePoint> through;
  InfluenceReach reach;
  bool follows_skin = false;  ///< control points take the joints of the skin below them
  std::vector<int> joints;    ///< nodes: of those these alone; none: all
};

}  // namespace mien
