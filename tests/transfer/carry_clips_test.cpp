#include "mien/transfer/carry_clips.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/evaluate/evaluate.h"
#include "transfer/small_rig.h"

namespace mien::test {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

ClipMap map_of(const Character& source, const CarriedSkeleton& skeleton) {
  ClipMap map;
  map.nodes = node_motions(source, skeleton);
  return map;
}

/// Scene, head, jaw and chin animated in every way.
Clip clip_of(const Character& source) {
  Clip clip;
  clip.name = "talk";
  const auto rotation = [](double angle, const Vector3d& axis) {
    return Eigen::Quaternionf(Eigen::AngleAxisf(static_cast<float>(angle), axis.cast<float>().normalized()));
  };
  for (int n = 0; n < 4; ++n) {
    const Vector3d rest = source.nodes[n].rest.translation;
    const Eigen::Vector3f a = (rest + Vector3d(0.3, n, -0.2)).cast<float>();
    clip.channels.push_back(
        channel(Channel::Property::translation, n, {0, 1},
                {float(rest.x()), float(rest.y()), float(rest.z()), a.x(), a.y(), a.z()}));
    const auto q = rotation(0.3 + n, {1, 2, -1}), r = rotation(1.4, {0, 1, double(n)});
    clip.channels.push_back(channel(Channel::Property::rotation, n, {0, 1},
                                    {q.x(), q.y(), q.z(), q.w(), r.x(), r.y(), r.z(), r.w()}));
    clip.channels.push_back(channel(Channel::Property::scale, n, {0, 1},
                                    {1, 1, 1, 1.5f + 0.1f * n, 1.5f + 0.1f * n, 1.5f + 0.1f * n}));
  }
  return clip;
}

void expect_plays_alike(const Character& source, const Clip& clip, const Similarity& map) {
  const CarriedSkeleton skeleton = carry_skeleton(source, of_similarity(map), 1);
  Character target = with_skeleton(skeleton, 1);
  std::vector<std::string> dropped;
  const Clip carried = carry_clip(source, clip, map_of(source, skeleton), dropped);
  EXPECT_THAT(dropped, IsEmpty());
  for (const double seconds : {0.0, 0.25, 1.0}) {
    const auto before = model_matrices(source, sample_clip(source, clip, seconds)),
               after = model_matrices(target, sample_clip(target, carried, seconds));
    for (int n = 0; n < 4; ++n) {
      const Matrix4d &a = before[n], &b = after[skeleton.node_of[n]];
      const Vector3d expected = map(Vector3d(a.topRightCorner<3, 1>())), got = b.topRightCorner<3, 1>();
      EXPECT_LT((expected - got).norm(), 1e-5 * map.scale) << n << " at " << seconds;
      EXPECT_LT((map.rotation * a.topLeftCorner<3, 3>() - b.topLeftCorner<3, 3>()).norm(), 1e-5) << n;
    }
  }
}

TEST(carry_clip, plays_alike_after_a_similarity) {
  const Character source = rig();
  expect_plays_alike(source, clip_of(source), {});
  expect_plays_alike(source, clip_of(source), {60, Eigen::Matrix3d::Identity(), {1, 2, 3}});
  expect_plays_alike(source, clip_of(source), some_similarity(0.3));
}

TEST(carry_clip, cubic_tangents_have_no_rest) {
  const Character source = rig();
  const CarriedSkeleton skeleton =
      carry_skeleton(source, of_similarity({2, Eigen::Matrix3d::Identity(), {5, 5, 5}}), 0);
  Clip clip;
  clip.channels = {channel(Channel::Property::translation, 1, {0}, {1, 0, 0, 0, 1.5f, 0, 0, 0, 3})};
  clip.channels[0].interpolation = Interpolation::cubic_spline;
  std::vector<std::string> dropped;
  const Clip carried = carry_clip(source, clip, map_of(source, skeleton), dropped);
  ASSERT_EQ(carried.channels.size(), 1u);
  EXPECT_EQ(carried.channels[0].interpolation, Interpolation::cubic_spline);
  const Eigen::Vector3f rest = skeleton.nodes[1].rest.translation.cast<float>();
  const std::vector<float> expected = {2, 0, 0, rest.x(), rest.y() + 1, rest.z(), 0, 0, 6};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(carried.channels[0].values[i], expected[i], 1e-5) << i;
}

TEST(carry_clip, rotations_of_an_unturned_skeleton_stay_to_the_bit) {
  const Character source = rig();
  const CarriedSkeleton skeleton =
      carry_skeleton(source, of_similarity({60, Eigen::Matrix3d::Identity(), {1, 2, 3}}), 0);
  const Clip clip = clip_of(source);
  std::vector<std::string> dropped;
  const Clip carried = carry_clip(source, clip, map_of(source, skeleton), dropped);
  for (std::size_t c = 0; c < clip.channels.size(); ++c) {
    EXPECT_EQ(carried.channels[c].times, clip.channels[c].times);
    if (clip.channels[c].property == Channel::Property::translation) continue;
    for (std::size_t i = 0; i < clip.channels[c].values.size(); ++i)
      EXPECT_NEAR(carried.channels[c].values[i], clip.channels[c].values[i], 1e-6);
  }
}

TEST(carry_clip, what_the_target_does_not_get_is_named) {
  Character source = rig();
  source.shapes.resize(2);
  source.shapes[0].name = "smile";
  source.shapes[1].name = "frown";
  Clip clip;
  clip.name = "talk";
  clip.channels = {channel(Channel::Property::translation, 5, {0}, {1, 2, 3}), Channel{}, Channel{}};
  for (const int c : {1, 2}) {
    clip.channels[c].property = Channel::Property::shape_weight;
    clip.channels[c].shape = c - 1;
    clip.channels[c].part = 0;
    clip.channels[c].times = {0};
    clip.channels[c].values = {0.5f};
  }
  std::vector<std::string> dropped;
  ClipMap map = map_of(source, carry_skeleton(source, of_similarity({}), 0));
  map.shape_of = {-1, 7};
  const Clip carried = carry_clip(source, clip, map, dropped);
  EXPECT_THAT(dropped, ElementsAre("clip talk: node Tooth", "clip talk: shape smile"));
  ASSERT_EQ(carried.channels.size(), 1u);
  EXPECT_EQ(carried.channels[0].shape, 7);
  EXPECT_EQ(carried.channels[0].part, -1);
  EXPECT_EQ(carried.channels[0].values, clip.channels[2].values);
}

TEST(rig_differences, one_line_a_difference) {
  Character a = rig(), b = rig();
  EXPECT_THAT(rig_differences(a, b), IsEmpty());
  EXPECT_THAT(rig_differences(Character{}, Character{}), IsEmpty());
  a.shapes.resize(1);
  a.shapes[0].name = "smile";
  b.nodes[3].parent = 1;
  b.nodes[2].name = "mandible";
  EXPECT_THAT(rig_differences(a, b),
              ElementsAre("joint jaw is missing in the second", "joint chin hangs below jaw and below head",
                          "shape smile is missing in the second", "joint mandible is missing in the first"));
}

}  // namespace
}  // namespace mien::test
