#pragma once
/// What a run of faces is made of, as far as a picture needs it.

#include <Eigen/Core>
#include <vector>

#include "mien/character/character.h"
#include "mien/picture/picture.h"

namespace mien::detail {

struct Look {
  Eigen::Vector3f albedo = Eigen::Vector3f(0.64f, 0.41f, 0.31f);  ///< linear RGB
  float gloss = 0.10f;                                            ///< strength of the highlight
  float sharpness = 14;                                           ///< its exponent
  bool visible = true;
  bool thin = false;       ///< lets light pass, casts no shadow (lashes)
  bool two_sided = false;  ///< both sides are outside (lashes, brows, hair)
};

/// One look a face of the part.
std::vector<Look> looks_of_part(const Character& character, const Part& part);

Eigen::Vector3f linear_of(Color color);

}  // namespace mien::detail
