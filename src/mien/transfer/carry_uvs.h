#pragma once
/// The source's UVs reassigned to the target's faces, seams intact (thesis 5.5).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mien/geometry/mesh.h"

namespace mien {

/// The source's skin with one UV triple a triangle.
struct UvSource {
  const PointsD& guide;                             ///< #V: the source's skin on the target
  const Triangles& triangles;                       ///< #T x 3
  std::vector<std::array<Eigen::Vector2d, 3>> uvs;  ///< #T, one a corner
  std::vector<char> has_uv;                         ///< #T
};

/// For every face a UV a corner. The face's centre chooses where on the guide, and so in which chart, the face lies; its
/// corners then look for their place only among triangles that are connected to that one in the chart, and reach over
/// its edge by extrapolation. So a face across a seam takes one side of it and is never smeared over the image.
///   positions  #V target vertices; faces of the target that are skin
///   returns    one coordinate a corner in face order; equal coordinates of one vertex share a row; -1 where the guide
///              has no UVs
///   cost       about 20 closest points a face
UvSet carry_uvs(const UvSource& source, const PointsD& positions, const Faces& faces);

}  // namespace mien
