#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

using ::testing::HasSubstr;
using Property = Channel::Property;

Character one_node_one_shape() {
  Character character;
  character.nodes.emplace_back();
  character.nodes[0].name = "jaw";
  character.nodes[0].rest.translation = {7, 8, 9};
  character.shapes.push_back({"open", {}});
  complete_sliders(character);
  character.sliders[0].rest = 0.25;
  return character;
}

Clip clip_of(Channel channel) {
  return {"clip", {std::move(channel)}, {}};
}

Channel weight_channel(Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
  Channel channel;
  channel.property = Property::shape_weight;
  channel.shape = 0;
  channel.interpolation = interpolation;
  channel.times = std::move(times);
  channel.values = std::move(values);
  return channel;
}

Channel node_channel(Property property, std::vector<float> times, std::vector<float> values) {
  Channel channel;
  channel.property = property;
  channel.node = 0;
  channel.times = std::move(times);
  channel.values = std::move(values);
  return channel;
}

double weight_at(const Clip& clip, double seconds) {
  return sample_clip(one_node_one_shape(), clip, seconds).shape_weights.values[0];
}

std::string error_of(const Clip& clip, double seconds = 0) {
  try {
    sample_clip(one_node_one_shape(), clip, seconds);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "no error";
}

TEST(SampleClip, InvalidInputs) {
  const Channel good = weight_channel(Interpolation::linear, {0, 1}, {0, 1});
  EXPECT_THAT(error_of(clip_of(good), std::numeric_limits<double>::quiet_NaN()), HasSubstr("not finite"));
  EXPECT_THAT(error_of(clip_of(weight_channel(Interpolation::linear, {}, {}))),
              HasSubstr("clip clip, channel 0: has no keys"));
  EXPECT_THAT(error_of(clip_of(weight_channel(Interpolation::linear, {0, 1}, {0}))),
              HasSubstr("has 1 values; 2, 1 a key"));
  EXPECT_THAT(error_of(clip_of(weight_channel(Interpolation::cubic_spline, {0, 1}, {0, 1}))),
              HasSubstr("has 2 values; 6, 3 a key"));
  Channel far = good;
  far.shape = 1;
  EXPECT_THAT(error_of(clip_of(far)), HasSubstr("animates shape 1"));
  Channel no_node = node_channel(Property::scale, {0}, {1, 1, 1});
  no_node.node = -1;
  EXPECT_THAT(error_of(clip_of(no_node)), HasSubstr("animates node -1"));
}

TEST(SampleClip, WithoutChannelsEverythingRests) {
  const Pose pose = sample_clip(one_node_one_shape(), {}, 1);
  EXPECT_EQ(pose.shape_weights.values[0], 0.25);
  EXPECT_EQ(pose.locals[0].translation, Eigen::Vector3d(7, 8, 9));
}

TEST(SampleClip, StepHoldsTheLastKey) {
  const Clip clip = clip_of(weight_channel(Interpolation::step, {1, 2, 4}, {0.5f, 0.75f, 1}));
  EXPECT_EQ(weight_at(clip, -3), 0.5);
  EXPECT_EQ(weight_at(clip, 1.999), 0.5);
  EXPECT_EQ(weight_at(clip, 2), 0.75);
  EXPECT_EQ(weight_at(clip, 3.999), 0.75);
  EXPECT_EQ(weight_at(clip, 99), 1);
}

TEST(SampleClip, LinearIsExactAtKeysAndStraightBetween) {
  const Clip clip = clip_of(weight_channel(Interpolation::linear, {1, 2, 4}, {0.5f, 0.75f, -1}));
  EXPECT_EQ(weight_at(clip, 0), 0.5);
  EXPECT_EQ(weight_at(clip, 1.5), 0.625);
  EXPECT_EQ(weight_at(clip, 2), 0.75);
  EXPECT_EQ(weight_at(clip, 3), -0.125);
  EXPECT_EQ(weight_at(clip, 5), -1);
}

TEST(SampleClip, CubicSplineByHand) {
  // Keys (in, value, out): at 1 s (9, 2, 4), at 3 s (-2, 5, 9); in the middle, with span 2:
  // p = (2 + 5) / 2 + 2 x (4 - -2) / 8 = 5.
  const Clip clip = clip_of(weight_channel(Interpolation::cubic_spline, {1, 3}, {9, 2, 4, -2, 5, 9}));
  EXPECT_EQ(weight_at(clip, 1), 2);
  EXPECT_DOUBLE_EQ(weight_at(clip, 2), 5);
  EXPECT_EQ(weight_at(clip, 3), 5);
  EXPECT_EQ(weight_at(clip, 0), 2);
  EXPECT_EQ(weight_at(clip, 7), 5);
  // At a quarter: h00 = .84375, h10 = .140625, h01 = .15625, h11 = -.046875.
  EXPECT_NEAR(weight_at(clip, 1.5), 0.84375 * 2 + 0.140625 * 2 * 4 + 0.15625 * 5 - 0.046875 * 2 * -2, 1e-12);
}

TEST(SampleClip, RotationTurnsEvenlyOnTheShortWay) {
  const double half = std::numbers::pi / 4;  // 90 degrees about z, given as -q
  const auto s = static_cast<float>(std::sin(half)), c = static_cast<float>(std::cos(half));
  const Clip clip = clip_of(node_channel(Property::rotation, {0, 3}, {0, 0, 0, 1, 0, 0, -s, -c}));
  const Pose pose = sample_clip(one_node_one_shape(), clip, 1);
  const Eigen::Vector3d turned = pose.locals[0].rotation * Eigen::Vector3d::UnitX();
  const double angle = std::numbers::pi / 6;
  EXPECT_NEAR((turned - Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).norm(), 0, 1e-7);
  EXPECT_EQ(pose.locals[0].translation, Eigen::Vector3d(7, 8, 9));
}

TEST(SampleClip, TranslationAndScale) {
  Clip clip = clip_of(node_channel(Property::translation, {0, 2}, {0, 0, 0, 2, 4, 6}));
  clip.channels.push_back(node_channel(Property::scale, {0}, {1, 2, 3}));
  const Pose pose = sample_clip(one_node_one_shape(), clip, 1);
  EXPECT_EQ(pose.locals[0].translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pose.locals[0].scale, Eigen::Vector3d(1, 2, 3));
}

TEST(SampleClip, CubicRotationStaysUnit) {
  Channel channel = node_channel(Property::rotation, {0, 1},
                                 {0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
  channel.interpolation = Interpolation::cubic_spline;
  EXPECT_NEAR(sample_clip(one_node_one_shape(), clip_of(channel), 0.5).locals[0].rotation.norm(), 1, 1e-15);
}

TEST(SampleClip, OnePartsShapeAlone) {
  Channel channel = weight_channel(Interpolation::linear, {0}, {0.5f});
  channel.part = 2;
  const Pose pose = sample_clip(one_node_one_shape(), clip_of(channel), 0);
  EXPECT_EQ(pose.shape_weights.values[0], 0.25);
  ASSERT_EQ(pose.part_shape_weights.size(), 1u);
  EXPECT_EQ(pose.part_shape_weights[0].part, 2);
  EXPECT_EQ(pose.part_shape_weights[0].value, 0.5);
}

TEST(sample_clip, slider_channels_drive_shapes_through_their_stops) {
  Character character = one_node_one_shape();
  character.shapes.push_back({"wide", {}});
  character.sliders = {{"jaw", 0, 1, 0.5, {{0.5, 0}, {1, 1}}}};
  Channel channel;
  channel.property = Property::slider;
  channel.slider = 0;
  channel.times = {0, 1};
  channel.values = {0, 1};
  const Clip clip = clip_of(channel);
  EXPECT_EQ(sample_clip(character, clip, 0.75).shape_weights.values, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(sample_rig(character, clip, 0.75).sliders.values[0], 0.75);
  EXPECT_EQ(sample_rig(character, Clip{}, 0).sliders.values[0], 0.5);
}

TEST(sample_rig, a_shape_weight_sets_the_slider_that_has_this_shape_alone) {
  Character character = one_node_one_shape();
  character.sliders[0].stops[0].at = 2;
  Channel channel;
  channel.property = Property::shape_weight;
  channel.shape = 0;
  channel.times = {0};
  channel.values = {0.5};
  EXPECT_EQ(sample_rig(character, clip_of(channel), 0).sliders.values[0], 1);
  EXPECT_EQ(sample_clip(character, clip_of(channel), 0).shape_weights.values[0], 0.5);
}

}  // namespace
}  // namespace mien
