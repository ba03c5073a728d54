#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "full_character.h"
#include "mien/character/sliders.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::expect_same;
using test::Folder;
using test::full_character;

/// Shapes jawOpen, smile, nothing: an in-between, a range below 0, a corrective, an expression.
Character character_with_sliders() {
  Character c = full_character();
  c.sliders = {{"mouth", -1, 1.5, 0.25, {{-1, 1}, {0.5, 0}}}, {"spare", 0, 1, 0, {}}};
  c.correctives = {{2, CorrectiveRule::smooth, {{0, 0.5}, {1, 1}}}};
  c.expressions = {{"grin", {{0, -0.75}}}, {"all", {{0, 1}, {1, 0.5}}}};
  return c;
}

Clip slider_clip() {
  Channel mouth;
  mouth.property = Channel::Property::slider;
  mouth.slider = 0;
  mouth.interpolation = Interpolation::cubic_spline;
  mouth.times = {0, 0.5f};
  mouth.values = {0, 0.25f, 1, 0, 0.5f, 0};
  return {"slide", {mouth}, {}};
}

TEST(slider_round_trip, sliders_correctives_and_expressions_come_back) {
  const Folder folder;
  Character c = character_with_sliders();
  for (const char* name : {"sliders.glb", "sliders.gltf"}) {
    save(c, folder / name);
    expect_same(c, load(folder / name));
  }
}

TEST(slider_round_trip, plain_sliders_need_no_extension) {
  const Folder folder;
  const Character c = full_character();
  save(c, folder / "plain.gltf");
  const nlohmann::json file = nlohmann::json::parse(read_file(folder / "plain.gltf"));
  EXPECT_FALSE(file["extensions"]["MIEN_character"].contains("sliders"));
  EXPECT_EQ(file["meshes"][0]["weights"][0], 0.25);
}

TEST(slider_round_trip, a_slider_clip_comes_back_and_others_see_its_shapes) {
  const Folder folder;
  Character c = character_with_sliders();
  c.clips = {slider_clip()};
  save(c, folder / "clip.gltf");
  expect_same(c, load(folder / "clip.gltf"));

  nlohmann::json file = nlohmann::json::parse(read_file(folder / "clip.gltf"));
  file["animations"][0].erase("extensions");
  file["extensions"].erase("MIEN_character");
  const std::string text = file.dump();
  const Character plain = load(folder.write("clip.gltf", text));
  ASSERT_EQ(plain.clips.size(), 1u);
  // Weights channels of the first part's shapes; the corrective moves with its input.
  double open = -1;
  for (const Channel& channel : plain.clips[0].channels)
    if (plain.shapes[channel.shape].name == "jawOpen") open = channel.values.back();
  EXPECT_DOUBLE_EQ(open, 1);
}

TEST(slider_round_trip, a_plain_slider_keeps_its_own_keys) {
  const Folder folder;
  Character c = full_character();
  c.clips = {slider_clip()};
  save(c, folder / "clip.glb");
  const Character again = load(folder / "clip.glb");
  expect_same(c, again);
  EXPECT_EQ(again.clips[0].channels[0].property, Channel::Property::slider);
}

TEST(slider_round_trip, names_that_the_file_does_not_have_are_said) {
  const Folder folder;
  save(character_with_sliders(), folder / "s.gltf");
  const std::vector<std::uint8_t> bytes = read_file(folder / "s.gltf");
  const auto error_with = [&](const char* change_at, const nlohmann::json& value) {
    nlohmann::json file = nlohmann::json::parse(bytes);
    file["extensions"]["MIEN_character"][nlohmann::json::json_pointer(change_at)] = value;
    const auto path = folder.write("bad.gltf", file.dump());
    return test::error_of([&] { load(path); });
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error_with("/sliders/0/stops/0/shape", "gone"),
              HasSubstr("names gone; name a shape of a mesh"));
  EXPECT_THAT(error_with("/sliders/0/stops/0/at", 0.75), HasSubstr("slider mouth: has a stop at 0.5"));
  EXPECT_THAT(error_with("/sliders/0/minimum", 2), HasSubstr("slider mouth: has no range"));
  EXPECT_THAT(error_with("/correctives/0/rule", "sum"),
              HasSubstr("rule: is \"sum\"; give product, smallest or smooth"));
  EXPECT_THAT(error_with("/correctives/0/inputs/0/slider", "gone"),
              HasSubstr("names gone; name one of the sliders"));
  EXPECT_THAT(error_with("/expressions/0/values", {{"gone", 1}}), HasSubstr("names gone"));
}

}  // namespace
}  // namespace mien
