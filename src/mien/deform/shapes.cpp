#include "mien/deform/shapes.h"

#include <cmath>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

void add_delta(const PartDelta& delta, double weight, PointsD& positions) {
  for (std::size_t row = 0; row < delta.vertices.size(); ++row)
    positions.row(delta.vertices[row]) +=
        weight * delta.deltas.row(static_cast<Eigen::Index>(row)).cast<double>();
}

void check(const Character& character, int part, const ShapeWeights& weights) {
  if (part < 0 || part >= static_cast<int>(character.parts.size()))
    throw invalid_input("part " + std::to_string(part), "does not exist",
                        "a part from 0 to " + std::to_string(static_cast<int>(character.parts.size()) - 1));
  if (weights.values.size() != static_cast<Eigen::Index>(character.shapes.size()))
    throw invalid_input("shape weights", "number " + std::to_string(weights.values.size()),
                        std::to_string(character.shapes.size()) + ", one a shape");
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    if (!std::isfinite(weights.values[static_cast<Eigen::Index>(s)]))
      throw invalid_input("shape weight of " + character.shapes[s].name, "is not finite", "a finite number");
}

}  // namespace

PointsD add_shapes(const Character& character, int part, const ShapeWeights& weights) {
  check(character, part, weights);
  PointsD positions = character.parts[part].mesh.positions.cast<double>();
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    const double weight = weights.values[static_cast<Eigen::Index>(s)];
    if (weight == 0) continue;
    for (const PartDelta& delta : character.shapes[s].parts)
      if (delta.part == part) add_delta(delta, weight, positions);
  }
  return positions;
}

}  // namespace mien
