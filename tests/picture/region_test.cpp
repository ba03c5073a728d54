#include "mien/picture/region.h"

#include <gtest/gtest.h>

#include "mien/core/error.h"
#include "shapes_in_code.h"

namespace mien {
namespace {

SurfacePoint vertex(int v) {
  SurfacePoint point;
  point.vertex = v;
  return point;
}

TEST(Region, UnknownName) {
  EXPECT_EQ(region_of_name("mouth"), Region::mouth);
  EXPECT_EQ(region_of_name("eyes"), Region::eyes);
  try {
    region_of_name("nose");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "region nose: does not exist; mouth or eyes");
  }
}

TEST(Region, NothingWithoutNames) {
  const Character ball = character_of({make_sphere("ball", 8)});
  EXPECT_FALSE(find_region(ball, positions_of(ball), Region::mouth));
  EXPECT_FALSE(find_region(ball, positions_of(ball), Region::eyes));
}

TEST(Region, LandmarksComeFirstThenShapesThenParts) {
  Character character = character_of({make_sphere("face", 8), make_sphere("teeth", 8)});
  const auto posed = positions_of(character);
  const Box by_part = *find_region(character, posed, Region::mouth);
  EXPECT_NEAR(by_part.centre().norm(), 0, 1e-6);
  EXPECT_GT(by_part.high.x(), 1);

  Shape pucker{"mouthPucker", {PartDelta()}};
  pucker.parts[0].vertices = {3, 4, 40};
  pucker.parts[0].deltas = Points::Zero(3, 3);
  pucker.parts[0].deltas(0, 0) = pucker.parts[0].deltas(1, 0) = 1;
  pucker.parts[0].deltas(2, 0) = 0.1f;  // hardly moved: not the mouth
  character.shapes.push_back(pucker);
  const auto middle = [&](int a, int b) {
    return Eigen::Vector3d((posed[0].row(a) + posed[0].row(b)).cast<double>() / 2);
  };
  EXPECT_NEAR((find_region(character, posed, Region::mouth)->centre() - middle(3, 4)).norm(), 0, 1e-6);

  character.landmarks = {{"ibug_36", vertex(0)},
                         {"ibug_49", vertex(10)},
                         {"ibug_55", vertex(12)},
                         {"mouthCorner", vertex(10)},
                         {"browOverEye", vertex(50)}};
  EXPECT_NEAR((find_region(character, posed, Region::mouth)->centre() - middle(10, 12)).norm(), 0, 1e-6);
  EXPECT_FALSE(find_region(character, posed, Region::eyes));
}

}  // namespace
}  // namespace mien
