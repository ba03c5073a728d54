#include "mien/character/whole_faces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

Points random_face(unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(static_cast<float>(0.5 * size), static_cast<float>(size));
  Points face(40, 3);
  for (Eigen::Index i = 0; i < face.size(); ++i) face.data()[i] = value(random);
  return face;
}

TEST(whole_faces, wrong_sizes_and_numbers_are_named) {
  EXPECT_THROW(delta_of(0, Points(3, 3), Points(4, 3)), Error);
  EXPECT_THROW(whole_face(Character{}, 0, 0), Error);
  EXPECT_THROW(delta_weights(Eigen::Vector3d(0.5, 0.2, 0.2)), Error);
  EXPECT_THROW(delta_weights(Eigen::VectorXd()), Error);
}

TEST(whole_faces, a_face_comes_back_bit_for_bit_at_any_scale) {
  for (const double size : {1e-3, 1.0, 1800.0}) {
    Character character;
    character.parts.resize(1);
    character.parts[0].mesh.positions = random_face(1, size);
    Points face = random_face(2, size);
    face.row(11) = character.parts[0].mesh.positions.row(11);
    character.shapes.push_back({"face", {delta_of(0, character.parts[0].mesh.positions, face)}});
    EXPECT_EQ(character.shapes[0].parts[0].vertices.size(), 39u) << "one vertex stays";
    EXPECT_EQ(whole_face(character, 0, 0).cast<float>(), face);
  }
}

TEST(whole_faces, weights_sum_to_one_and_mix_to_the_same_surface) {
  Character character;
  character.parts.resize(1);
  const Points& neutral = character.parts[0].mesh.positions = random_face(1, 1);
  for (unsigned s = 0; s < 3; ++s)
    character.shapes.push_back(
        {std::string(1, static_cast<char>('a' + s)), {delta_of(0, neutral, random_face(s + 2, 1))}});
  const ShapeWeights weights(Eigen::Vector3d(0.4, -0.2, 1.1));
  const Eigen::VectorXd whole = whole_face_weights(weights);
  EXPECT_DOUBLE_EQ(whole.sum(), 1);
  PointsD mixed = whole[0] * neutral.cast<double>(), added = neutral.cast<double>();
  for (int s = 0; s < 3; ++s) {
    mixed += whole[s + 1] * whole_face(character, 0, s);
    added += weights.values[s] * (whole_face(character, 0, s) - neutral.cast<double>());
  }
  EXPECT_LT((mixed - added).cwiseAbs().maxCoeff(), 1e-15 * 10);
  EXPECT_EQ(delta_weights(whole).values, weights.values);
}

}  // namespace
}  // namespace mien
