#pragma once
/// A head's whole skin: the half head and its mirror image.

#include "mien/geometry/mesh.h"
#include "mien/sample/detail/half_head.h"

namespace mien::sample {

struct HeadMesh {
  HalfHead half;                 ///< its vertex numbers are those of the whole mesh
  std::vector<Vector3d> points;  ///< the half's vertices, then the mirror images of those off the midline
  std::vector<int> mirror;       ///< the vertex at -x; itself on the midline
  Faces faces;
  UvSet uv;  ///< seams: down the back and around the crown
};

HeadMesh make_head(const HeadForm& form);

}  // namespace mien::sample
