#include "mien/pose/key_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mien/core/error.h"
#include "pose/small_face.h"

namespace mien {
namespace {

Clip nodding() {
  Clip clip;
  for (int s = 0; s < 3; ++s) {
    Channel channel;
    channel.property = Channel::Property::slider;
    channel.slider = s;
    channel.interpolation = s == 1 ? Interpolation::step : Interpolation::linear;
    channel.times = {0, 1, 2};
    channel.values = {0, 0.6f, 0.1f};
    clip.channels.push_back(channel);
  }
  return clip;
}

TEST(KeyChanges, sets_keys_on_changed_sliders_alone) {
  const Character face = test::small_face(8);
  const Clip clip = nodding();
  SliderValues before(8), after(8);
  after.values[0] = 0.4;
  after.values[6] = 0.3;
  const Clip keyed = key_changes(face, clip, before, after, 0.5);
  ASSERT_EQ(keyed.channels.size(), 4u);
  EXPECT_EQ(keyed.channels[0].times, (std::vector<float>{0, 0.5f, 1, 2}));
  EXPECT_EQ(keyed.channels[0].values, (std::vector<float>{0, 0.4f, 0.6f, 0.1f}));
  EXPECT_EQ(keyed.channels[1].times, clip.channels[1].times);
  EXPECT_EQ(keyed.channels[3].slider, 6);
  EXPECT_EQ(keyed.channels[3].values, std::vector<float>{0.3f});
  EXPECT_EQ(key_changes(face, keyed, before, after, 0.5).channels[0].times.size(), 4u);  // replaces
  EXPECT_THROW(key_changes(face, clip, before, SliderValues(3), 0.5), Error);
  EXPECT_THROW(key_changes(face, clip, before, after, NAN), Error);
}

TEST(HoldPins, keeps_a_point_through_a_range_and_leaves_the_rest_alone) {
  const Character face = test::small_face(16);
  const Clip clip = nodding();
  HoldOptions options;
  options.begin = 0.5;
  options.end = 1.5;
  options.fps = 10;
  const RigPose at_begin = sample_rig(face, clip, 0.5);
  int vertex = 0;  // one that the clip moves
  for (int v = 0; v < 144; ++v)
    if ((test::vertex_at(face, sample_rig(face, clip, 1), v) - test::vertex_at(face, at_begin, v)).norm() >
        0.02)
      vertex = v;
  Pin pin = test::pin_at(vertex, test::vertex_at(face, at_begin, vertex));
  pin.goal_is_move = false;
  const Clip held = hold_pins(face, clip, {pin}, options);
  double drift = 0, free = 0;
  for (const double t : {0.5, 0.7, 1.0, 1.3, 1.5}) {
    drift = std::max(drift, (test::vertex_at(face, sample_rig(face, held, t), vertex) - pin.goal).norm());
    free = std::max(free, (test::vertex_at(face, sample_rig(face, clip, t), vertex) - pin.goal).norm());
  }
  EXPECT_GT(free, 0.01);
  EXPECT_LT(drift, 0.5 * free);
  for (const double t : {0.0, 0.2, 0.35, 1.65, 1.9, 2.0})
    EXPECT_LT((sample_rig(face, held, t).sliders.values - sample_rig(face, clip, t).sliders.values)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-5)
        << t;
  options.end = 0.2;
  EXPECT_THROW(hold_pins(face, clip, {pin}, options), Error);
}

}  // namespace
}  // namespace mien
