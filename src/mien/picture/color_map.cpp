#include "mien/picture/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

constexpr std::array<Color, 6> heat{{{0.86f, 0.86f, 0.86f},
                                     {0.99f, 0.90f, 0.55f},
                                     {0.99f, 0.68f, 0.25f},
                                     {0.92f, 0.34f, 0.14f},
                                     {0.68f, 0.08f, 0.15f},
                                     {0.32f, 0.00f, 0.20f}}};
constexpr std::array<Color, 6> viridis{{{0.267f, 0.005f, 0.329f},
                                        {0.254f, 0.265f, 0.530f},
                                        {0.164f, 0.471f, 0.558f},
                                        {0.135f, 0.659f, 0.518f},
                                        {0.478f, 0.821f, 0.318f},
                                        {0.993f, 0.906f, 0.144f}}};
constexpr std::array<Color, 5> cool_warm{{{0.13f, 0.32f, 0.68f},
                                          {0.50f, 0.69f, 0.87f},
                                          {0.88f, 0.88f, 0.88f},
                                          {0.93f, 0.58f, 0.45f},
                                          {0.71f, 0.09f, 0.15f}}};

std::span<const Color> colors_of(ColorMap map) {
  if (map == ColorMap::viridis) return viridis;
  if (map == ColorMap::cool_warm) return cool_warm;
  return heat;
}

}  // namespace

Color map_color(ColorMap map, double u) {
  if (std::isnan(u)) return {0.6f, 0.6f, 0.6f};
  const auto colors = colors_of(map);
  const double at = std::clamp(u, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(at), colors.size() - 2);
  const float f = static_cast<float>(at - static_cast<double>(k));
  const Color &a = colors[k], &b = colors[k + 1];
  return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b)};
}

ColorMap color_map_of_name(std::string_view name) {
  if (name == "heat") return ColorMap::heat;
  if (name == "viridis") return ColorMap::viridis;
  if (name == "cool-warm") return ColorMap::cool_warm;
  throw invalid_input("color map " + std::string(name), "does not exist", "heat, viridis or cool-warm");
}

}  // namespace mien
