#pragma once
/// Shapes on one part: neutral + sum of shape weight x delta.

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// Where the vertices of part `part` are with the shapes applied, before skinning.
///   returns  #V x 3 in the part's own space; at zero shape weights the neutral bit for bit
///   throws   invalid_input: a number of weights other than #S, a weight that is not finite, a part out of
///            range
///   cost     linear in the moved vertices of the shapes whose weight is not zero
PointsD add_shapes(const Character& character, int part, const ShapeWeights& weights);

}  // namespace mien
