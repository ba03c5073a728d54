#pragma once
/// The plane that a face mirrors itself in.

#include "mien/character/character.h"
#include "mien/geometry/mirror_plane.h"

namespace mien {

struct FoundPlane {
  MirrorPlane plane;  ///< model space; the normal is unit and points to the character's own left
  /// Mean distance of the mirrored surface to the surface, over the box's diagonal: 0 for a perfect mirror image; a sculpted
  /// head has 0.001 to 0.01.
  double asymmetry = 0;
};

/// The mirror plane of all parts in model space at rest: the best of the planes across the box's axes and the axes of inertia, fitted by closest
/// points of the mirrored surface. Which side is left is told by names with sides (landmarks, shapes, joints); where there
/// are none, +x is left, as in glTF.
///   throws  invalid_input: no faces
///   cost    70 passes of closest points over at most 4,000 vertices
FoundPlane find_mirror_plane(const Character& character);

}  // namespace mien
