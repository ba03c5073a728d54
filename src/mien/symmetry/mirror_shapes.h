#pragma once
/// Shapes of one side from those of the other, and both sides from one shape.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/geometry/mirror_plane.h"
#include "mien/naming/action.h"

namespace mien {

/// Cuts shapes into a left and a right one, which add up to the whole: the left share of a vertex's displacement rises smoothly
/// from 0 to 1 across the plane.
///   shapes   names; each becomes NAMELeft and NAMERight (NAME_L and NAME_R if the name has an underscore or the others do)
///   width    half the width of the passage, of the box's diagonal
///   returns  the character with the two shapes in the place of each, a slider each with the old one's range, and clips that
///            moved the old one moving both
///   throws   invalid_input: no such shape, one that a corrective or a slider with several stops uses, a name that exists, a
///            width that is not above 0
Character split_shapes(const Character& character, const std::vector<std::string>& shapes,
                       const MirrorPlane& plane, double width = 0.02);

struct MirroredShapes {
  Character character;
  std::vector<std::string> made, replaced;  ///< shapes
};

/// For each shape named after one side the mirror image under the other side's name: a vertex takes the mirrored displacement of
/// the surface at its mirrored place, so that the two sides need not have the same vertices.
///   from     the side that is kept
///   replace  also shapes of the other side that exist; otherwise only missing ones are made
///   throws   invalid_input: no shape names that side
MirroredShapes mirror_shapes(const Character& character, Side from, const MirrorPlane& plane,
                             bool replace = false);

}  // namespace mien
