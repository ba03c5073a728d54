#include "mien/deform/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

/// A square of four vertices; "lift" moves two of them, "slide" one.
Character square() {
  Character character;
  Part part;
  part.name = "face";
  part.mesh.positions.resize(4, 3);
  part.mesh.positions << 0, 0, 0, 0.1f, 0, 0, 0.1f, 0.3f, 0, 0, 0.7f, 0;
  part.mesh.faces.push_back({0, 1, 2, 3});
  character.parts.push_back(part);
  PartDelta lift{0, {1, 3}, Points(2, 3), {}, {}};
  lift.deltas << 0, 0, 1, 0, 0.5f, 2;
  PartDelta slide{0, {3}, Points(1, 3), {}, {}};
  slide.deltas << 4, 0, 0;
  character.shapes.push_back({"lift", {lift}});
  character.shapes.push_back({"slide", {slide}});
  return character;
}

ShapeWeights weights(double lift, double slide) {
  return ShapeWeights(Eigen::Vector2d(lift, slide));
}

std::string error_of(const Character& character, int part, const ShapeWeights& shape_weights) {
  try {
    add_shapes(character, part, shape_weights);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "no error";
}

TEST(AddShapes, InvalidInputs) {
  const Character character = square();
  EXPECT_EQ(error_of(character, 0, ShapeWeights(std::size_t{3})), "shape weights: number 3; 2, one a shape");
  EXPECT_THAT(error_of(character, 1, weights(0, 0)), HasSubstr("part 1: does not exist"));
  EXPECT_THAT(error_of(character, -1, weights(0, 0)), HasSubstr("part -1: does not exist"));
  EXPECT_THAT(error_of(character, 0, weights(0, std::numeric_limits<double>::quiet_NaN())),
              HasSubstr("shape weight of slide: is not finite"));
}

TEST(AddShapes, ZeroWeightsGiveTheNeutralBitForBit) {
  const Character character = square();
  EXPECT_EQ(Points(add_shapes(character, 0, weights(0, 0)).cast<float>()), character.parts[0].mesh.positions);
}

TEST(AddShapes, WeightOneGivesTheTargetShape) {
  const Character character = square();
  Points target = character.parts[0].mesh.positions;
  target.row(1) += Eigen::RowVector3f(0, 0, 1);
  target.row(3) += Eigen::RowVector3f(0, 0.5f, 2);
  EXPECT_EQ(Points(add_shapes(character, 0, weights(1, 0)).cast<float>()), target);
}

TEST(AddShapes, ShapesAdd) {
  const PointsD posed = add_shapes(square(), 0, weights(-0.5, 0.25));
  EXPECT_NEAR((posed.row(3) - Eigen::RowVector3d(1, 0.7f - 0.25, -1)).norm(), 0, 1e-12);
  EXPECT_NEAR((posed.row(1) - Eigen::RowVector3d(0.1f, 0, -0.5)).norm(), 0, 1e-12);
}

TEST(AddShapes, OtherPartsStay) {
  Character character = square();
  character.parts.push_back(character.parts[0]);
  EXPECT_EQ(Points(add_shapes(character, 1, weights(1, 1)).cast<float>()), character.parts[1].mesh.positions);
}

}  // namespace
}  // namespace mien
