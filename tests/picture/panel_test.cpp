#include "mien/picture/panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/character/sliders.h"
#include "mien/controls/make_controls.h"
#include "mien/core/error.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

Character face() {
  Character c;
  for (const std::string& name : action_names()) c.sliders.push_back({name, 0, 1, 0, {}});
  c.nodes.resize(1);
  c.nodes[0].name = "jaw";
  c.skins.push_back({"", {0}, {Eigen::Matrix4d::Identity()}, true, -1, {}});
  return make_controls(c).character;
}

std::string error_of(const Character& character, const RigPose& pose) {
  try {
    draw_panel(character, pose);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(DrawPanel, BadInputs) {
  Character c = face();
  RigPose pose = rest_rig_pose(c);
  pose.locals.clear();
  EXPECT_THAT(error_of(c, pose), HasSubstr("pose: is of another character"));
  pose = rest_rig_pose(c);
  c.controls[0].sliders[0] = 99;
  EXPECT_THAT(error_of(c, pose), HasSubstr("names slider 99"));
  c = face();
  c.controls[0].position.x() = 1e6;
  EXPECT_THAT(error_of(c, pose), HasSubstr("panel: is larger than a picture may be"));
  c.controls.clear();
  EXPECT_THAT(error_of(c, pose), HasSubstr("has no controls"));
}

TEST(DrawPanel, EveryControlShowsItsValue) {
  const Character c = face();
  const RigPose rest = rest_rig_pose(c);
  const Picture still = draw_panel(c, rest);
  EXPECT_EQ(still, draw_panel(c, rest));
  for (std::size_t s = 0; s < c.sliders.size(); ++s) {
    RigPose pose = rest;
    pose.sliders.values[static_cast<Eigen::Index>(s)] = 0.7;
    EXPECT_FALSE(draw_panel(c, pose) == still) << c.sliders[s].name;
  }
  RigPose turned = rest;
  turned.locals[0].rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  EXPECT_FALSE(draw_panel(c, turned) == still);
}

}  // namespace
}  // namespace mien
