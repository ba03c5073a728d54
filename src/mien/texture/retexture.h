#pragma once
/// Materials with other images, and images that go from one character to another.

#include <string>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/texture/texture.h"

namespace mien {

/// The material with these images (indices into Appearance::textures, first UV set, no transform) in place of all it has.
///   throws  invalid_input: the material's text is broken
Material with_textures(const Material& material, const std::vector<std::pair<TextureSlot, int>>& textures);

/// Adds an image as PNG, and a texture that wraps as `wrap` says and interpolates; its index in Appearance::textures.
int add_texture(Appearance& looks, std::string name, std::vector<unsigned char> png, Wrap wrap);

/// Copies a material with its images, textures and samplers; its index among the materials of `to`.
///   throws  invalid_input: no such material, broken text
int copy_material(const Character& from, int material, Appearance& to);

}  // namespace mien
