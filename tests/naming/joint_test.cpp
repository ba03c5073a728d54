#include "mien/naming/joint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mien/core/error.h"

namespace mien {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> known(JointConvention convention) {
  std::vector<std::string> names = joint_names_in(convention);
  std::erase(names, "");
  return names;
}

std::string joint_of(const std::vector<std::string>& names, std::size_t which) {
  const int joint = joints_of(names)[which];
  return joint < 0 ? "" : joint_names()[static_cast<std::size_t>(joint)];
}

TEST(JointNames, UnknownConventionIsSaid) {
  try {
    joint_convention_of_name("bipedal");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("joint convention bipedal: is not known; one of: vrm, rigify, makehuman, mixamo"));
  }
  EXPECT_EQ(joint_convention_of_name("rigify"), JointConvention::rigify);
}

TEST(JointNames, AreUniqueAndMirrored) {
  const std::vector<std::string>& names = joint_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    const std::string mirror = mirrored_name(name);
    EXPECT_TRUE(mirror.empty() || std::find(names.begin(), names.end(), mirror) != names.end()) << name;
  }
}

TEST(JointNames, EachConventionIsRecognisedAndReadBack) {
  for (int c = 0; c < joint_convention_count; ++c) {
    const auto convention = static_cast<JointConvention>(c);
    const std::vector<std::string> names = known(convention);
    SCOPED_TRACE(name_of(convention));
    const FoundJointConvention found = find_joint_convention(names);
    EXPECT_EQ(found.convention, convention);
    EXPECT_EQ(found.known, static_cast<int>(names.size()));
    const std::vector<int> joints = joints_of(names);
    for (std::size_t n = 0; n < names.size(); ++n) {
      ASSERT_GE(joints[n], 0) << names[n];
      EXPECT_EQ(joint_names_in(convention)[static_cast<std::size_t>(joints[n])], names[n]);
    }
  }
}

TEST(JointNames, TheSameWordMeansWhatItsConventionSays) {
  EXPECT_EQ(joint_of({"spine", "spine.001", "spine.006", "thigh.L"}, 0), "hips");
  EXPECT_EQ(joint_of({"spine", "chest", "head", "leftUpperArm"}, 0), "spine");
  EXPECT_EQ(joint_of({"DEF-spine.006", "DEF-lid.T.R", "DEF-tongue.001"}, 1), "rightUpperLid");
  EXPECT_EQ(joint_of({"mixamorig:Hips", "mixamorig:LeftUpLeg", "mixamorig:RightArm"}, 2), "rightUpperArm");
}

TEST(JointNames, UsualWordsToo) {
  EXPECT_EQ(joint_of({"Head"}, 0), "head");
  EXPECT_EQ(joint_of({"eye_L"}, 0), "leftEye");
  EXPECT_EQ(joint_of({"eyeRight_joint"}, 0), "rightEye");
  EXPECT_EQ(joint_of({"upperarm_r"}, 0), "rightUpperArm");
  EXPECT_EQ(joint_of({"mandible"}, 0), "jaw");
  EXPECT_EQ(joint_of({"antenna"}, 0), "");
  EXPECT_EQ(joint_of({"head", "Head"}, 1), "");
}

TEST(JointNames, ACharactersJointsGetTheOthersNames) {
  Character c;
  c.nodes.resize(4);
  const char* names[] = {"head", "jaw", "eye_L", "horn"};
  for (int n = 0; n < 4; ++n) c.nodes[n].name = names[n];
  Skin skin;
  skin.joints = {0, 1, 2, 3};
  c.skins = {skin};
  EXPECT_THAT(
      joint_names_for(c, JointConvention::rigify),
      ElementsAre(std::pair("head", "spine.006"), std::pair("jaw", "jaw"), std::pair("eye_L", "eye.L")));
}

}  // namespace
}  // namespace mien
