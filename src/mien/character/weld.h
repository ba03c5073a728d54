#pragma once
/// Which vertices of a mesh are copies of one another that a UV, normal or colour seam split.

#include <cstddef>
#include <vector>

#include "mien/character/character.h"
#include "mien/geometry/mesh.h"

namespace mien {

/// A numbering of a mesh's vertices in which the copies at a seam share one number.
struct Weld {
  std::vector<int> of;  ///< #V: the vertex's welded number, 0 ... #W - 1, ascending by first appearance
  std::vector<int> representative;  ///< #W: the first vertex with that number
  std::size_t size() const { return representative.size(); }
};

/// Joins vertices with equal positions only where two open edges of the surface fit together: the directed
/// boundary edge a -> b and one b' -> a' with the same two positions, exactly one of each. Lips, lids or
/// whole parts that touch without being split copies of one surface are therefore never glued. Where several
/// edges would fit, those of the same connected piece are tried alone; what is still ambiguous stays apart.
///   throws  invalid_input: a face names a vertex that the mesh does not have
///   cost    O(#F log #F)
Weld weld_seams(const Mesh& mesh);

/// The same for a part of a character, and copies that any shape or skin weight moves apart stay apart: an
/// open mouth slit whose lips touch in the neutral is not a seam.
Weld weld_seams(const Character& character, int part);

/// The faces with every corner replaced by its welded number.
Faces weld_faces(const Faces& faces, const Weld& weld);

}  // namespace mien
