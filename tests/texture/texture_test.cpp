#include "mien/texture/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "mien/core/error.h"
#include "mien/texture/retexture.h"
#include "texture/images.h"

namespace mien {
namespace {

/// Two by two: red, green above; blue, white below.
Pixels four() {
  return {2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 128}};
}

Character with_material(const std::string& material) {
  Character c;
  c.appearance.materials.resize(1);
  c.appearance.materials[0].name = "skin";
  c.appearance.materials[0].carried = material;
  add_texture(c.appearance, "albedo", encode_pixels(four()), Wrap::repeat);
  return c;
}

std::string error_of(const Character& c) {
  try {
    if (const auto use = texture_of(c, 0, TextureSlot::base_color)) Texture(c, *use);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

const std::string plain = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";

TEST(texture, broken_materials_and_images_are_named) {
  EXPECT_EQ(error_of(with_material("{")), "material skin: is not a JSON object; carry a glTF material");
  EXPECT_EQ(error_of(with_material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":3}}})")),
            "material skin: names index 3; there are 1");
  Character c = with_material(plain);
  c.appearance.images[0].bytes.clear();
  EXPECT_EQ(error_of(c), "image albedo: is not there; put its file beside the character's");
  c.appearance.images[0].bytes = {1, 2};
  EXPECT_EQ(error_of(c), "image albedo: image: is neither PNG nor JPEG; give one of them");
  c.appearance.textures[0] = R"({"source":7})";
  EXPECT_EQ(error_of(c), "material skin: names source 7; there are 1");
}

TEST(texture, a_material_says_which_image_and_how) {
  EXPECT_FALSE(texture_of(with_material("{}"), 0, TextureSlot::base_color));
  EXPECT_FALSE(texture_of(with_material(plain), 0, TextureSlot::normal));
  EXPECT_FALSE(texture_of(with_material(plain), 5, TextureSlot::base_color));
  Character c = with_material(
      R"({"normalTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[1,2],"scale":[3,4],"rotation":5,"texCoord":2}}}})");
  c.appearance.samplers[0] = R"({"wrapS":33648,"wrapT":33071,"magFilter":9728})";
  const auto use = texture_of(c, 0, TextureSlot::normal);
  ASSERT_TRUE(use);
  EXPECT_EQ(use->uv_set, 2);
  EXPECT_EQ(use->offset, Eigen::Vector2d(1, 2));
  EXPECT_EQ(use->scale, Eigen::Vector2d(3, 4));
  EXPECT_EQ(use->rotation, 5);
  EXPECT_EQ(use->wrap_u, Wrap::mirror);
  EXPECT_EQ(use->wrap_v, Wrap::clamp);
  EXPECT_FALSE(use->smooth);
}

TEST(texture, alpha_modes_are_read) {
  EXPECT_EQ(alpha_of(with_material("{}"), 0).mode, AlphaMode::opaque);
  EXPECT_EQ(alpha_of(with_material(R"({"alphaMode":"BLEND"})"), 0).mode, AlphaMode::blend);
  const AlphaUse mask = alpha_of(with_material(R"({"alphaMode":"MASK","alphaCutoff":0.25})"), 0);
  EXPECT_EQ(mask.mode, AlphaMode::mask);
  EXPECT_EQ(mask.cutoff, 0.25f);
}

Eigen::Vector4f look_up(const TextureUse& use, float u, float v) {
  return Texture(four(), use).stored({u, v});
}

TEST(texture, uvs_point_up_and_are_interpolated) {
  const TextureUse use;
  EXPECT_EQ(look_up(use, 0.25f, 0.75f), Eigen::Vector4f(1, 0, 0, 1));
  EXPECT_EQ(look_up(use, 0.75f, 0.75f), Eigen::Vector4f(0, 1, 0, 1));
  EXPECT_EQ(look_up(use, 0.25f, 0.25f), Eigen::Vector4f(0, 0, 1, 1));
  EXPECT_NEAR(look_up(use, 0.75f, 0.25f)[3], 128 / 255.f, 1e-6);
  EXPECT_TRUE(look_up(use, 0.5f, 0.75f).isApprox(Eigen::Vector4f(0.5f, 0.5f, 0, 1)));
  EXPECT_TRUE(look_up(use, 0.25f, 0.5f).isApprox(Eigen::Vector4f(0.5f, 0, 0.5f, 1)));
}

TEST(texture, colours_are_mixed_in_linear_light) {
  const Texture grey({1, 1, {188, 0, 255, 255}}, {});
  EXPECT_NEAR(grey.linear({0.5f, 0.5f})[0], 0.5029f, 1e-3);
  EXPECT_EQ(grey.linear({0.5f, 0.5f})[2], 1.f);
}

TEST(texture, beyond_the_image_it_repeats_mirrors_or_stops) {
  TextureUse use;
  EXPECT_EQ(look_up(use, 1.25f, 0.75f), look_up(use, 0.25f, 0.75f));
  EXPECT_EQ(look_up(use, -0.75f, -1.25f), look_up(use, 0.25f, 0.75f));
  EXPECT_TRUE(look_up(use, 0, 0.75f).isApprox(Eigen::Vector4f(0.5f, 0.5f, 0, 1)));  // with the other side
  use.wrap_u = use.wrap_v = Wrap::clamp;
  EXPECT_EQ(look_up(use, 9.f, 0.75f), look_up(use, 0.75f, 0.75f));
  EXPECT_EQ(look_up(use, -9.f, 0.75f), look_up(use, 0.25f, 0.75f));
  EXPECT_EQ(look_up(use, 0, 0.75f), look_up(use, 0.25f, 0.75f));
  use.wrap_u = use.wrap_v = Wrap::mirror;
  EXPECT_EQ(look_up(use, 1.25f, 0.75f), look_up(use, 0.75f, 0.75f));
  EXPECT_EQ(look_up(use, -0.25f, 0.75f), look_up(use, 0.25f, 0.75f));
  use.smooth = false;
  EXPECT_EQ(look_up(use, 0.45f, 0.75f), Eigen::Vector4f(1, 0, 0, 1));
  EXPECT_TRUE(look_up(use, 1e30f, 0).allFinite());
  EXPECT_TRUE(look_up(use, NAN, 0).allFinite());
}

TEST(texture, the_transform_is_that_of_the_extension) {
  // The specification's example: the lower left quarter, turned by a right angle.
  TextureUse use;
  use.offset = {0, 1};
  use.rotation = std::numbers::pi / 2;
  use.scale = {0.5, 0.5};
  // (u, v down) = (0.5, 0.5) -> (0.25, 0.75): the middle of the lower left pixel.
  EXPECT_TRUE(look_up(use, 0.5f, 0.5f).isApprox(Eigen::Vector4f(0, 0, 1, 1), 1e-5f));
}

TEST(retexture, images_are_replaced_and_all_else_stays) {
  Material material;
  material.name = "skin";
  material.carried =
      R"({"alphaMode":"MASK","extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":4}}},"normalTexture":{"index":2},"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1},"roughnessFactor":0.5}})";
  const Material result = with_textures(material, {{TextureSlot::base_color, 7}, {TextureSlot::emissive, 8}});
  EXPECT_EQ(
      result.carried,
      R"({"alphaMode":"MASK","emissiveTexture":{"index":8},"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}},"pbrMetallicRoughness":{"baseColorTexture":{"index":7},"roughnessFactor":0.5}})");
  material.carried = "[";
  EXPECT_THROW(with_textures(material, {}), Error);
}

TEST(retexture, a_copied_material_brings_its_images) {
  const Character from = with_material(plain);
  Character to = with_material("{}");
  EXPECT_EQ(copy_material(from, 0, to.appearance), 1);
  const auto use = texture_of(to, 1, TextureSlot::base_color);
  ASSERT_TRUE(use);
  EXPECT_EQ(use->texture, 1);
  EXPECT_EQ(use->image, 1);
  EXPECT_EQ(Texture(to, *use).pixels(), four());
  EXPECT_THROW(copy_material(from, 1, to.appearance), Error);
}

}  // namespace
}  // namespace mien
