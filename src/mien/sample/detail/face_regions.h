#pragma once
/// Who moves with what on a head's skin: places in the loops around eyes and mouth, and soft masks.

#include <functional>
#include <optional>

#include "mien/sample/detail/head_mesh.h"

namespace mien::sample {

using Weights = std::vector<double>;  ///< one a vertex of the whole skin
using Field = std::vector<Vector3d>;  ///< one displacement a vertex of the whole skin

/// A vertex' place in the loops around an opening.
struct LoopPlace {
  int ring = -1;  ///< index of the loop, -1: in none
  int slot = -1;  ///< index along the loop
};

struct FaceRegions {
  std::vector<LoopPlace> left_eye, mouth;  ///< #V each; a right-hand vertex has its twin's place in the
                                           ///< mouth, and none in the left eye
  Weights jaw;    ///< 1 on what the jaw carries, 0 on the skull, one half at the corners of the mouth
  Weights lower;  ///< like `jaw`, but upper and lower lip are told apart up to the corners
  Weights neck;   ///< 1 on the neck, 0 on the head
  Weights lips;   ///< 1 on the red of the lips and inside, fading out on the face
};

FaceRegions make_regions(const HeadMesh& head, const HeadForm& form);

/// Spreads the values that `seed` fixes over the other vertices of the half head, then to the right side.
Weights diffuse(const HeadMesh& head, const std::function<std::optional<double>(int)>& seed,
                int rounds = 400);

/// 1 at the centre, 0 beyond the ellipsoid of these radii, smooth between.
double soft(const Vector3d& p, const Vector3d& centre, const Vector3d& radii);

/// The mirror image of a displacement of the whole skin.
Field mirrored(const HeadMesh& head, const Field& field);

}  // namespace mien::sample
