#include "mien/report/wire_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mien/core/error.h"
#include "mien/extract/draw_wires.h"
#include "mien/picture/picture.h"
#include "mien/sample/sample.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

std::vector<unsigned char> bytes_of(const std::string& base64) {
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64) {
    const std::size_t value = letters.find(c);
    if (value == std::string::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> count & 255));
  }
  return bytes;
}

std::vector<Picture> pictures_of(const std::string& page) {
  std::vector<Picture> pictures;
  const std::string start = "base64,";
  for (auto at = page.find(start); at != std::string::npos; at = page.find(start, at + 1)) {
    const auto begin = at + start.size();
    pictures.push_back(decode_png(bytes_of(page.substr(begin, page.find('"', begin) - begin))));
  }
  return pictures;
}

/// How much of a picture is not its most common color.
double drawn_share(const Picture& picture) {
  std::map<std::array<std::uint8_t, 3>, int> counts;
  int pixels = 0, most = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4, ++pixels)
    most = std::max(most, ++counts[{picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]}]);
  return 1 - static_cast<double>(most) / pixels;
}

/// Two shapes of the built-in human, by a few of its wires.
ExtractResult extracted(Character& face, bool through_points) {
  face = make_sample("human");
  face.shapes.resize(2);
  face.sliders.clear();
  face.correctives.clear();
  face.expressions.clear();
  face.clips.clear();
  std::vector<Wire> wires = draw_wires(face, face_wire_sketches(face, 15));
  if (!through_points)
    for (Wire& wire : wires) wire.points.clear();
  return extract_wires(face, wires);
}

TEST(WireReport, EveryPictureShowsTheFace) {
  for (const bool through_points : {true, false}) {
    Character face;
    const ExtractResult result = extracted(face, through_points);
    const std::string page = make_wire_report({face, result, "a & b"});
    EXPECT_THAT(page, HasSubstr("a &amp; b"));
    EXPECT_THAT(page, HasSubstr(face.shapes[1].name));
    const std::vector<Picture> pictures = pictures_of(page);
    ASSERT_EQ(pictures.size(), 3 + 3 * face.shapes.size());
    for (const Picture& picture : pictures) EXPECT_GT(drawn_share(picture), 0.3);
  }
}

TEST(WireReport, IsAboutTheCharacterThatWasExtracted) {
  Character face;
  const ExtractResult result = extracted(face, true);
  face.shapes.resize(1);
  try {
    make_wire_report({face, result});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "report: is about another character; the one that was extracted");
  }
}

}  // namespace
}  // namespace mien
