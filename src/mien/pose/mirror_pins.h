#pragma once
/// Mirrored dragging: what one side is told, the other side is told too.

#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/geometry/mirror_plane.h"

namespace mien {

/// The plane across the middle of the face's box, upright, model space: x is left and right. For a head that is turned or
/// far from symmetric, `find_mirror_plane` of symmetry looks for it.
MirrorPlane middle_plane(const Character& character);

/// `pins`, then for each its mirror image: the surface point of the neutral (parts as in rest) closest to its place's mirror
/// image, the goal and axes mirrored. A pin on the plane, and one on a joint, has none.
///   throws  invalid_input: a normal that is zero, a pin off the surface
std::vector<Pin> mirror_pins(const Character& character, const std::vector<Pin>& pins,
                             const MirrorPlane& plane);

}  // namespace mien
