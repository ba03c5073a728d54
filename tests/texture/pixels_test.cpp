#include "mien/texture/pixels.h"

#include <gtest/gtest.h>

#include <string>

#include "mien/core/error.h"
#include "texture/images.h"

namespace mien {
namespace {

using Bytes = std::vector<unsigned char>;

std::string error_of(const Bytes& bytes) {
  try {
    decode_pixels(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(pixels, what_is_no_image_is_refused) {
  EXPECT_EQ(error_of({}), "image: has no bytes; give one of them");
  EXPECT_EQ(error_of({1, 2, 3}), "image: is neither PNG nor JPEG; give one of them");
  const Bytes png = encode_pixels(test::ramp(20, 10));
  for (const std::size_t size : {std::size_t{8}, std::size_t{20}, std::size_t{40}, png.size() / 2}) {
    SCOPED_TRACE(size);
    EXPECT_TRUE(error_of(Bytes(png.begin(), png.begin() + size)).starts_with("PNG: is broken"));
  }
  Bytes huge = png;
  huge[16] = huge[20] = 0x7f;
  EXPECT_NE(error_of(huge), "");
  const Bytes& jpeg = test::small_jpeg();
  EXPECT_TRUE(error_of(Bytes(jpeg.begin(), jpeg.begin() + 40)).starts_with("JPEG: is broken"));
  EXPECT_TRUE(error_of(Bytes(jpeg.begin(), jpeg.end() - 20)).starts_with("JPEG: is broken"));
}

TEST(pixels, any_byte_may_be_wrong) {
  for (const Bytes& whole : {encode_pixels(test::ramp(9, 7)), test::small_jpeg()})
    for (std::size_t i = 0; i < whole.size(); ++i) {
      Bytes broken = whole;
      broken[i] ^= 0x5a;
      error_of(broken);  // an error or pixels, nothing else
    }
}

TEST(pixels, sizes_that_are_no_image_are_refused) {
  EXPECT_THROW(encode_pixels({}), Error);
  EXPECT_THROW(encode_pixels({2, 2, {1, 2, 3}}), Error);
  EXPECT_THROW(resize_pixels(test::ramp(4, 4), 0, 4), Error);
}

TEST(pixels, png_brings_every_byte_back) {
  Pixels image = test::ramp(31, 17);
  EXPECT_EQ(decode_pixels(encode_pixels(image)), image);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = static_cast<std::uint8_t>(i);
  EXPECT_EQ(decode_pixels(encode_pixels(image)), image);
}

TEST(pixels, jpeg_brings_its_colours_back) {
  const Pixels image = decode_pixels(test::small_jpeg());
  ASSERT_EQ(image.width, 16);
  ASSERT_EQ(image.height, 8);
  const auto near = [&](int x, int r, int g, int b) {
    const std::uint8_t* p = image.rgba.data() + 4 * (4 * 16 + x);
    EXPECT_NEAR(p[0], r, 12);
    EXPECT_NEAR(p[1], g, 12);
    EXPECT_NEAR(p[2], b, 12);
    EXPECT_EQ(p[3], 255);
  };
  near(2, 220, 40, 40);
  near(13, 40, 60, 210);
}

TEST(pixels, a_smaller_image_is_the_mean_and_alpha_weighs) {
  Pixels image = test::ramp(4, 2);
  for (int i = 0; i < 8; ++i) image.rgba[4 * i + 3] = i % 2 ? 0 : 255;
  const Pixels half = resize_pixels(image, 2, 1);
  EXPECT_EQ(half.rgba[3], 128);
  // Only columns 0 and 2 are seen.
  EXPECT_EQ(half.rgba[0], (image.rgba[0] + image.rgba[16] + 1) / 2);
  const Pixels same = resize_pixels(test::ramp(5, 3), 5, 3);
  EXPECT_EQ(same, test::ramp(5, 3));
}

}  // namespace
}  // namespace mien
