#pragma once
/// A character as it stands in a pose, without what moved it there; its normals and tangents with it.

#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {

/// What becomes of normals and tangents. A part without them gets none.
enum class SurfaceFrames {
  dropped,
  transformed,  ///< the file's, with the normal and tangent deltas of active shapes, carried by the skin
  recomputed,  ///< normals from the posed faces, by area, smooth across a seam where the file's are; tangents from the
               ///< first UV set where it has one coordinate a vertex, otherwise none
};

/// Unit normals of a part in `pose`, model space, whatever SurfaceFrames says of tangents.
///   returns  #V x 3, no rows when the part has none and `frames` does not recompute them
///   throws   invalid_input: as `evaluate`; a part out of range
Points posed_normals(const Character& character, const Pose& pose, int part, SurfaceFrames frames);

/// The posed surfaces as a character of their own: same parts, vertices, faces, UVs and materials, in model space;
/// no nodes, skins, shapes, sliders, clips. Landmarks stay on their faces.
///   throws  invalid_input: as `evaluate`
///   cost    as `evaluate`, and five times the skinning for transformed frames
Character posed_character(const Character& character, const Pose& pose,
                          SurfaceFrames frames = SurfaceFrames::recomputed);

}  // namespace mien
