#include "mien/transfer/landmark_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/faces.h"

namespace mien::test {
namespace {

using ::testing::ElementsAre;
using Rows = std::vector<std::array<float, 3>>;

const Rows corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};

/// A cloud of vertices; landmark i is called names[i] and is vertex i.
Character marked(const Rows& positions, const std::vector<std::string>& names) {
  Character character;
  character.parts.emplace_back();
  Mesh& mesh = character.parts[0].mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v)
    mesh.positions.row(static_cast<Eigen::Index>(v)) << positions[v][0], positions[v][1], positions[v][2];
  for (std::size_t i = 0; i < names.size(); ++i) {
    Landmark landmark{names[i], {}};
    landmark.at.vertex = static_cast<int>(i);
    character.landmarks.push_back(landmark);
  }
  return character;
}

LandmarkCurve curve_through(const std::string& name, const std::vector<int>& vertices, int count) {
  LandmarkCurve curve{name, {}, count};
  for (const int v : vertices) {
    curve.points.emplace_back();
    curve.points.back().vertex = v;
  }
  return curve;
}

TEST(pair_landmarks, too_few_common_names_are_counted) {
  const Character five = marked(corners, {"a", "b", "c", "d", "e"});
  EXPECT_EQ(invalid_input_of([&] {
              pair_landmarks(marked(corners, {"a", "b", "c"}), five);
            }),
            "landmarks: 3 of the source's 3 have a partner of the same name among the target's 5; 4 or more "
            "names that "
            "both sides have");
  EXPECT_EQ(invalid_input_of([&] {
              pair_landmarks(five, marked(corners, {"v", "w", "x", "y"}));
            }),
            "landmarks: 0 of the source's 5 have a partner of the same name among the target's 4; 4 or more "
            "names that "
            "both sides have");
  EXPECT_EQ(invalid_input_of([&] { pair_landmarks(five, Character{}); }),
            "landmarks: 0 of the source's 5 have a partner of the same name among the target's 0; 4 or more "
            "names that "
            "both sides have");
}

TEST(pair_landmarks, two_at_one_place_are_named) {
  Rows twice = corners;
  twice[3] = twice[1];
  const Character good = marked(corners, {"a", "b", "c", "d", "e"}),
                  bad = marked(twice, {"a", "b", "c", "d", "e"});
  EXPECT_EQ(invalid_input_of([&] { pair_landmarks(bad, good); }),
            "source landmarks: b and d are at the same place; two different places, or one of them left out");
  EXPECT_EQ(invalid_input_of([&] { pair_landmarks(good, bad); }),
            "target landmarks: b and d are at the same place; two different places, or one of them left out");
}

TEST(pair_landmarks, a_plane_is_named_by_its_landmarks) {
  Rows flat = corners;
  for (auto& p : flat) p[2] = 0.25f * p[0];
  flat[3] = {-1, 1, -0.25f};
  flat[4] = {2, 3, 0.5f};
  const Character four = marked(corners, {"a", "b", "c", "d"});
  EXPECT_EQ(invalid_input_of([&] {
              pair_landmarks(four, marked(flat, {"a", "b", "c", "d"}));
            }),
            "target landmarks: all lie in one plane (a, b, c, d); one or more off that plane, such as the "
            "tip of the "
            "nose or an ear");
  const Character five = marked(corners, {"a", "b", "c", "d", "e"});
  EXPECT_EQ(invalid_input_of([&] {
              pair_landmarks(marked(flat, {"a", "b", "c", "d", "e"}), five);
            }),
            "source landmarks: all lie in one plane (a, b, c, d, ...); one or more off that plane, such as "
            "the tip of "
            "the nose or an ear");
}

TEST(pair_landmarks, a_curve_needs_two_points) {
  Character source = marked(corners, {"a", "b", "c", "d"});
  source.curves.push_back(curve_through("lip", {1}, 3));
  EXPECT_EQ(invalid_input_of([&] { pair_landmarks(source, source); }),
            "curve lip: has 1 points; two or more");
}

TEST(pair_landmarks, pairs_by_name_in_the_sources_order) {
  const Character source = marked(corners, {"a", "b", "c", "d", "left"}),
                  target = marked({corners[3], corners[2], {9, 9, 9}, corners[1], corners[0]},
                                  {"d", "c", "right", "b", "a"});
  const LandmarkPairs pairs = pair_landmarks(source, target);
  EXPECT_THAT(pairs.names, ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(pairs.only_source, ElementsAre("left"));
  EXPECT_THAT(pairs.only_target, ElementsAre("right"));
  EXPECT_EQ(pairs.source_positions(), pairs.target_positions());
  EXPECT_EQ(pairs.source_positions().row(3), Eigen::RowVector3d(0, 0, 1));
}

TEST(pair_landmarks, curves_are_sampled_to_the_sources_count) {
  Rows rows = corners;
  rows.push_back({3, 0, 0});
  rows.push_back({7, 0, 0});
  Character source = marked(rows, {"a", "b", "c", "d"}), target = source;
  source.curves = {curve_through("lip", {5, 6}, 5), curve_through("mine", {5, 6}, 2)};
  target.curves = {curve_through("yours", {5, 6}, 2), curve_through("lip", {6, 5}, 2)};
  const LandmarkPairs pairs = pair_landmarks(source, target);
  EXPECT_THAT(pairs.names, ElementsAre("a", "b", "c", "d", "lip.0", "lip.1", "lip.2", "lip.3", "lip.4"));
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(pairs.source_positions().row(4 + i).isApprox(Eigen::RowVector3d(3 + i, 0, 0), 1e-12));
    EXPECT_TRUE(pairs.target_positions().row(4 + i).isApprox(Eigen::RowVector3d(7 - i, 0, 0), 1e-12));
  }
  EXPECT_THAT(pairs.only_source, ElementsAre("mine"));
  EXPECT_THAT(pairs.only_target, ElementsAre("yours"));
}

TEST(pair_landmarks, a_sample_on_a_landmark_is_left_out) {
  Character source = marked(corners, {"a", "b", "c", "d"});
  source.curves = {curve_through("edge", {0, 4}, 3)};
  EXPECT_THAT(pair_landmarks(source, source).names, ElementsAre("a", "b", "c", "d", "edge.1", "edge.2"));
}

TEST(pair_landmarks, a_subset_of_landmarks_is_enough) {
  const Character& human = made("human");
  Character cartoon = made("cartoon");
  cartoon.landmarks.resize(30);
  cartoon.curves.clear();
  const LandmarkPairs pairs = pair_landmarks(human, cartoon);
  EXPECT_EQ(pairs.names.size(), 30u);
  EXPECT_EQ(pairs.only_source.size(), 38u + 4u);
  EXPECT_TRUE(pairs.only_target.empty());
}

}  // namespace
}  // namespace mien::test
