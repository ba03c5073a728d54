#pragma once
/// The source's UVs reassigned to the target's faces, seams intact (thesis 5.5).

#include "mien/geometry/mesh.h"
#include "mien/transfer/uv_layout.h"

namespace mien {

/// For every face a UV a corner. The face's centre chooses where on the guide, and so in which chart, the face lies; its
/// corners then look for their place only among triangles that are connected to that one in the chart, and reach over
/// its edge by extrapolation. So a face across a seam takes one side of it and is never smeared over the image.
///   source     the source's skin; guide: #V, its vertices on the target
///   positions  #V target vertices; faces of the target that are skin
///   returns    one coordinate a corner in face order; equal coordinates of one vertex share a row; -1 where the guide
///              has no UVs
///   cost       about 20 closest points a face
UvSet carry_uvs(const UvLayout& source, const PointsD& guide, const PointsD& positions, const Faces& faces);

}  // namespace mien
