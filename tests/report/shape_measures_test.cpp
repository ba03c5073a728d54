#include "mien/report/shape_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

/// A unit square of two triangles, 0 1 2 and 0 2 3, facing +z.
Character square() {
  Character character;
  Part part;
  part.name = "skin";
  part.mesh.positions.resize(4, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  part.mesh.faces.push_back({0, 1, 2, 3});
  character.parts.push_back(part);
  return character;
}

std::vector<Points> rest_of(const Character& character) {
  return {character.parts[0].mesh.positions};
}

TEST(Displacement, RejectsOtherPartsAndVertices) {
  const auto error_of = [](const std::vector<Points>& a, const std::vector<Points>& b) -> std::string {
    try {
      displacement(a, b);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of({}, {Points::Zero(1, 3)}), HasSubstr("displacement: is asked between other parts"));
  EXPECT_THAT(error_of({Points::Zero(2, 3)}, {Points::Zero(1, 3)}), HasSubstr("displacement of part 0"));
}

TEST(Displacement, IsTheRootMeanSquareAndTheLargest) {
  const std::vector<Points> rest = rest_of(square());
  std::vector<Points> posed = rest;
  posed[0](0, 2) = 3;
  posed[0](1, 2) = 1;
  EXPECT_NEAR(displacement(posed, rest).rms, std::sqrt(10.0 / 4), 1e-12);
  EXPECT_NEAR(displacement(posed, rest).largest, 3, 1e-12);
  EXPECT_EQ(displacement(rest, rest).rms, 0);
}

TEST(ShapeMeasure, NothingFoldsOrStretchesAtRest) {
  const Character character = square();
  const std::vector<Points> rest = rest_of(character);
  const ShapeMeasure measure(character, rest, 1);
  std::vector<Eigen::VectorXf> folds{Eigen::VectorXf::Zero(4)};
  measure.count_folds(rest, folds);
  EXPECT_EQ(folds[0].sum(), 0);
  EXPECT_EQ(measure.worst_stretch(rest), 1);
  EXPECT_EQ(measure.edge_count(), 5u);
}

TEST(ShapeMeasure, CountsTheCornersOfATriangleThatTurnsOver) {
  const Character character = square();
  std::vector<Points> posed = rest_of(character);
  const ShapeMeasure measure(character, posed, 1);
  posed[0].row(3) << 1, -0.5f, 0;  // across the diagonal from 0 to 2
  std::vector<Eigen::VectorXf> folds{Eigen::VectorXf::Zero(4)};
  measure.count_folds(posed, folds);
  measure.count_folds(posed, folds);
  EXPECT_EQ(folds[0], Eigen::Vector4f(2, 0, 2, 2));
}

TEST(ShapeMeasure, ReportsTheWorstEdgeAndTornEdges) {
  const Character character = square();
  const std::vector<Points> rest = rest_of(character);
  const ShapeMeasure measure(character, rest, 1);
  std::vector<Points> posed = rest;
  posed[0].row(1) << 3, 0, 0;
  EXPECT_NEAR(measure.worst_stretch(posed), 3, 1e-6);
  const std::vector<char> torn = measure.torn_edges(posed, rest);
  EXPECT_EQ(std::count(torn.begin(), torn.end(), 1), 2) << "0-1 is 3 times, 1-2 sqrt(5) times as long";
  EXPECT_EQ(measure.torn_edges(posed, posed), std::vector<char>(5, 0));
}

TEST(ShapeMeasure, EdgesThatAreAlmostNothingDoNotCount) {
  Character character = square();
  character.parts[0].mesh.positions.row(1) << 1e-6f, 0, 0;
  const std::vector<Points> rest = rest_of(character);
  std::vector<Points> posed = rest;
  posed[0].row(1) << 1e-4f, 0, 0;
  EXPECT_LT(ShapeMeasure(character, rest, 1).worst_stretch(posed), 1.01);
}

}  // namespace
}  // namespace mien
