#pragma once
/// The images of a character's materials: which one a material asks for, and its colours at UVs.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/texture/pixels.h"

namespace mien {

/// The images that a glTF material may name.
enum class TextureSlot { base_color, metallic_roughness, normal, occlusion, emissive };
std::string_view name_of(TextureSlot slot);

/// How far UVs go on beyond [0, 1].
enum class Wrap { repeat, mirror, clamp };

/// What a material says about one of its images (KHR_texture_transform included).
struct TextureUse {
  int texture = -1;  ///< index into Appearance::textures
  int image = -1;    ///< index into Appearance::images
  int uv_set = 0;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool smooth = true;  ///< between pixels; false: the nearest one
  Eigen::Vector2d offset = Eigen::Vector2d::Zero(), scale = Eigen::Vector2d::Ones();
  double rotation = 0;  ///< radians, counter-clockwise with v down
};

/// How a material's alpha counts.
enum class AlphaMode { opaque, mask, blend };
struct AlphaUse {
  AlphaMode mode = AlphaMode::opaque;
  float cutoff = 0.5f;  ///< of a mask
  bool operator==(const AlphaUse&) const = default;
};

/// The image in a slot of a material; none when there is none or nothing that names one.
///   throws  invalid_input: the material's text is broken or names what is not there
std::optional<TextureUse> texture_of(const Character& character, int material, TextureSlot slot);
///   throws  invalid_input: the material's text is broken
AlphaUse alpha_of(const Character& character, int material);

/// An image ready to be looked up.
class Texture {
 public:
  ///   throws  io: the image has no bytes or cannot be decoded (names it)
  Texture(const Character& character, const TextureUse& use);
  Texture(Pixels pixels, const TextureUse& use) : pixels_(std::move(pixels)), use_(use) {}

  const Pixels& pixels() const { return pixels_; }
  const TextureUse& use() const { return use_; }
  /// Stored numbers (sRGB for colours) and alpha, each in [0, 1], at a UV with v up, as UvSet has it.
  Eigen::Vector4f stored(const Eigen::Vector2f& uv) const;
  /// The same in linear RGB, interpolated there.
  Eigen::Vector4f linear(const Eigen::Vector2f& uv) const;

 private:
  template <typename Decode>
  Eigen::Vector4f at(const Eigen::Vector2f& uv, const Decode& decode) const;
  Pixels pixels_;
  TextureUse use_;
};

/// UV of each corner of a face, v up; the use's UV set. None: the mesh or a corner has no UV there.
bool corner_uvs(const Mesh& mesh, int uv_set, int face, std::vector<Eigen::Vector2f>& uvs);

}  // namespace mien
