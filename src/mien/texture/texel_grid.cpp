#include "mien/texture/texel_grid.h"

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

/// Twice the signed area of a triangle.
double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Pixels whose middles lie between two coordinates; none for what is far outside.
std::pair<int, int> pixel_range(double low, double high, int size) {
  const double first = std::ceil(low - 0.5), last = std::floor(high - 0.5);
  return {static_cast<int>(std::clamp(first, 0.0, static_cast<double>(size))),
          static_cast<int>(std::clamp(last, -1.0, size - 1.0))};
}

void draw(TexelGrid& grid, int number, std::array<Eigen::Vector2d, 3> corner) {
  const double area = cross(corner[0], corner[1], corner[2]);
  if (!std::isfinite(area) || area == 0) return;
  const auto [x0, x1] = pixel_range(std::min({corner[0].x(), corner[1].x(), corner[2].x()}),
                                    std::max({corner[0].x(), corner[1].x(), corner[2].x()}), grid.size);
  const auto [y0, y1] = pixel_range(std::min({corner[0].y(), corner[1].y(), corner[2].y()}),
                                    std::max({corner[0].y(), corner[1].y(), corner[2].y()}), grid.size);
  // Pixels on a common edge belong to the first face and are no overlap.
  constexpr double rim = 1e-7, inside = 1e-3;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      const Eigen::Vector3d at(cross(p, corner[1], corner[2]) / area, cross(corner[0], p, corner[2]) / area,
                               cross(corner[0], corner[1], p) / area);
      if (at.minCoeff() < -rim) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * grid.size + x;
      if (grid.triangle[pixel] >= 0) {
        grid.overlapping += at.minCoeff() > inside && grid.barycentric[pixel].minCoeff() > inside;
        continue;
      }
      grid.triangle[pixel] = number;
      grid.barycentric[pixel] = at.cast<float>();
      ++grid.covered;
    }
}

}  // namespace

TexelGrid rasterize(const std::vector<LayoutTriangle>& triangles, int size) {
  TexelGrid grid;
  grid.size = size;
  const std::size_t pixels = static_cast<std::size_t>(size) * size;
  grid.triangle.assign(pixels, -1);
  grid.barycentric.assign(pixels, Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<Eigen::Vector2d, 3> corner = triangles[t].uv;
    const Eigen::Vector2d middle = (corner[0] + corner[1] + corner[2]) / 3;
    if (!middle.allFinite()) continue;
    const Eigen::Vector2d tile = middle.array().floor();
    for (Eigen::Vector2d& c : corner) c = Eigen::Vector2d((c - tile).x(), 1 - (c - tile).y()) * size;
    draw(grid, static_cast<int>(t), corner);
  }
  return grid;
}

void grow_colors(Pixels& pixels, std::vector<char> known, int steps) {
  const int width = pixels.width, height = pixels.height;
  const auto number = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  std::vector<std::size_t> rim;  // unknown pixels beside known ones
  for (int step = 0; step < steps; ++step) {
    rim.clear();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (known[number(x, y)]) continue;
        std::array<int, 4> sum{};
        int count = 0;
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
          for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
            if (!known[number(i, j)]) continue;
            ++count;
            for (int k = 0; k < 4; ++k) sum[k] += pixels.rgba[4 * number(i, j) + k];
          }
        if (count == 0) continue;
        for (int k = 0; k < 4; ++k)
          pixels.rgba[4 * number(x, y) + k] = static_cast<std::uint8_t>((sum[k] + count / 2) / count);
        rim.push_back(number(x, y));
      }
    if (rim.empty()) return;
    for (const std::size_t pixel : rim) known[pixel] = 1;
  }
}

}  // namespace mien
