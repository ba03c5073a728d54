#pragma once
/// An influence object from what a user says about it.

#include "mien/character/character.h"
#include "mien/character/object_sketch.h"

namespace mien {

/// The sketch's object on `character`, bound: control points through its points of the skin, the joints that carry them, and what it
/// reaches. Its skin is that of the part that it reaches first, where control points are to have joints and the sketch names none.
///   throws  invalid_input: as fit_controls, bind_controls and bind_influence; a point on a part, vertex or face that does not exist; a
///           carrier or node out of range
InfluenceObject draw_object(const Character& character, const ObjectSketch& sketch);

}  // namespace mien
