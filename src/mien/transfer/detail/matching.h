#pragma once
/// Closest points between the moving source and the target, with the gates that keep lips, lids and nostrils apart.

#include <limits>
#include <vector>

#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/displacement_solver.h"

namespace mien::detail {

/// A surface with what matching asks of it.
struct MatchSurface {
  PointsD positions, normals;
  Triangles triangles;
  Eigen::VectorXd openness, masses;
  std::vector<char> boundary;  // vertices on an open border
  Eigen::VectorXd far;         // 0 near a landmark, 1 far from all; empty: near
  SurfaceQuery query;

  MatchSurface(const PointsD& positions, const Triangles& triangles, const Eigen::VectorXd& openness,
               const Eigen::VectorXd& masses, const std::vector<char>& boundary,
               SurfaceQuery::Build build = SurfaceQuery::Build::good);
  Eigen::Vector3d triangle_normal(int triangle) const;
  /// The vertices' normals at a place, unit length; the triangle's where they cancel.
  Eigen::Vector3d normal_at(const SurfaceQuery::Hit& place) const;
};

struct MatchOptions {
  double least_cosine = 0.5;  ///< of the angle between the normals
  double least_reach = 0.01;  ///< a match further than max(this, 3 x median distance) is rejected
  double tangential = 0.35;   ///< tangential share of a plane's pull
  /// Where the surface bends by a radian within this length, the tangential share is half way to one: a lid's rim
  /// says where it is in two directions, a cheek in one. 0: nowhere.
  double bend_length = 0;
  /// The match is the closest point in place and normal together, the normal times this length; `far` surfaces by
  /// another, for there the normal alone tells how far around a crown a point lies. 0: in place alone.
  double normal_length = 0, far_normal_length = 0;
  int most_vertices = std::numeric_limits<int>::max();  ///< of either side that ask, evenly chosen by number
};

/// The triangles that the last matching found, by asking vertex: where the next one looks first. Changes no result.
struct MatchMemory {
  std::vector<int> forward,
      backward;  ///< #V of the moving and of the fixed surface, -1: none; empty: nothing known
};

/// Wishes that bring the moving vertices onto the fixed surface and the fixed vertices onto the moving surface, each
/// direction's weights summing to about one. Vertices are those of `moving`.
std::vector<Wish> match_both_ways(const MatchSurface& moving, const MatchSurface& fixed,
                                  const MatchOptions& options, MatchMemory& memory);

}  // namespace mien::detail
