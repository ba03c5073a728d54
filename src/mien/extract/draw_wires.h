#pragma once
/// Wires drawn on a face: through picked points, or through landmarks.

#include <span>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// The sketches as wires with their bindings. Each reference curve is fitted to the way along the surface from point to point.
///   throws  invalid_input, naming the wire: fewer than four points or control points; points off the surface or on different
///           pieces of it; a range that is negative, not finite or reaches nothing; two wires of one name
///   cost    about 5 ms a wire on a face of 9,000 vertices
std::vector<Wire> draw_wires(const Character& character, std::span<const WireSketch> sketches);

/// Sketches for a face with the 68 iBUG landmarks (`ibug_1` ... `ibug_68`):
///   15  brows, lids (upper and lower), nose bridge and base, lips (outer and inner, upper and lower), jaw (two sides, chin)
///   22  these, and the folds over the lids, the folds from nose to mouth to jaw, cheeks, and lip to chin
/// Features: brows, eyes, nose, mouth, jaw, cheeks. Sides are called L and R as the character sees them.
///   throws  invalid_input: another count; a landmark that is missing
std::vector<WireSketch> face_wire_sketches(const Character& character, int count = 22);

}  // namespace mien
