// Whole transfers of a rig that has everything: objects, wires, constraints, controls and every kind of channel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/rigged_human.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

const TransferResult& on_cartoon() {
  static const TransferResult result = transfer(rigged_human(), made("cartoon"));
  return result;
}

void expect_sound_bindings(const Character& character) {
  for (const InfluenceObject& object : character.objects)
    for (const InfluenceBinding& binding : object.bindings) {
      ASSERT_EQ(binding.weights.size(), binding.vertices.size()) << object.name;
      for (std::size_t i = 0; i < binding.vertices.size(); ++i) {
        if (i > 0) {
          EXPECT_LT(binding.vertices[i - 1], binding.vertices[i]);
        }
        EXPECT_GT(binding.weights[i], 0);
        EXPECT_LE(binding.weights[i], 1);
        if (binding.offsets.empty()) continue;
        double sum = 0;
        for (int e = binding.offsets[i]; e < binding.offsets[i + 1]; ++e) {
          EXPECT_LT(binding.controls[e], object.controls.rows());
          sum += binding.coefficients[e];
        }
        EXPECT_NEAR(sum, 1, 1e-5) << object.name;
      }
    }
}

TEST(carry_rig, everything_arrives_on_another_face) {
  const Character& character = on_cartoon().character;
  EXPECT_THAT(validate(character), IsEmpty());
  ASSERT_THAT(character.objects, SizeIs(4));
  ASSERT_THAT(character.wires, SizeIs(1));
  ASSERT_THAT(character.constraints, SizeIs(2));
  ASSERT_THAT(character.controls, SizeIs(2));
  expect_sound_bindings(character);
  for (std::size_t o = 0; o < 3; ++o) {
    EXPECT_EQ(character.objects[o].form, rigged_human().objects[o].form);
    EXPECT_FALSE(character.objects[o].bindings.empty()) << character.objects[o].name;
  }
  const auto name_of = [&](int node) { return character.nodes[node].name; };
  EXPECT_EQ(name_of(character.objects[0].carrier), "head");
  EXPECT_EQ(name_of(character.objects[1].node), "jaw");
  EXPECT_EQ(name_of(character.objects[2].node), "nose");
  EXPECT_EQ(name_of(character.skins[0].joints[character.objects[0].skin_weights.joints[1]]), "lipLower");
  EXPECT_EQ(name_of(character.constraints[0].node), "jaw");
  EXPECT_EQ(name_of(character.controls[1].node), "jaw");
}

TEST(carry_rig, control_points_on_landmarks_come_to_lie_near_the_targets_landmarks) {
  const TransferResult& result = on_cartoon();
  const Character& target = made("cartoon");
  const double unit = result.report.unit;
  for (const auto& [object, control, number] :
       {std::tuple{0, 0, 49}, {0, 1, 59}, {0, 2, 57}, {0, 3, 55}, {2, 0, 31}, {3, 0, 22}}) {
    const Eigen::RowVector3d place = result.character.objects[object].controls.row(control);
    EXPECT_LT((place - landmark_place(target, number)).norm(), 0.04 * unit) << number;
  }
}

/// The values of the clip's channel of this property.
const Channel& channel_of(const Character& character, Channel::Property property) {
  for (const Channel& channel : character.clips.back().channels)
    if (channel.property == property) return channel;
  ADD_FAILURE() << "no such channel";
  return character.clips.back().channels.front();
}

TEST(carry_rig, a_moved_and_grown_target_gets_the_moved_and_grown_rig) {
  const Similarity by{64, Eigen::Matrix3d::Identity(), {0, 0, 0}};  // no digit of the surface changes
  Character grown = made("cartoon");
  for (Part& part : grown.parts) part.mesh.positions *= 64;
  const TransferResult result = transfer(rigged_human(), grown);
  const Character &big = result.character, &plain = on_cartoon().character;
  const double small = 1e-6 * result.report.unit;
  for (std::size_t o = 0; o < 4; ++o) {
    EXPECT_LT((big.objects[o].controls - by(plain.objects[o].controls)).norm(), small);
    EXPECT_EQ(big.objects[o].bindings.size(), plain.objects[o].bindings.size());
  }
  EXPECT_LT((big.wires[0].curve.controls - by(plain.wires[0].curve.controls)).norm(), small);
  EXPECT_NEAR(big.wires[0].ranges[0] / plain.wires[0].ranges[0], 64, 1e-4);
  EXPECT_NEAR(big.constraints[0].translation[1].high / plain.constraints[0].translation[1].high, 64, 1e-4);
  EXPECT_EQ(big.constraints[0].rotation, plain.constraints[0].rotation);
  EXPECT_LT((big.shapes[0].objects[0].controls - by.of_vectors(plain.shapes[0].objects[0].controls)).norm(),
            small);
  for (const auto property : {Channel::Property::object_control, Channel::Property::wire_control})
    for (std::size_t i = 3; i < 6; ++i)
      EXPECT_NEAR(channel_of(big, property).values[i], 64 * channel_of(plain, property).values[i], small);
  EXPECT_EQ(channel_of(big, Channel::Property::wire_scale).values,
            channel_of(rigged_human(), Channel::Property::wire_scale).values);
}

TEST(carry_rig, a_second_rig_replaces_the_first) {
  const Character again = transfer(rigged_human(), on_cartoon().character).character;
  EXPECT_THAT(validate(again), IsEmpty());
  EXPECT_THAT(again.objects, SizeIs(4));
  EXPECT_THAT(again.wires, SizeIs(1));
  EXPECT_THAT(again.constraints, SizeIs(2));
  EXPECT_THAT(again.controls, SizeIs(2));
  const Character plain = transfer(made("human"), on_cartoon().character).character;
  EXPECT_EQ(plain.objects.size(), made("human").objects.size());
  EXPECT_EQ(plain.constraints.size(), made("human").constraints.size());
}

TEST(carry_rig, objects_alone_are_a_rig) {
  Character source = rigged_human();
  source.shapes.clear();
  source.sliders.clear();
  source.correctives.clear();
  source.expressions.clear();
  source.clips.clear();
  source.controls.clear();
  source.skins.clear();
  source.objects[0].skin = -1;
  source.objects[0].skin_weights = {};
  for (Part& part : source.parts) {
    part.skin = -1;
    part.skin_weights = {};
  }
  const Character result = transfer(source, made("cartoon")).character;
  EXPECT_THAT(validate(result), IsEmpty());
  ASSERT_THAT(result.objects, SizeIs(4));
  expect_sound_bindings(result);
  EXPECT_THAT(result.skins, IsEmpty());
  EXPECT_EQ(result.nodes[result.objects[2].node].name, "nose");
}

TEST(carry_rig, exaggeration_takes_objects_and_wires_along) {
  TransferOptions options;
  options.exaggeration = 1.5;
  const Character more = transfer(rigged_human(), made("cartoon"), options).character;
  const Shape &a = more.shapes[0], &b = on_cartoon().character.shapes[0];
  EXPECT_LT((a.objects[0].controls - 1.5 * b.objects[0].controls).norm(), 1e-9);
  EXPECT_LT((a.wires[0].controls - 1.5 * b.wires[0].controls).norm(), 1e-9);
  EXPECT_NEAR(a.wires[0].scale, 1.5 * b.wires[0].scale, 1e-9);
}

TEST(carry_rig, the_thesis_method_warps_control_points) {
  TransferOptions options;
  options.method = TransferMethod::thesis;
  const TransferResult result = transfer(rigged_human(), made("cartoon"), options);
  EXPECT_THAT(validate(result.character), IsEmpty());
  // Landmarks are met exactly, and so are control points that lie on them.
  for (const auto& [object, control, number] : {std::tuple{0, 0, 49}, {0, 3, 55}, {2, 0, 31}})
    EXPECT_LT(
        (result.character.objects[object].controls.row(control) - landmark_place(made("cartoon"), number))
            .norm(),
        1e-6 * result.report.unit);
}

}  // namespace
}  // namespace mien::test
