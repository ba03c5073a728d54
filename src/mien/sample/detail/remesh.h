#pragma once
/// Quads made into triangles of another layout, so that a target shares nothing with the source's grid.

#include <vector>

#include "mien/geometry/mesh.h"

namespace mien::sample {

struct Remeshed {
  Mesh mesh;                    ///< triangles in the groups of the input, no UVs
  std::vector<int> new_vertex;  ///< per vertex of the input; -1: merged away
};

/// Merges the ends of edges shorter than wanted and turns edges towards even triangles.
///   kept    per vertex, 1: it stays where it is
///   wanted  per vertex, length of the edges around it
/// The surface keeps its borders and stays manifold.
Remeshed remesh(const Mesh& mesh, const std::vector<char>& kept, const std::vector<double>& wanted);

}  // namespace mien::sample
