#pragma once
/// Distances along a surface.

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// Where a distance field starts.
struct GeodesicSeed {
  int vertex = 0;
  double distance = 0;  ///< of the vertex to what is measured from
  double place = 0;     ///< where on the source that is, e.g. a curve's parameter
};

struct GeodesicField {
  Eigen::VectorXd distance;  ///< #V to the nearest seed; infinite beyond the limit and where no path leads
  Eigen::VectorXd place;     ///< #V, of the source where the shortest path starts; between seeds interpolated
};

/// Geodesic distances on one triangle mesh, asked many times. Pieces that are not connected are infinitely far apart: an
/// upper lip does not reach the lower one across the slit.
///   method  fast marching (Kimmel and Sethian 1998): triangles are crossed by plane fronts, edges where no front
///           fits. Of the roads there are it alone takes a whole curve as its source, stops at the range that is asked for and
///           needs no factorisation: the heat method solves two systems of the whole mesh for each curve, and exact window
///           propagation is ten times as slow for the second digit
class Geodesics {
 public:
  ///   throws  invalid_input: an index out of range, a position that is not finite
  ///   cost    linear
  Geodesics(const PointsD& positions, const Triangles& triangles);

  /// Distances up to `max_distance`, within 2 % of the true ones on meshes without obtuse triangles.
  ///   throws  invalid_input: a seed out of range or of a distance that is negative or not finite
  ///   cost    about 0.3 us a vertex within `max_distance`
  GeodesicField distances(std::span<const GeodesicSeed> seeds,
                          double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Vertices of the shortest path along edges, both ends included; empty when none leads there. Of equally short ones always
  /// the same.
  ///   throws  invalid_input: a vertex out of range
  std::vector<int> edge_path(int from, int to) const;

  /// Where a walk from vertex to vertex ends that always takes the neighbour closest to `goal`, as long as that comes closer.
  /// It stays on its piece of surface and does not jump across slits.
  ///   throws  invalid_input: a vertex out of range
  int walk_towards(int from, const Eigen::Vector3d& goal) const;

  /// Unit normal at a vertex, by the area of the triangles around it; zero where there is none.
  Eigen::Vector3d normal_at(int vertex) const;

 private:
  /// One triangle around a vertex v: its next corners a and b, how far v is from them, and where each lies in the frame of
  /// the edge from v, at (0, 0), to the other, at (length, 0).
  struct Spoke {
    int a = 0, b = 0;
    float to_a = 0, to_b = 0, x_a = 0, y_a = 0, x_b = 0, y_b = 0;
  };
  std::span<const Spoke> spokes_of(int vertex) const {
    return {spokes_.data() + offsets_[vertex], spokes_.data() + offsets_[vertex + 1]};
  }
  void require_vertex(int vertex) const;

  PointsD positions_;
  std::vector<int> offsets_;  ///< #V + 1
  std::vector<Spoke> spokes_;
};

}  // namespace mien
