#include "mien/transfer/retarget_clips.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mien/evaluate/evaluate.h"
#include "transfer/rigged_human.h"
#include "transfer/small_rig.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

TEST(retarget_clips, needs_clips) {
  EXPECT_EQ(invalid_input_of([&] { retarget_clips(made("cartoon"), made("human")); }),
            "source: has no clips; a character with animation (`mien inspect` lists it)");
}

TEST(retarget_clips, names_what_differs_and_what_is_left_out) {
  Character target = made("human");
  const int shape = find_shape(target, "jawOpen");
  ASSERT_GE(shape, 0);
  target.nodes[find_node(target, "jaw")].name = "mandible";
  const RetargetedClips result = retarget_clips(made("human"), target);
  EXPECT_THAT(result.differences, Contains("joint jaw is missing in the second"));
  EXPECT_THAT(result.dropped, Contains("clip " + made("human").clips[0].name + ": node jaw"));
}

TEST(retarget_clips, onto_itself_changes_nothing) {
  const Character& human = rigged_human();
  const RetargetedClips result = retarget_clips(human, human);
  EXPECT_THAT(result.differences, IsEmpty());
  EXPECT_THAT(result.dropped, IsEmpty());
  ASSERT_EQ(result.clips.size(), human.clips.size());
  for (std::size_t k = 0; k < human.clips.size(); ++k)
    for (std::size_t c = 0; c < human.clips[k].channels.size(); ++c)
      for (std::size_t i = 0; i < human.clips[k].channels[c].values.size(); ++i)
        EXPECT_NEAR(result.clips[k].channels[c].values[i], human.clips[k].channels[c].values[i], 2e-6);
}

TEST(retarget_clips, a_rig_in_other_frames_plays_alike) {
  const Character source = rig();
  Clip clip;
  clip.name = "nod";
  const Eigen::Quaternionf q(Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, -1).normalized()));
  clip.channels = {channel(Channel::Property::rotation, 2, {0}, {q.x(), q.y(), q.z(), q.w()}),
                   channel(Channel::Property::translation, 3, {0}, {0.4f, 0.3f, 2.2f})};
  Character animated = source;
  animated.clips = {clip};
  const Similarity by = some_similarity(5);
  // The same places, seen through a similarity, but the jaw's own frame is another.
  const CarriedSkeleton skeleton = carry_skeleton(source, of_similarity(by), 0);
  Character target = with_skeleton(skeleton, 0);
  const Eigen::Quaterniond other(Eigen::AngleAxisd(1.1, Eigen::Vector3d(0, 1, 1).normalized()));
  target.nodes[2].rest.rotation = target.nodes[2].rest.rotation * other;
  target.nodes[3].rest.translation = other.inverse() * target.nodes[3].rest.translation;
  target.nodes[3].rest.rotation = other.inverse() * target.nodes[3].rest.rotation;
  const RetargetedClips result = retarget_clips(animated, target);
  EXPECT_THAT(result.dropped, IsEmpty());
  const auto before = model_matrices(source, sample_clip(animated, clip, 0)),
             after = model_matrices(target, sample_clip(target, result.clips[0], 0));
  const Eigen::Vector3d a = before[3].topRightCorner<3, 1>(), b = after[3].topRightCorner<3, 1>();
  EXPECT_LT((by(a) - b).norm(), 1e-4 * by.scale);
}

TEST(retarget_clips, a_transferred_rig_gets_nearly_the_transferred_clip) {
  const Character& target = transferred("human", "cartoon").character;
  const RetargetedClips result = retarget_clips(made("human"), target);
  EXPECT_THAT(result.differences, IsEmpty());
  EXPECT_THAT(result.dropped, IsEmpty());
  const Clip &a = result.clips[0], &b = target.clips[0];
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    const Channel &one = a.channels[c], &other = b.channels[c];
    if (one.property == Channel::Property::translation) continue;
    // Control points move by the growth at the object here, by the skin's delta model in a transfer.
    double tolerance = 1e-5;
    if (one.property == Channel::Property::object_control)
      for (const float value : other.values) tolerance = std::max(tolerance, 0.1 * std::abs(value));
    for (std::size_t i = 0; i < one.values.size(); ++i)
      EXPECT_NEAR(one.values[i], other.values[i], tolerance) << c;
  }
}

}  // namespace
}  // namespace mien::test
