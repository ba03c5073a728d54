#pragma once
/// Influence objects as lines over a picture.

#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"
#include "mien/picture/render.h"

namespace mien {

/// The lines of every object in `pose`, a colour a kind: a curve with its control polygon, a surface's lines of constant u and v, a
/// lattice's cage, a mesh's edges, a frame's three axes. Lines behind the skin are drawn too, because that is where most objects are.
///   throws  invalid_input: as `evaluate`
std::vector<Polyline> object_lines(const Character& character, const Pose& pose);

}  // namespace mien
