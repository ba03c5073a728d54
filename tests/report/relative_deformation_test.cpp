#include "mien/report/relative_deformation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "character/objects_in_code.h"
#include "error_of.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Three joints in a row along x, one apart; the last two move in `move_clip`. One triangle with a shape that moves its
/// first corner by 2 along x.
Character three_joints() {
  Character character;
  for (const char* name : {"root", "jaw", "lip"}) {
    Node node;
    node.name = name;
    node.parent = static_cast<int>(character.nodes.size()) - 1;
    if (node.parent >= 0) node.rest.translation.x() = 1;
    character.nodes.push_back(node);
  }
  character.skins.push_back(
      {"skin", {0, 1, 2}, std::vector<Eigen::Matrix4d>(3, Eigen::Matrix4d::Identity()), true, -1, {}});
  Part part;
  part.name = "face";
  part.mesh.positions.resize(3, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  part.mesh.faces.push_back({0, 1, 2});
  character.parts.push_back(part);
  Shape shape;
  shape.name = "pull";
  Points delta(1, 3);
  delta << 2, 0, 0;
  shape.parts.push_back({0, {1}, delta, {}, {}});
  character.shapes.push_back(shape);
  return character;
}

Channel slide(int node, std::vector<float> times, const std::vector<float>& x) {
  Channel channel;
  channel.property = Channel::Property::translation;
  channel.node = node;
  channel.times = std::move(times);
  for (const float value : x) channel.values.insert(channel.values.end(), {value, 0.f, 0.f});
  return channel;
}

TEST(RelativeDeformation, InvalidInputs) {
  const Character character = three_joints();
  const Clip clip{"talk", {slide(2, {0, 1}, {1, 2})}, {}};
  EXPECT_THAT(error_of([] {
                relative_deformation(0, {1, 2});
              }),
              HasSubstr("relative deformation: has a length at rest of 0"));
  EXPECT_THAT(error_of([] { relative_deformation(std::numeric_limits<double>::quiet_NaN(), {1}); }),
              HasSubstr("two points apart"));
  EXPECT_THAT(error_of([] { compare_curves({1}, {1, 2}); }), HasSubstr("have 1 and 2 values"));
  EXPECT_THAT(error_of([] { compare_curves({}, {}); }), HasSubstr("at least one"));
  EXPECT_THAT(error_of([&] { sample_times(clip, 0); }), HasSubstr("rate: is not positive"));
  EXPECT_THAT(error_of([&] { sample_times(clip, 30, 1); }), HasSubstr("at least 2 moments"));
  EXPECT_THAT(error_of([&] { track_nodes(character, clip, {0}, {3}); }),
              HasSubstr("node 3: does not exist; one of 3"));
  EXPECT_THAT(error_of([&] {
                relative_deformation(track_nodes(character, clip, {0}, {1, 1}), PointPair{0, 1});
              }),
              HasSubstr("two points apart"));
}

TEST(RelativeDeformation, FollowsItsDefinition) {
  EXPECT_THAT(relative_deformation(2, {2, 3, 1, 0}), ElementsAre(0, 0.5, -0.5, -1));
}

TEST(RelativeDeformation, IsTheSameAtAnySize) {
  const std::vector<double> lengths{2, 2.5, 3.25};
  std::vector<double> large;
  for (const double l : lengths) large.push_back(64 * l);
  EXPECT_EQ(relative_deformation(2, lengths), relative_deformation(128, large));
}

TEST(CompareCurves, KnowsEqualScaledOppositeAndConstantCurves) {
  const std::vector<double> curve{0, 1, 3, -2}, none{0, 0, 0, 0};
  const auto times = [&](double factor) {
    std::vector<double> scaled;
    for (const double value : curve) scaled.push_back(factor * value);
    return scaled;
  };
  const CurveAgreement same = compare_curves(curve, curve);
  EXPECT_NEAR(same.correlation, 1, 1e-12);
  EXPECT_EQ(same.rms_difference, 0);
  EXPECT_NEAR(same.gain, 1, 1e-12);
  const CurveAgreement damped = compare_curves(curve, times(0.25));
  EXPECT_NEAR(damped.correlation, 1, 1e-12);
  EXPECT_NEAR(damped.gain, 0.25, 1e-12);
  EXPECT_NEAR(damped.rms_difference, 0.75 * std::sqrt(14.0 / 4), 1e-12);
  EXPECT_NEAR(compare_curves(curve, times(-1)).correlation, -1, 1e-12);
  EXPECT_EQ(compare_curves(none, none).correlation, 1);
  EXPECT_EQ(compare_curves(curve, none).correlation, 0);
  EXPECT_EQ(compare_curves(none, curve).gain, 1);
}

TEST(SampleTimes, CoversTheClipEvenly) {
  const Clip clip{"talk", {slide(0, {0, 0.1f}, {0, 1})}, {}};
  const auto seconds = sample_times(clip, 30);
  EXPECT_THAT(seconds, SizeIs(4));
  EXPECT_EQ(seconds.front(), 0);
  EXPECT_NEAR(seconds[1], 1.0 / 30, 1e-12);
  EXPECT_NEAR(seconds.back(), 0.1, 1e-7);
  EXPECT_THAT(sample_times(clip, 30, 2), ElementsAre(0, DoubleNear(0.1, 1e-7)));
  EXPECT_THAT(sample_times({"empty", {}, {}}), ElementsAre(0));
  EXPECT_THAT(sample_times({"long", {slide(0, {0, 1e6f}, {0, 1})}, {}}), SizeIs(600));
}

TEST(Tracks, FollowJointsAndSurfacePoints) {
  const Character character = three_joints();
  Clip clip{"talk", {slide(2, {0, 1}, {1, 3})}, {}};
  const PointTracks joints = track_nodes(character, clip, {0, 0.5, 1}, {0, 2});
  EXPECT_THAT(relative_deformation(joints, {0, 1}),
              ElementsAre(0, DoubleNear(0.5, 1e-7), DoubleNear(1, 1e-7)));

  Channel pull;
  pull.property = Channel::Property::shape_weight;
  pull.shape = 0;
  pull.times = {0, 1};
  pull.values = {0, 0.5};
  clip.channels = {pull};
  SurfacePoint first, second;
  first.vertex = 0;
  second.vertex = 1;
  const PointTracks surface = track_surface(character, clip, {0, 1}, {first, second});
  EXPECT_THAT(relative_deformation(surface, {0, 1}), ElementsAre(0, DoubleNear(1, 1e-7)));
}

TEST(Tracks, FollowControlPointsOfObjects) {
  Character character = test::head_and_lip();
  character.objects = {test::line()};
  Channel pull;
  pull.property = Channel::Property::object_control;
  pull.object = 0;
  pull.control = 1;
  pull.times = {0, 1};
  pull.values = {0, 0, 0, 1, 0, 0};
  Channel turn;  // the head carries both control points
  turn.property = Channel::Property::rotation;
  turn.node = 1;
  turn.times = {0, 1};
  turn.values = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f};
  const Clip clip{"pull", {pull, turn}, {}};
  const PointTracks tracks = track_controls(character, clip, {0, 0.5, 1}, {{0, 0}, {0, 1}});
  EXPECT_THAT(relative_deformation(tracks, {0, 1}),
              ElementsAre(DoubleNear(0, 1e-9), DoubleNear(0.25, 1e-6), DoubleNear(0.5, 1e-6)));
  EXPECT_GT((tracks.frames[2].row(0) - tracks.rest.row(0)).norm(), 0.1);
  EXPECT_THAT(error_of([&] {
                track_controls(character, clip, {0}, {{0, 2}});
              }),
              HasSubstr("control point 2 of object 0: does not exist"));
}

/// Four points on a line; the second and the fourth swing in time with each other, the third not at all.
PointTracks swinging() {
  PointTracks tracks;
  tracks.rest.resize(5, 3);
  tracks.rest << 0, 0, 0, 1, 0, 0, 0, 5, 0, 1, 5, 0, 0, 0, 1e-3;
  for (int k = 0; k < 20; ++k) {
    PointsD frame = tracks.rest;
    const double t = 2 * std::numbers::pi * k / 20;
    frame(1, 0) += 0.8 * std::sin(t);
    frame(3, 0) += 0.5 * std::sin(2 * t);
    frame(4, 2) += 0.5 * std::sin(t);
    tracks.frames.push_back(frame);
  }
  return tracks;
}

TEST(TellingPairs, TakesTheLargestRangesWithoutRepeatingPointsOrStories) {
  const auto pairs = telling_pairs(swinging(), 0.1, 4);
  ASSERT_THAT(pairs, SizeIs(2));
  EXPECT_EQ(pairs[0].a, 0);
  EXPECT_EQ(pairs[0].b, 1);
  EXPECT_EQ(pairs[1].a, 2);
  EXPECT_EQ(pairs[1].b, 3);
  EXPECT_THAT(telling_pairs(swinging(), 0.1, 1), SizeIs(1));
}

TEST(TellingPairs, LeavesOutPointsThatLieCloseAndClipsThatAreStill) {
  EXPECT_EQ(telling_pairs(swinging(), 0, 1)[0].b, 4) << "without a least length the close pair leads";
  PointTracks still = swinging();
  for (PointsD& frame : still.frames) frame = still.rest;
  EXPECT_THAT(telling_pairs(still, 0.1, 4), IsEmpty());
  still.frames.clear();
  EXPECT_THAT(telling_pairs(still, 0.1, 4), IsEmpty());
}

TEST(CopyByName, KeepsValuesAndFindsNodesAndShapesByName) {
  const Character from = three_joints();
  Character to = from;
  std::swap(to.nodes[1].name, to.nodes[2].name);
  to.shapes[0].name = "other";
  Channel pull;
  pull.property = Channel::Property::shape_weight;
  pull.shape = 0;
  pull.times = {0};
  pull.values = {1};
  const Clip copy = copy_by_name(from, {"talk", {slide(1, {0}, {7}), pull}, {}}, to);
  ASSERT_THAT(copy.channels, SizeIs(1));
  EXPECT_EQ(copy.channels[0].node, 2);
  EXPECT_EQ(copy.channels[0].values[0], 7);
}

/// The thesis's figure 5.3: on a target of twice the size a copied clip moves half as far.
TEST(CopyByName, ACopiedTranslationIsDampedOnALargerFace) {
  const Character source = three_joints();
  Character target = source;
  for (Node& node : target.nodes) node.rest.translation *= 2;
  const Clip clip{"talk", {slide(2, {0, 1}, {1, 2})}, {}};
  Clip carried{"talk", {slide(2, {0, 1}, {2, 4})}, {}};
  const auto curve = [](const Character& character, const Clip& played) {
    return relative_deformation(track_nodes(character, played, {0, 1}, {1, 2}), PointPair{0, 1});
  };
  EXPECT_THAT(curve(source, clip), ElementsAre(0, 1));
  EXPECT_THAT(curve(target, carried), ElementsAre(0, 1));
  EXPECT_THAT(curve(target, copy_by_name(source, clip, target)), ElementsAre(-0.5, 0));
}

}  // namespace
}  // namespace mien
