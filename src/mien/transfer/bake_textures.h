#pragma once
/// The source's images in the target's own UVs (thesis 5.5), where the target keeps its layout.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/transfer/transfer.h"

namespace mien {

struct BakeOptions {
  int size = 1024;  ///< pixels a side of every image that is made
  /// Pixels that colours go on beyond the charts, so that filtering and mip maps find no gap at a seam.
  int padding = 16;
};

/// One image that was made.
struct BakedImage {
  std::string material;  ///< of the source, whose copy it hangs on
  std::vector<std::string> parts;
  std::vector<std::string> slots;  ///< baseColorTexture, ...
  double covered = 0;              ///< share of the pixels that the charts cover
  double overlap = 0;              ///< share of these that two faces or more claim
  double doubtful = 0;             ///< share whose place on the source does not face the same way
};

struct BakeResult {
  Character character;  ///< the target with copies of the source's materials, images inside
  std::vector<BakedImage> images;
  std::vector<TransferWarning> warnings;
};

/// For every pixel of the target's layout: the point of its surface that lies there, the place on the source (the closest of the
/// guide that faces the same way, on the pieces that lie where the target's piece does), and the source's colour at the UVs of
/// that place, base-colour factor included. The source's images are first averaged down where they are finer than what is
/// made. Faces that share a target material share an image, other faces share one a part. Metallic-roughness, occlusion and
/// emissive images follow the same places. Normal maps do not: their directions belong to the source's own UVs.
///   guide   where the source's vertices lie on the target, model space, one #V x 3 a part (`TransferReport::guide`)
///   target  with a UV set on its first index; parts that are not shown stay as they are
///   throws  invalid_input: a guide of other sizes, a size out of range, a target without any UVs, a source without any
///           image; io: an image that is missing or broken
///   cost    about 5 us a pixel
BakeResult bake_textures(const Character& source, const std::vector<Points>& guide, const Character& target,
                         const BakeOptions& options = {});

}  // namespace mien
