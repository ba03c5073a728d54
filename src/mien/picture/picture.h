#pragma once
/// A picture in memory, and as PNG.

#include <cstdint>
#include <vector>

namespace mien {

/// sRGB, each in [0, 1].
struct Color {
  float r = 0, g = 0, b = 0;
  bool operator==(const Color&) const = default;
};

/// Opaque pixels, upper row first, from left to right. (`Image` is a texture's file inside a character.)
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 x width x height, sRGB; alpha is 255
  bool operator==(const Picture&) const = default;
};

/// The largest picture that mien makes or reads, in pixels.
constexpr int max_picture_side = 16384;
constexpr long long max_picture_pixels = 100'000'000;

/// A picture of one colour.
///   throws  invalid_input: a side below 1 or above `max_picture_side`, more than `max_picture_pixels`
Picture blank_picture(int width, int height, Color color = {1, 1, 1});

/// `picture` averaged down or interpolated up to another size.
Picture resize(const Picture& picture, int width, int height);

/// The bytes of a PNG file.
std::vector<unsigned char> encode_png(const Picture& picture);

/// Reads a PNG (any colour type; transparency over white).
///   throws  io_error: not a PNG, or broken
Picture decode_png(const std::vector<unsigned char>& bytes);

}  // namespace mien
