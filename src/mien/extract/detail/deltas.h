#pragma once
/// Shapes of one part with a row for every vertex, and back.

#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

/// A shape's displacements of one part, one row a vertex, part space.
Points dense_delta(const Character& character, const Shape& shape, int part);

/// The rows of `dense` that are not zero.
PartDelta sparse_delta(int part, const Points& dense);

/// Per part: its vectors to model space, in the bind pose.
std::vector<Eigen::Matrix3d> vectors_to_model(const Character& character);

/// Puts `delta` in the place of what the shape does to that part. Normals of the old one are dropped.
void replace_delta(Shape& shape, PartDelta delta);

}  // namespace mien::detail
