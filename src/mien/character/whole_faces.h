#pragma once
/// Shapes as whole faces, the form in which they are sculpted, and back: face = sum of weights x whole faces
/// with the neutral among them and weights that sum to one (Lewis and Anjyo 2010, sidebar) is neutral + sum
/// of shape weights x deltas with the same weights, the neutral's left out.

#include <Eigen/Core>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// One part as the shape at weight 1 has it: neutral + delta.
///   returns  #V x 3
///   throws   invalid_input: part or shape out of range
PointsD whole_face(const Character& character, int part, int shape);

/// The delta of a whole face: the vertices that move by more than `threshold` (a length), or all that move
/// for 0. `whole_face` of it gives `face` back bit for bit in float where no coordinate moves by more than its
/// own size.
///   neutral, face  #V x 3
///   throws         invalid_input: sizes that differ
PartDelta delta_of(int part, const Points& neutral, const Points& face, double threshold = 0);

/// #S + 1 weights of the neutral and the whole faces, which sum to one: 1 - sum, then the shape weights.
Eigen::VectorXd whole_face_weights(const ShapeWeights& weights);

/// The inverse.
///   throws  invalid_input: no weights, a sum that is not one to 1e-9
ShapeWeights delta_weights(const Eigen::VectorXd& whole_face_weights);

}  // namespace mien
