#include "mien/transfer/bake_textures.h"

#include <gmock/gmock.h>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/texture/retexture.h"

namespace mien {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A plate of n x n quads in the plane z = 0 on [0, 1]^2 whose UVs are its places, or turned by a right angle.
Part plate(int n, bool turned = false) {
  Part part;
  part.name = "plate";
  Points2 uv((n + 1) * (n + 1), 2);
  part.mesh.positions.resize(uv.rows(), 3);
  for (int v = 0; v < uv.rows(); ++v) {
    const float x = float(v % (n + 1)) / float(n), y = float(v / (n + 1)) / float(n);
    part.mesh.positions.row(v) << x, y, 0;
    uv.row(v) << (turned ? y : x), (turned ? 1 - x : y);
  }
  for (int f = 0; f < n * n; ++f) {
    const int a = f / n * (n + 1) + f % n;
    part.mesh.faces.push_back({a, a + 1, a + n + 2, a + n + 1});
  }
  part.mesh.uvs = {{uv, {}}};
  return part;
}

/// Red grows with x, green with y (up).
Pixels gradient(int size) {
  Pixels pixels{size, size, {}};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      pixels.rgba.insert(pixels.rgba.end(),
                         {static_cast<std::uint8_t>(255 * (x + 0.5) / size),
                          static_cast<std::uint8_t>(255 * (1 - (y + 0.5) / size)), 40, 255});
  return pixels;
}

Character source_plate(const std::string& more = "") {
  Character c;
  c.parts = {plate(4)};
  c.parts[0].mesh.groups = {{"", 0, 0, 16, 0, 25}};
  const int texture = add_texture(c.appearance, "gradient", encode_pixels(gradient(64)), Wrap::clamp);
  c.appearance.materials.resize(1);
  c.appearance.materials[0].name = "paint";
  c.appearance.materials[0].base_color = Eigen::Vector4f::Ones();
  c.appearance.materials[0].carried = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" +
                                      std::to_string(texture) + "}}" + more + "}";
  return c;
}

Character target_plate() {
  Character c;
  c.parts = {plate(3, true)};
  return c;
}

std::vector<Points> in_place(const Character& c) {
  std::vector<Points> guide;
  for (const Part& part : c.parts) guide.push_back(part.mesh.positions);
  return guide;
}

BakeResult bake(const Character& source, const Character& target, int size = 64) {
  BakeOptions options;
  options.size = size;
  return bake_textures(source, in_place(source), target, options);
}

std::string error_of(const Character& source, const Character& target, int size = 64) {
  try {
    bake(source, target, size);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(bake_textures, invalid_inputs) {
  const Character source = source_plate(), target = target_plate();
  EXPECT_THROW(bake_textures(source, {}, target), Error);
  EXPECT_THROW(bake_textures(source, {Points::Zero(3, 3)}, target), Error);
  EXPECT_EQ(error_of(source, target, 8), "size: is 8; give 16 to 8192 pixels");
  Character bare = source;
  bare.appearance.materials[0].carried = "{}";
  EXPECT_EQ(error_of(bare, target),
            "source: has no base-colour image; give a source whose materials have images");
  Character no_uvs = target;
  no_uvs.parts[0].mesh.uvs.clear();
  EXPECT_EQ(error_of(source, no_uvs),
            "target: has no UVs of its own; without baking, it takes the source's UVs and image");
  Character missing = source;
  missing.appearance.images[0].bytes.clear();
  EXPECT_EQ(error_of(missing, target), "image gradient: is not there; put its file beside the character's");
}

TEST(bake_textures, colours_stay_on_their_places_of_the_surface) {
  const Character source = source_plate(), target = target_plate();
  const BakeResult result = bake(source, target);
  ASSERT_EQ(result.images.size(), 1u);
  EXPECT_EQ(result.images[0].material, "paint");
  EXPECT_THAT(result.images[0].parts, ElementsAre("plate"));
  EXPECT_THAT(result.images[0].slots, ElementsAre("baseColorTexture"));
  EXPECT_NEAR(result.images[0].covered, 1, 1e-9);
  EXPECT_EQ(result.images[0].overlap, 0);
  EXPECT_TRUE(result.warnings.empty());
  const Character& c = result.character;
  EXPECT_EQ(c.parts[0].mesh.positions, target.parts[0].mesh.positions);
  const int material = c.parts[0].mesh.groups.at(0).material;
  const auto use = texture_of(c, material, TextureSlot::base_color);
  ASSERT_TRUE(use);
  const Texture baked(c, *use);
  const Texture original(source, *texture_of(source, 0, TextureSlot::base_color));
  for (const float x : {0.1f, 0.35f, 0.8f})
    for (const float y : {0.2f, 0.6f, 0.9f}) {
      const Eigen::Vector4f expected = original.stored({x, y}), found = baked.stored({y, 1 - x});
      EXPECT_LT((expected - found).cwiseAbs().maxCoeff(), 0.02) << x << " " << y;
    }
}

TEST(bake_textures, the_factor_is_painted_in) {
  Character source = source_plate();
  source.appearance.materials[0].base_color = {1, 0, 1, 1};
  const BakeResult result = bake(source, target_plate());
  const int material = result.character.parts[0].mesh.groups.at(0).material;
  EXPECT_EQ(result.character.appearance.materials[material].base_color,
            Eigen::Vector4f(Eigen::Vector4f::Ones()));
  const Texture baked(result.character, *texture_of(result.character, material, TextureSlot::base_color));
  EXPECT_EQ(baked.stored({0.5f, 0.5f})[1], 0);
  EXPECT_GT(baked.stored({0.5f, 0.5f})[0], 0.3f);
}

TEST(bake_textures, overlaps_and_normal_maps_are_said) {
  Character target = target_plate();
  target.parts[0].mesh.uvs[0].coordinates.col(0) *= 0.5f;
  Part twin = target.parts[0];
  twin.name = "twin";
  target.parts.push_back(twin);
  target.appearance.materials.resize(1);
  target.appearance.materials[0].name = "shared";
  for (Part& part : target.parts) part.mesh.groups = {{"", 0, 0, 9, 0, 16}};
  const BakeResult result =
      bake(source_plate(R"(,"normalTexture":{"index":0},"emissiveTexture":{"index":0})"), target);
  ASSERT_EQ(result.images.size(), 1u);
  EXPECT_THAT(result.images[0].parts, ElementsAre("plate", "twin"));
  EXPECT_THAT(result.images[0].slots, ElementsAre("baseColorTexture", "emissiveTexture"));
  EXPECT_GT(result.images[0].overlap, 0.9);
  ASSERT_EQ(result.warnings.size(), 2u);
  EXPECT_THAT(result.warnings[0].what, HasSubstr("the UVs of material shared overlap in"));
  EXPECT_THAT(result.warnings[1].what, HasSubstr("the normal map of material paint is left behind"));
  const int material = result.character.parts[0].mesh.groups[0].material;
  EXPECT_FALSE(texture_of(result.character, material, TextureSlot::normal));
  EXPECT_TRUE(texture_of(result.character, material, TextureSlot::emissive));
}

TEST(bake_textures, any_number_of_threads_bakes_the_same) {
  set_thread_count(1);
  const BakeResult one = bake(source_plate(), target_plate());
  set_thread_count(0);
  const BakeResult all = bake(source_plate(), target_plate());
  EXPECT_EQ(one.character.appearance.images.back().bytes, all.character.appearance.images.back().bytes);
}

}  // namespace
}  // namespace mien
