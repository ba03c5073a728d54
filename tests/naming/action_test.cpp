#include "mien/naming/action.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::vector<std::string> whole_actions(std::string_view name) {
  std::vector<std::string> names;
  for (const ActionShare& share : actions_of(name))
    names.push_back((share.share == 1 ? "" : "part of ") +
                    action_names()[static_cast<std::size_t>(share.action)]);
  return names;
}

TEST(actions_of, unknown_names_do_nothing) {
  for (const char* name : {"", "Left", "_", "nonsense", "mouth", "AU", "AU99", "..", "a."})
    EXPECT_THAT(actions_of(name), IsEmpty()) << name;
}

TEST(actions_of, every_way_to_write_a_side_is_the_same) {
  for (const char* name :
       {"mouthSmileLeft", "MouthSmileLeft", "mouthSmile_L", "mouth_smile_l", "L_mouthSmile", "mouthSmile.L",
        "left mouth smile", "MOUTH_SMILE_LEFT", "Head.mouthSmileLeft", "shapes:mouthSmile_L"})
    EXPECT_THAT(whole_actions(name), ElementsAre("mouthSmileLeft")) << name;
}

TEST(actions_of, directions_are_not_sides) {
  EXPECT_THAT(whole_actions("jawLeft"), ElementsAre("jawLeft"));
  EXPECT_THAT(whole_actions("MouthRight"), ElementsAre("mouthRight"));
  EXPECT_THAT(actions_of("jaw"), IsEmpty());
}

TEST(actions_of, a_name_for_both_sides_does_both_and_a_split_one_its_whole) {
  EXPECT_THAT(whole_actions("browDown"), UnorderedElementsAre("browDownLeft", "browDownRight"));
  EXPECT_THAT(whole_actions("browInnerUp_R"), ElementsAre("browInnerUp"));
  EXPECT_THAT(whole_actions("cheekPuff_L"), ElementsAre("cheekPuff"));
}

TEST(actions_of, knows_the_other_conventions) {
  EXPECT_THAT(whole_actions("AU12"), UnorderedElementsAre("mouthSmileLeft", "mouthSmileRight"));
  EXPECT_THAT(whole_actions("AU12L"), ElementsAre("mouthSmileLeft"));
  EXPECT_THAT(whole_actions("au01_r"), ElementsAre("browInnerUp"));
  EXPECT_THAT(whole_actions("eye-left-closure"), ElementsAre("eyeBlinkLeft"));
  EXPECT_THAT(whole_actions("mouth-open"), ElementsAre("jawOpen"));
  EXPECT_THAT(whole_actions("blinkLeft"), ElementsAre("eyeBlinkLeft"));
  EXPECT_THAT(whole_actions("lookLeft"), UnorderedElementsAre("eyeLookOutLeft", "eyeLookInRight"));
  EXPECT_THAT(
      whole_actions("viseme_aa"),
      UnorderedElementsAre("part of jawOpen", "part of mouthLowerDownLeft", "part of mouthLowerDownRight"));
}

TEST(names_in, each_name_does_its_action_and_arkit_has_all) {
  EXPECT_EQ(action_names().size(), 52u);
  EXPECT_EQ(std::set<std::string>(action_names().begin(), action_names().end()).size(), 52u);
  EXPECT_EQ(names_in(Convention::arkit), action_names());
  for (int c = 0; c < convention_count; ++c) {
    const std::vector<std::string> names = names_in(static_cast<Convention>(c));
    ASSERT_EQ(names.size(), 52u);
    for (std::size_t a = 0; a < names.size(); ++a) {
      if (names[a].empty()) continue;
      const std::vector<ActionShare> shares = actions_of(names[a]);
      EXPECT_TRUE(std::any_of(shares.begin(), shares.end(),
                              [&](const ActionShare& share) {
                                return share == ActionShare{static_cast<int>(a), 1};
                              }))
          << names[a] << " for " << action_names()[a];
    }
  }
  EXPECT_EQ(names_in(Convention::ict)[0], "eyeBlink_L");
  EXPECT_EQ(names_in(Convention::live_link)[0], "EyeBlinkLeft");
  EXPECT_EQ(names_in(Convention::makehuman)[0], "eye-left-closure");
  EXPECT_EQ(names_in(Convention::ict)[15], "jawLeft");
}

TEST(find_convention, is_the_one_with_most_names) {
  EXPECT_EQ(find_convention(names_in(Convention::ict)).convention, Convention::ict);
  EXPECT_EQ(find_convention({"AU1", "AU2", "AU4"}).convention, Convention::facs);
  EXPECT_EQ(find_convention({"eye-left-closure", "mouth-open"}).convention, Convention::makehuman);
  EXPECT_EQ(find_convention({"nothing"}).known, 0);
}

TEST(convention_of_name, is_the_inverse_of_name_of) {
  for (int c = 0; c < convention_count; ++c)
    EXPECT_EQ(convention_of_name(name_of(static_cast<Convention>(c))), static_cast<Convention>(c));
  EXPECT_THROW(convention_of_name("pixar"), Error);
}

TEST(mirrored_name, changes_the_side_and_keeps_the_writing) {
  EXPECT_EQ(mirrored_name("mouthSmileLeft"), "mouthSmileRight");
  EXPECT_EQ(mirrored_name("mouthSmile_R"), "mouthSmile_L");
  EXPECT_EQ(mirrored_name("levator02.L"), "levator02.R");
  EXPECT_EQ(mirrored_name("L_brow"), "R_brow");
  EXPECT_EQ(mirrored_name("eye-left-slit"), "eye-right-slit");
  EXPECT_EQ(mirrored_name("AU12R"), "AU12L");
  EXPECT_EQ(mirrored_name("EYE_LEFT"), "EYE_RIGHT");
  EXPECT_EQ(mirrored_name("jawOpen"), "");
}

}  // namespace
}  // namespace mien
