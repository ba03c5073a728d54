#include "mien/naming/rename.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/character/sliders.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

Character face(const std::vector<std::string>& shapes) {
  Character character;
  for (const std::string& name : shapes) character.shapes.push_back({name, {}});
  complete_sliders(character);
  return character;
}

TEST(rename, bad_names_are_said) {
  const Character character = face({"a", "b"});
  EXPECT_THROW(rename(character, {{"c", "d"}}), Error);
  EXPECT_THROW(rename(character, {{"a", "b"}}), Error);
}

TEST(rename, sliders_and_their_shapes_change_together) {
  Character character = face({"jawOpen", "smile"});
  character.sliders[1].name = "happy";
  const Character renamed = rename(character, {{"jawOpen", "JawOpen"}, {"happy", "glad"}});
  EXPECT_EQ(renamed.shapes[0].name, "JawOpen");
  EXPECT_EQ(renamed.sliders[0].name, "JawOpen");
  EXPECT_EQ(renamed.sliders[1].name, "glad");
  EXPECT_EQ(renamed.shapes[1].name, "smile");
}

TEST(rename, names_may_be_exchanged) {
  const Character renamed = rename(face({"a", "b"}), {{"a", "b"}, {"b", "a"}});
  EXPECT_EQ(renamed.shapes[0].name, "b");
}

TEST(names_for, gives_what_does_the_same_and_leaves_what_would_collide) {
  const Character character = face({"jawOpen", "mouthSmile_L", "browInnerUp_L", "browInnerUp_R", "wink"});
  EXPECT_THAT(names_for(character, Convention::arkit),
              ElementsAre(Pair("jawOpen", "jawOpen"), Pair("mouthSmile_L", "mouthSmileLeft")));
  EXPECT_THAT(names_for(face({"mouthSmile"}), Convention::facs), ElementsAre(Pair("mouthSmile", "AU12")));
}

}  // namespace
}  // namespace mien
