#include "mien/pose/interference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"
#include "pose/small_face.h"

namespace mien {
namespace {

Character four_shapes() {
  Character face = test::small_face(0);
  face.shapes.push_back(test::bump(face, "up", {0.5, 0}, {0, 0.2, 0}));
  face.shapes.push_back(test::bump(face, "down", {0.5, 0}, {0, -0.3, 0}));
  face.shapes.push_back(test::bump(face, "out", {0.5, 0}, {0, 0, 0.1}));
  face.shapes.push_back(test::bump(face, "far", {-0.7, 0.7}, {0.1, 0.1, 0}));
  complete_sliders(face);
  return face;
}

TEST(Interference, tells_competing_from_crossing_and_from_apart) {
  const Character face = four_shapes();
  const Interference found = interference(face);
  EXPECT_NEAR(found.overlap(0, 1), 1, 1e-5);
  EXPECT_NEAR(found.alignment(0, 1), -1, 1e-5);
  EXPECT_NEAR(found.overlap(0, 2), 1, 1e-5);
  EXPECT_NEAR(found.alignment(0, 2), 0, 1e-5);
  EXPECT_LT(found.overlap(0, 3), 0.01);
  ASSERT_EQ(found.pairs.size(), 3u);
  const Eigen::RowVector3f where = face.parts[0].mesh.positions.row(found.pairs[0].where.vertex);
  EXPECT_LT((where.head<2>() - Eigen::RowVector2f(0.5f, 0)).norm(), 0.2f);
  EXPECT_THROW(interference(Character{}), Error);
}

TEST(RegionRules, finds_sliders_that_move_what_they_should_not) {
  const Character face = four_shapes();
  Clip clip;
  for (const int s : {0, 2}) {
    Channel channel;
    channel.property = Channel::Property::slider;
    channel.slider = s;
    channel.times = {0, 1};
    channel.values = {0, s == 0 ? 1.f : 0.5f};
    clip.channels.push_back(channel);
  }
  RegionRule rule;
  rule.name = "lid";
  SurfacePoint point;
  point.vertex = 6 * test::grid + 8;
  rule.region = {point};
  rule.sliders = {0};
  std::vector<RuleBreak> breaks = check_region_rules(face, clip, {rule});
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0].slider, 2);
  EXPECT_NEAR(breaks[0].seconds, 1, 1e-6);
  rule.sliders = {0, 2};
  EXPECT_TRUE(check_region_rules(face, clip, {rule}).empty());
  rule.at_most = 0.05;
  breaks = check_region_rules(face, clip, {rule});
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0].slider, -1);
  EXPECT_GT(breaks[0].by, 0.1);
  rule.region.clear();
  EXPECT_THROW(check_region_rules(face, clip, {rule}), Error);
}

}  // namespace
}  // namespace mien
