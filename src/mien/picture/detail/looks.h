#pragma once
/// What a run of faces is made of, as far as a picture needs it.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/picture/picture.h"
#include "mien/texture/texture.h"

namespace mien::detail {

struct Look {
  Eigen::Vector3f albedo = Eigen::Vector3f(0.64f, 0.41f, 0.31f);  ///< linear RGB
  float gloss = 0.10f;                                            ///< strength of the highlight
  float sharpness = 14;                                           ///< its exponent
  bool visible = true;
  bool thin = false;       ///< lets light pass, casts no shadow (lashes)
  bool two_sided = false;  ///< both sides are outside (lashes, brows, hair)
  int texture = -1;        ///< index into Paint::textures: `albedo` times its colours
  AlphaUse alpha = {};     ///< what the texture's alpha does
  bool painted = false;    ///< times the colours of the vertices
  bool operator==(const Look&) const = default;
};

/// The images that pictures are painted with, each decoded once; what could not be is said.
struct Paint {
  std::vector<Texture> textures;
  std::map<int, int> texture_of_material;  ///< -1: none
  std::vector<std::string> warnings;
};

/// One look a face of the part; with `paint`, by the images and colours that the character has.
std::vector<Look> looks_of_part(const Character& character, const Part& part, Paint* paint);

Eigen::Vector3f linear_of(Color color);

}  // namespace mien::detail
