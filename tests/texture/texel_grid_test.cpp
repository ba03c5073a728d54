#include "mien/texture/texel_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

LayoutTriangle triangle(double ax, double ay, double bx, double by, double cx, double cy) {
  return {{Eigen::Vector2d(ax, ay), Eigen::Vector2d(bx, by), Eigen::Vector2d(cx, cy)}};
}

TEST(texel_grid, what_is_no_triangle_covers_nothing) {
  EXPECT_EQ(rasterize({}, 8).covered, 0u);
  EXPECT_EQ(rasterize({triangle(0, 0, 1, 1, 0.5, 0.5)}, 8).covered, 0u);
  EXPECT_EQ(rasterize({triangle(NAN, 0, 1, 1, 0, 1), triangle(1e300, 0, 1e300, 1, 0, 1e300)}, 8).covered, 0u);
}

TEST(texel_grid, two_halves_of_a_square_cover_it_once) {
  const TexelGrid grid = rasterize({triangle(0, 0, 1, 0, 1, 1), triangle(0, 0, 1, 1, 0, 1)}, 16);
  EXPECT_EQ(grid.covered, 256u);
  EXPECT_EQ(grid.overlapping, 0u);
  EXPECT_EQ(grid.triangle[15 * 16 + 15], 0);  // right and below
  EXPECT_EQ(grid.triangle[0], 1);             // left and above
  const Eigen::Vector3f at = grid.barycentric[15 * 16 + 8];
  EXPECT_NEAR(at[0], 1 - 8.5 / 16, 1e-6);
  EXPECT_NEAR(at.sum(), 1, 1e-6);
}

TEST(texel_grid, faces_on_one_another_are_counted) {
  const LayoutTriangle half = triangle(0, 0, 1, 0, 1, 1);
  const TexelGrid grid = rasterize({half, half}, 16);
  EXPECT_GT(grid.overlapping, 100u);
  EXPECT_TRUE(std::none_of(grid.triangle.begin(), grid.triangle.end(), [](int t) { return t == 1; }));
}

TEST(texel_grid, charts_in_other_tiles_come_back) {
  const TexelGrid first = rasterize({triangle(0.1, 0.2, 0.8, 0.3, 0.4, 0.9)}, 32);
  const TexelGrid far = rasterize({triangle(-2.9, 5.2, -2.2, 5.3, -2.6, 5.9)}, 32);
  EXPECT_EQ(first.triangle, far.triangle);
}

TEST(texel_grid, colours_grow_over_the_rim) {
  Pixels pixels{5, 1, std::vector<std::uint8_t>(20, 0)};
  pixels.rgba[8] = 200;
  grow_colors(pixels, {0, 0, 1, 0, 0}, 1);
  EXPECT_EQ(pixels.rgba[4], 200);
  EXPECT_EQ(pixels.rgba[12], 200);
  EXPECT_EQ(pixels.rgba[0], 0);
}

}  // namespace
}  // namespace mien
