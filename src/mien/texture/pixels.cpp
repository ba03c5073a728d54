#include "mien/texture/pixels.h"

#include <png.h>

// After png.h: both declare jmp_buf's header in their own way.
#include <jpeglib.h>
#include <setjmp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "mien/core/error.h"

namespace mien {
namespace {

bool is_size(long long width, long long height) {
  return width >= 1 && height >= 1 && width <= max_image_side && height <= max_image_side &&
         width * height <= max_image_pixels;
}

std::string size_limit() {
  return "give sides from 1 to " + std::to_string(max_image_side) + ", at most " +
         std::to_string(max_image_pixels / 1'000'000) + " million pixels";
}

void check_size(long long width, long long height, const char* place) {
  if (!is_size(width, height))
    throw io_error(place, "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
                   size_limit());
}

Pixels decode_png_pixels(std::span<const unsigned char> bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
    throw io_error("PNG", std::string("is broken: ") + image.message, "give a whole PNG file");
  if (!is_size(image.width, image.height)) {
    png_image_free(&image);
    check_size(image.width, image.height, "PNG");
  }
  image.format = PNG_FORMAT_RGBA;
  Pixels pixels{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  pixels.rgba.resize(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, pixels.rgba.data(), 0, nullptr))
    throw io_error("PNG", std::string("is broken: ") + image.message, "give a whole PNG file");
  return pixels;
}

/// libjpeg reports errors by jumping out.
struct JpegError {
  jpeg_error_mgr manager;
  jmp_buf out;
  char message[JMSG_LENGTH_MAX];
};

void leave(j_common_ptr info) {
  auto* error = reinterpret_cast<JpegError*>(info->err);
  info->err->format_message(info, error->message);
  longjmp(error->out, 1);
}

/// Warnings mean that the data is damaged or cut off: the picture would be grey from there on.
void take_warning(j_common_ptr info, int level) {
  if (level < 0) leave(info);
}

/// What the jumping part needs, so that no object with a destructor lives in its frame.
struct JpegJob {
  jpeg_decompress_struct info{};
  JpegError error{};
  Pixels* pixels = nullptr;
  std::span<const unsigned char> bytes;
  bool too_large = false;
};

bool run(JpegJob& job) {
  jpeg_decompress_struct& info = job.info;
  if (setjmp(job.error.out)) return false;
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, job.bytes.data(), job.bytes.size());
  jpeg_read_header(&info, TRUE);
  job.pixels->width = static_cast<int>(info.image_width);
  job.pixels->height = static_cast<int>(info.image_height);
  job.too_large = !is_size(info.image_width, info.image_height);
  if (job.too_large) return false;
  info.out_color_space = JCS_EXT_RGBA;
  job.pixels->rgba.resize(std::size_t{4} * info.image_width * info.image_height);
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = job.pixels->rgba.data() + std::size_t{4} * info.output_scanline * info.output_width;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return true;
}

Pixels decode_jpeg_pixels(std::span<const unsigned char> bytes) {
  Pixels pixels;
  JpegJob job;
  job.pixels = &pixels;
  job.bytes = bytes;
  job.info.err = jpeg_std_error(&job.error.manager);
  job.error.manager.error_exit = leave;
  job.error.manager.emit_message = take_warning;
  const bool done = run(job);
  jpeg_destroy_decompress(&job.info);
  if (job.too_large) check_size(pixels.width, pixels.height, "JPEG");
  if (!done)
    throw io_error("JPEG", std::string("is broken: ") + job.error.message,
                   "give a whole JPEG file, grey or colour");
  return pixels;
}

/// Where a destination pixel's area lies in the source, along one side.
struct Span {
  int first = 0;
  std::vector<double> shares;  // sum to one
};

std::vector<Span> spans(int from, int to) {
  const double step = static_cast<double>(from) / to, reach = std::max(step, 1.0);
  std::vector<Span> result(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    // Down: the area under the pixel; up: a tent of one source pixel.
    const double middle = (i + 0.5) * step;
    const int low = static_cast<int>(std::floor(middle - reach)),
              high = static_cast<int>(std::ceil(middle + reach));
    Span& span = result[static_cast<std::size_t>(i)];
    span.first = std::clamp(low, 0, from - 1);
    span.shares.assign(static_cast<std::size_t>(std::clamp(high, 0, from - 1) - span.first + 1), 0.0);
    double sum = 0;
    for (int s = low; s <= high; ++s) {
      const double share =
          step > 1
              ? std::max(0.0, std::min(s + 1.0, middle + step / 2) - std::max<double>(s, middle - step / 2))
              : std::max(0.0, 1 - std::abs(s + 0.5 - middle));
      span.shares[static_cast<std::size_t>(std::clamp(s, 0, from - 1) - span.first)] += share;
      sum += share;
    }
    for (double& share : span.shares) share /= sum;
  }
  return result;
}

}  // namespace

Pixels decode_pixels(std::span<const unsigned char> bytes) {
  static constexpr std::array<unsigned char, 8> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (bytes.size() >= 8 && std::equal(png.begin(), png.end(), bytes.begin())) return decode_png_pixels(bytes);
  if (bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF)
    return decode_jpeg_pixels(bytes);
  throw io_error("image", bytes.empty() ? "has no bytes" : "is neither PNG nor JPEG", "give one of them");
}

std::vector<unsigned char> encode_pixels(const Pixels& pixels) {
  if (!is_size(pixels.width, pixels.height) ||
      pixels.rgba.size() != std::size_t{4} * pixels.width * pixels.height)
    throw invalid_input(
        "image", "is " + std::to_string(pixels.width) + " x " + std::to_string(pixels.height) + " pixels",
        size_limit());
  bool opaque = true;
  for (std::size_t i = 3; i < pixels.rgba.size() && opaque; i += 4) opaque = pixels.rgba[i] == 255;
  std::vector<std::uint8_t> rows = pixels.rgba;
  if (opaque)
    for (std::size_t i = 0; i < rows.size() / 4; ++i)
      std::copy_n(pixels.rgba.begin() + 4 * i, 3, rows.begin() + 3 * i);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.width);
  image.height = static_cast<png_uint_32>(pixels.height);
  image.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<unsigned char> bytes(size);
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rows.data(), 0, nullptr))
    throw io_error("image", std::string("cannot be encoded: ") + image.message);
  bytes.resize(size);
  return bytes;
}

Pixels resize_pixels(const Pixels& pixels, int width, int height) {
  if (!is_size(width, height))
    throw invalid_input(
        "image", "is asked for in " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
        size_limit());
  const std::vector<Span> across = spans(pixels.width, width), down = spans(pixels.height, height);
  Pixels result{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::array<double, 4> sum{};
      const Span &columns = across[static_cast<std::size_t>(x)], &rows = down[static_cast<std::size_t>(y)];
      for (std::size_t j = 0; j < rows.shares.size(); ++j)
        for (std::size_t i = 0; i < columns.shares.size(); ++i) {
          const std::uint8_t* from =
              pixels.rgba.data() + 4 * ((rows.first + j) * pixels.width + columns.first + i);
          const double share = rows.shares[j] * columns.shares[i], alpha = share * from[3];
          for (int k = 0; k < 3; ++k) sum[k] += alpha * from[k];
          sum[3] += alpha;
        }
      std::uint8_t* to = result.rgba.data() + 4 * (static_cast<std::size_t>(y) * width + x);
      for (int k = 0; k < 3; ++k)
        to[k] = static_cast<std::uint8_t>(sum[3] > 0 ? std::lround(sum[k] / sum[3]) : 0);
      to[3] = static_cast<std::uint8_t>(std::lround(sum[3]));
    }
  return result;
}

}  // namespace mien
