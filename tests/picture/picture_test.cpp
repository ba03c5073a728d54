#include "mien/picture/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error_of.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;

Picture checkered() {
  Picture picture = blank_picture(7, 5, {0.2f, 0.4f, 0.6f});
  for (std::size_t i = 0; i < picture.rgba.size(); ++i)
    if (i % 4 != 3) picture.rgba[i] = static_cast<std::uint8_t>(i * 37);
  return picture;
}

TEST(Picture, InvalidInputs) {
  EXPECT_EQ(error_of([] { blank_picture(0, 5); }),
            "picture: is 0 x 5 pixels; sides from 1 to 16384, at most 100 million pixels");
  EXPECT_THAT(error_of([] { blank_picture(5, 20000); }), HasSubstr("5 x 20000"));
  EXPECT_THAT(error_of([] { blank_picture(16000, 16000); }), HasSubstr("16000 x 16000"));
  EXPECT_THAT(error_of([] { decode_png({}); }, Error::Kind::io), HasSubstr("is not a PNG"));
  EXPECT_THAT(error_of([] { decode_png({'G', 'I', 'F', '8'}); }, Error::Kind::io), HasSubstr("is not a PNG"));
  std::vector<unsigned char> bytes = encode_png(checkered());
  bytes.resize(bytes.size() / 2);
  EXPECT_THAT(error_of([&] { decode_png(bytes); }, Error::Kind::io), HasSubstr("PNG: is broken"));
  bytes = encode_png(checkered());
  bytes[16] = 0x7f;  // a width of two thousand million
  EXPECT_THAT(error_of([&] { decode_png(bytes); }, Error::Kind::io),
              HasSubstr("PNG: has 2130706439 x 5 pixels"));
}

TEST(Picture, PngRoundTripKeepsEveryPixel) {
  const Picture picture = checkered();
  EXPECT_EQ(decode_png(encode_png(picture)), picture);
}

TEST(Picture, BlankHasOneColor) {
  const Picture picture = blank_picture(3, 2, {0.2f, 0.4f, 1});
  ASSERT_EQ(picture.rgba.size(), 24u);
  EXPECT_EQ(picture.rgba[20], 51);
  EXPECT_EQ(picture.rgba[21], 102);
  EXPECT_EQ(picture.rgba[22], 255);
  EXPECT_EQ(picture.rgba[23], 255);
}

TEST(Picture, ResizeOfOneColorKeepsIt) {
  EXPECT_EQ(resize(blank_picture(40, 30, {0.2f, 0.4f, 1}), 7, 9), blank_picture(7, 9, {0.2f, 0.4f, 1}));
}

}  // namespace
}  // namespace mien
