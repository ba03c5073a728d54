// Pictures with the images and vertex colours of the character.

#include <gmock/gmock.h>

#include <array>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/picture/render.h"
#include "mien/texture/retexture.h"
#include "shapes_in_code.h"

namespace mien {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A square in the plane z = 0 that fills the picture, u to the right and v up.
Part square(const std::string& name, float z = 0, float size = 1) {
  Part part;
  part.name = name;
  part.mesh.positions.resize(4, 3);
  part.mesh.positions << -size, -size, z, size, -size, z, size, size, z, -size, size, z;
  part.mesh.faces.push_back({0, 1, 2, 3});
  Points2 uv(4, 2);
  uv << 0, 0, 1, 0, 1, 1, 0, 1;
  part.mesh.uvs = {{uv, {}}};
  part.mesh.groups = {{"", 0, 0, 1, 0, 4}};
  return part;
}

/// Left half red, right half blue; the upper half of the picture is opaque, the lower half has `alpha`.
Pixels halves(std::uint8_t alpha = 255) {
  Pixels pixels{8, 8, {}};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      pixels.rgba.insert(pixels.rgba.end(),
                         {static_cast<std::uint8_t>(x < 4 ? 230 : 20), 20,
                          static_cast<std::uint8_t>(x < 4 ? 20 : 230), y < 4 ? std::uint8_t{255} : alpha});
  return pixels;
}

Character painted(const Pixels& pixels, const std::string& more = "") {
  Character c = character_of({square("plate")});
  const int texture = add_texture(c.appearance, "halves", encode_pixels(pixels), Wrap::clamp);
  Material material;
  material.name = "paint";
  material.base_color = Eigen::Vector4f::Ones();
  material.carried = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + std::to_string(texture) +
                     "}}" + more + "}";
  c.appearance.materials = {material};
  return c;
}

struct Shot {
  Picture picture;
  std::vector<std::string> warnings;
  /// The colour at a share of width and height, from the upper left.
  std::array<int, 3> at(double x, double y) const {
    const std::size_t pixel = static_cast<std::size_t>(y * picture.height) * picture.width +
                              static_cast<std::size_t>(x * picture.width);
    return {picture.rgba[4 * pixel], picture.rgba[4 * pixel + 1], picture.rgba[4 * pixel + 2]};
  }
};

Shot shoot(const Character& c, Surfaces surfaces = Surfaces::painted) {
  RenderOptions options;
  options.width = options.height = 64;
  const Renderer renderer(c, surfaces);
  return {renderer.render(positions_of(c), options), renderer.warnings()};
}

bool is_red(const std::array<int, 3>& c) {
  return c[0] > c[1] + 60 && c[0] > c[2] + 60;
}
bool is_blue(const std::array<int, 3>& c) {
  return c[2] > c[0] + 60 && c[2] > c[1] + 60;
}

TEST(painted, broken_images_are_said_and_leave_the_base_colour) {
  Character c = painted(halves());
  c.appearance.materials[0].base_color = {0.1f, 0.8f, 0.1f, 1};
  const auto plain = shoot(c, Surfaces::clay).picture;
  for (const std::vector<unsigned char>& bytes : {std::vector<unsigned char>{}, {1, 2, 3}}) {
    c.appearance.images[0].bytes = bytes;
    const Shot shot = shoot(c);
    EXPECT_THAT(shot.warnings, ElementsAre(HasSubstr("image halves: ")));
    EXPECT_EQ(shot.picture, plain);
  }
  c.appearance.materials[0].carried = "{";
  EXPECT_THAT(shoot(c).warnings, ElementsAre(HasSubstr("material paint: is not a JSON object")));
}

TEST(painted, clay_shows_no_images) {
  const Shot shot = shoot(painted(halves()), Surfaces::clay);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(shot.at(0.3, 0.5)[k], shot.at(0.7, 0.5)[k], 4);
}

TEST(painted, images_lie_where_the_uvs_say) {
  const Shot shot = shoot(painted(halves()));
  EXPECT_THAT(shot.warnings, ElementsAre());
  EXPECT_TRUE(is_red(shot.at(0.3, 0.3)));
  EXPECT_TRUE(is_red(shot.at(0.3, 0.7)));
  EXPECT_TRUE(is_blue(shot.at(0.7, 0.5)));
}

TEST(painted, corners_without_a_uv_keep_the_base_colour) {
  Character c = painted(halves());
  c.parts[0].mesh.uvs[0].corners = {0, 1, 2, -1};
  const Shot shot = shoot(c);
  EXPECT_FALSE(is_red(shot.at(0.3, 0.5)));
  c.parts[0].mesh.uvs.clear();
  EXPECT_EQ(shoot(c).picture, shoot(c, Surfaces::clay).picture);
}

TEST(painted, vertex_colours_and_the_factor_multiply) {
  Character c = painted(halves());
  c.appearance.materials[0].base_color = {1, 1, 0, 1};
  const Shot no_blue = shoot(c);
  EXPECT_TRUE(is_red(no_blue.at(0.3, 0.5)));
  EXPECT_LT(no_blue.at(0.7, 0.5)[2], 40);
  c.appearance.materials[0].carried.clear();
  c.appearance.materials[0].base_color = Eigen::Vector4f::Ones();
  c.parts[0].mesh.colors = {Points4::Ones(4, 4)};
  c.parts[0].mesh.colors[0].col(0) << 0, 1, 1, 0;
  c.parts[0].mesh.colors[0].col(1).setZero();
  c.parts[0].mesh.colors[0].col(2) << 1, 0, 0, 1;
  const Shot shot = shoot(c);
  EXPECT_TRUE(is_blue(shot.at(0.2, 0.5)));
  EXPECT_TRUE(is_red(shot.at(0.8, 0.5)));
}

TEST(painted, masks_cut_and_blends_mix) {
  const auto behind = [](const std::string& more, std::uint8_t alpha) {
    Character c = painted(halves(alpha), more);
    c.parts.push_back(square("wall", -0.2f, 1.1f));
    c.parts[1].mesh.groups[0].material = 1;
    c.appearance.materials.emplace_back();
    c.appearance.materials[1].base_color = {0.02f, 0.9f, 0.02f, 1};
    return shoot(c);
  };
  const auto is_green = [](const std::array<int, 3>& c) { return c[1] > c[0] + 60 && c[1] > c[2] + 60; };
  const Shot opaque = behind("", 0);
  EXPECT_TRUE(is_red(opaque.at(0.3, 0.7)));
  const Shot masked = behind(R"(,"alphaMode":"MASK")", 100);
  EXPECT_TRUE(is_red(masked.at(0.3, 0.3)));
  EXPECT_TRUE(is_green(masked.at(0.3, 0.7)));
  EXPECT_TRUE(is_red(behind(R"(,"alphaMode":"MASK","alphaCutoff":0.3)", 100).at(0.3, 0.7)));
  const Shot mixed = behind(R"(,"alphaMode":"BLEND")", 128);
  EXPECT_GT(mixed.at(0.3, 0.7)[0], 100);
  EXPECT_GT(mixed.at(0.3, 0.7)[1], 100);
  EXPECT_TRUE(is_green(behind(R"(,"alphaMode":"BLEND")", 0).at(0.7, 0.7)));
}

TEST(painted, any_number_of_threads_draws_the_same) {
  const Character c = painted(halves(128), R"(,"alphaMode":"BLEND")");
  set_thread_count(1);
  const Picture one = shoot(c).picture;
  set_thread_count(0);
  EXPECT_EQ(one, shoot(c).picture);
}

}  // namespace
}  // namespace mien
