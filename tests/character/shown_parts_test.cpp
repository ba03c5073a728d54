#include "mien/character/shown_parts.h"

#include <gtest/gtest.h>

#include "mien/character/validate.h"

namespace mien {
namespace {

Part triangle(const std::string& name, bool shown) {
  Part part;
  part.name = name;
  part.shown = shown;
  part.mesh.positions = Points::Random(3, 3);
  part.mesh.faces.push_back({0, 1, 2});
  return part;
}

/// One part that is shown and one that is not, and something of every kind on both.
Character two_parts() {
  Character c;
  c.parts = {triangle("skin", true), triangle("spare", false)};
  c.shapes.resize(1);
  c.shapes[0].name = "up";
  for (int p = 0; p < 2; ++p) {
    c.shapes[0].parts.push_back({p, {0}, Points::Ones(1, 3), {}, {}});
    SurfacePoint at;
    at.part = p;
    at.vertex = 1;
    c.landmarks.push_back({"point" + std::to_string(p), at});
    c.curves.push_back({"curve" + std::to_string(p), {at, at}, 3});
    Channel channel;
    channel.property = Channel::Property::shape_weight;
    channel.shape = 0;
    channel.part = p;
    channel.times = channel.values = {0, 1};
    c.clips.resize(1);
    c.clips[0].channels.push_back(channel);
  }
  return c;
}

TEST(shown_parts, counts_those_that_are_shown) {
  EXPECT_EQ(shown_part_count(Character{}), 0u);
  EXPECT_EQ(shown_part_count(two_parts()), 1u);
}

TEST(shown_parts, what_refers_to_the_others_goes_with_them) {
  const Character shown = only_shown(two_parts());
  ASSERT_EQ(shown.parts.size(), 1u);
  EXPECT_EQ(shown.parts[0].name, "skin");
  EXPECT_EQ(shown.shapes[0].parts.size(), 1u);
  EXPECT_EQ(shown.landmarks.size(), 1u);
  ASSERT_EQ(shown.curves.size(), 1u);
  EXPECT_EQ(shown.curves[0].name, "curve0");
  EXPECT_EQ(shown.clips[0].channels.size(), 1u);
  EXPECT_TRUE(validate(shown).empty());
}

TEST(shown_parts, a_character_that_shows_all_stays_as_it_is) {
  Character c = two_parts();
  c.parts[1].shown = true;
  const Character same = only_shown(c);
  EXPECT_EQ(same.parts.size(), 2u);
  EXPECT_EQ(same.landmarks.size(), 2u);
  EXPECT_EQ(same.clips[0].channels.size(), 2u);
}

}  // namespace
}  // namespace mien
