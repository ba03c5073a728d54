#include "mien/picture/picture.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "mien/core/error.h"
#include "mien/picture/detail/canvas.h"

namespace mien {
namespace {

cairo_status_t append(void* closure, const unsigned char* data, unsigned int length) {
  auto& bytes = *static_cast<std::vector<unsigned char>*>(closure);
  bytes.insert(bytes.end(), data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

struct Source {
  const std::vector<unsigned char>& bytes;
  std::size_t at = 0;
};

cairo_status_t take(void* closure, unsigned char* data, unsigned int length) {
  auto& source = *static_cast<Source*>(closure);
  if (source.bytes.size() - source.at < length) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(data, source.bytes.data() + source.at, length);
  source.at += length;
  return CAIRO_STATUS_SUCCESS;
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.f, 1.f) * 255));
}

bool is_too_large(long long width, long long height) {
  return width < 1 || height < 1 || width > max_picture_side || height > max_picture_side ||
         width * height > max_picture_pixels;
}

std::string size_limit() {
  return "sides from 1 to " + std::to_string(max_picture_side) + ", at most " +
         std::to_string(max_picture_pixels / 1'000'000) + " million pixels";
}

/// PNG's header states its size right after the signature: a picture too large is refused before it is
/// decoded.
void check_png_header(const std::vector<unsigned char>& bytes) {
  static constexpr unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (bytes.size() < 24 || !std::equal(signature, signature + 8, bytes.begin()))
    throw io_error("picture", "is not a PNG", "a PNG file");
  const auto side = [&](std::size_t at) {
    return static_cast<long long>(bytes[at]) << 24 | bytes[at + 1] << 16 | bytes[at + 2] << 8 | bytes[at + 3];
  };
  if (is_too_large(side(16), side(20)))
    throw io_error("PNG", "has " + std::to_string(side(16)) + " x " + std::to_string(side(20)) + " pixels",
                   size_limit());
}

}  // namespace

Picture blank_picture(int width, int height, Color color) {
  if (is_too_large(width, height))
    throw invalid_input("picture", "is " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
                        size_limit());
  Picture picture{width, height, {}};
  picture.rgba.resize(std::size_t{4} * width * height);
  const std::uint8_t pixel[4] = {byte_of(color.r), byte_of(color.g), byte_of(color.b), 255};
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) picture.rgba[i] = pixel[i % 4];
  return picture;
}

Picture resize(const Picture& picture, int width, int height) {
  Picture result = blank_picture(width, height);
  detail::Canvas canvas(result);
  canvas.draw(picture, 0, 0, width, height);
  canvas.finish();
  return result;
}

std::vector<unsigned char> encode_png(const Picture& picture) {
  const detail::Surface surface(picture);
  std::vector<unsigned char> bytes;
  if (cairo_surface_write_to_png_stream(surface.get(), append, &bytes) != CAIRO_STATUS_SUCCESS)
    throw io_error("picture", "cannot be encoded as PNG");
  return bytes;
}

Picture decode_png(const std::vector<unsigned char>& bytes) {
  check_png_header(bytes);
  Source source{bytes};
  cairo_surface_t* decoded = cairo_image_surface_create_from_png_stream(take, &source);
  if (cairo_surface_status(decoded) != CAIRO_STATUS_SUCCESS) {
    cairo_surface_destroy(decoded);
    throw io_error("PNG", "is broken", "a whole PNG file");
  }
  Picture picture =
      blank_picture(cairo_image_surface_get_width(decoded), cairo_image_surface_get_height(decoded));
  detail::Canvas canvas(picture);
  canvas.draw(decoded);
  cairo_surface_destroy(decoded);
  canvas.finish();
  return picture;
}

}  // namespace mien
