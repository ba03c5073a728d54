#include "mien/character/whole_faces.h"

#include <cmath>
#include <string>

#include "mien/core/error.h"

namespace mien {

PointsD whole_face(const Character& character, int part, int shape) {
  if (part < 0 || part >= static_cast<int>(character.parts.size()))
    throw invalid_input("part " + std::to_string(part), "does not exist",
                        "there are " + std::to_string(character.parts.size()));
  if (shape < 0 || shape >= static_cast<int>(character.shapes.size()))
    throw invalid_input("shape " + std::to_string(shape), "does not exist",
                        "there are " + std::to_string(character.shapes.size()));
  PointsD face = character.parts[part].mesh.positions.cast<double>();
  for (const PartDelta& delta : character.shapes[shape].parts)
    for (std::size_t k = 0; delta.part == part && k < delta.vertices.size(); ++k)
      face.row(delta.vertices[k]) += delta.deltas.row(static_cast<Eigen::Index>(k)).cast<double>();
  return face;
}

PartDelta delta_of(int part, const Points& neutral, const Points& face, double threshold) {
  if (neutral.rows() != face.rows())
    throw invalid_input("vertices", "are " + std::to_string(face.rows()),
                        "the neutral has " + std::to_string(neutral.rows()));
  // The difference of two floats of like size is exact in double; it rounds once, here.
  const PointsD displacement = face.cast<double>() - neutral.cast<double>();
  PartDelta delta;
  delta.part = part;
  for (Eigen::Index v = 0; v < displacement.rows(); ++v)
    if (displacement.row(v).norm() > threshold) delta.vertices.push_back(static_cast<int>(v));
  delta.deltas.resize(static_cast<Eigen::Index>(delta.vertices.size()), 3);
  for (std::size_t k = 0; k < delta.vertices.size(); ++k)
    delta.deltas.row(static_cast<Eigen::Index>(k)) = displacement.row(delta.vertices[k]).cast<float>();
  return delta;
}

Eigen::VectorXd whole_face_weights(const ShapeWeights& weights) {
  Eigen::VectorXd whole(weights.values.size() + 1);
  whole << 1 - weights.values.sum(), weights.values;
  return whole;
}

ShapeWeights delta_weights(const Eigen::VectorXd& whole_face_weights) {
  const double sum = whole_face_weights.sum();
  if (whole_face_weights.size() == 0 || !(std::abs(sum - 1) <= 1e-9))
    throw invalid_input("whole-face weights", "sum to " + std::to_string(sum),
                        "give weights of the neutral and every shape that sum to 1");
  return ShapeWeights(whole_face_weights.tail(whole_face_weights.size() - 1));
}

}  // namespace mien
