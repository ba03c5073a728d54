#pragma once
/// Pixels of an image file, and back: PNG and JPEG.

#include <cstdint>
#include <span>
#include <vector>

namespace mien {

/// Upper row first, from left to right; 4 bytes a pixel: red, green, blue in sRGB, straight alpha.
struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 x width x height
  bool operator==(const Pixels&) const = default;
};

/// The largest side of an image that mien decodes or makes.
constexpr int max_image_side = 16384;
constexpr long long max_image_pixels = 100'000'000;

/// Any PNG (16 bits and palettes become 8-bit RGBA), any grey or colour JPEG. Which one it is, its first bytes say.
///   throws  io: neither of them, broken, cut off, a JPEG in CMYK, more than `max_image_pixels`
///   cost    about 100 million bytes a second
Pixels decode_pixels(std::span<const unsigned char> bytes);

/// The bytes of a PNG, without alpha where every pixel is opaque.
///   throws  invalid_input: no pixels, or too many of them
std::vector<unsigned char> encode_pixels(const Pixels& pixels);

/// The image in another size: averaged down over areas, bilinear up. Alpha weighs colours.
Pixels resize_pixels(const Pixels& pixels, int width, int height);

}  // namespace mien
