#include "mien/controls/make_controls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Character face_of(const std::vector<std::string>& sliders, const std::vector<std::string>& joints = {}) {
  Character c;
  for (const std::string& name : sliders) c.sliders.push_back({name, 0, 1, 0, {}});
  Skin skin;
  for (const std::string& name : joints) {
    Node node;
    node.name = name;
    skin.joints.push_back(static_cast<int>(c.nodes.size()));
    skin.inverse_bind.push_back(Eigen::Matrix4d::Identity());
    c.nodes.push_back(node);
  }
  if (!joints.empty()) c.skins.push_back(skin);
  return c;
}

const Control& control_of(const Character& c, const std::string& name) {
  const auto found =
      std::find_if(c.controls.begin(), c.controls.end(), [&](const Control& k) { return k.name == name; });
  if (found == c.controls.end()) throw std::runtime_error("no control " + name);
  return *found;
}

std::string mirror_of(const Character& c, const std::string& name) {
  const int mirror = control_of(c, name).mirror;
  return mirror < 0 ? "" : c.controls[mirror].name;
}

bool overlap(const Control& a, const Control& b) {
  const Eigen::Vector2d low = a.position.cwiseMax(b.position),
                        high = (a.position + a.size).cwiseMin(b.position + b.size);
  return low.x() < high.x() - 1e-9 && low.y() < high.y() - 1e-9;
}

/// Every slider and joint once, nothing on top of another, no problem.
void expect_whole(const MadeControls& made) {
  const Character& c = made.character;
  std::vector<int> sliders(c.sliders.size(), 0);
  for (const Control& control : c.controls) {
    EXPECT_FALSE(control.region.empty()) << control.name;
    for (const int slider : control.sliders)
      if (slider >= 0) ++sliders[slider];
  }
  EXPECT_TRUE(std::all_of(sliders.begin(), sliders.end(), [](int count) { return count == 1; }));
  EXPECT_TRUE(control_problems(c).empty());
  EXPECT_TRUE(constraint_problems(c).empty());
  for (std::size_t a = 0; a < c.controls.size(); ++a)
    for (std::size_t b = a + 1; b < c.controls.size(); ++b)
      EXPECT_FALSE(overlap(c.controls[a], c.controls[b])) << c.controls[a].name << " " << c.controls[b].name;
}

std::string error_of(const ControlConfig& config) {
  try {
    make_controls(face_of({"jawOpen"}), config);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "no error";
}

TEST(MakeControls, BadConfigurationsAreRefused) {
  const auto error_with = [](const auto& spoil) {
    ControlConfig config = default_control_config();
    spoil(config);
    return error_of(config);
  };
  EXPECT_EQ(error_with([](ControlConfig& c) {
              c.regions.push_back({"nose", {"n*"}});
            }),
            "region nose: is there twice; give each its own name");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.regions[0].match = {""}; }),
            "region visemes: has an empty pattern; leave it out");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.regions[0].name = ""; }), "region: has no name; give it one");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.pads[1].name = c.pads[0].name; }),
            "pad lookRight: is there twice; give each its own name");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.pads[0].region = "chin"; }),
            "pad lookRight: names region chin; one of the regions");
  EXPECT_EQ(error_with([](ControlConfig& c) {
              c.pads[0].match = {"a", "", "", ""};
            }),
            "pad lookRight: has fewer than two directions; give two or more patterns");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.layout.columns[0].push_back("chin"); }),
            "layout: names region chin; one of the regions");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.layout.columns[0].push_back("nose"); }),
            "layout: places region nose twice; place each once");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.layout.rows = 0; }),
            "layout: has a width or rows out of range; a width of 1 to 1000, 4 to 100000 rows");
  EXPECT_EQ(error_with([](ControlConfig& c) {
              c.limits = {{"jaw*", ValueRange{1, 1}, {}, {}}};
            }),
            "limits jaw*: leave a slider no range; give a low below the high");
  EXPECT_EQ(error_with([](ControlConfig& c) {
              c.limits = {{"jaw*", ValueRange{2, 1}, {}, {}}};
            }),
            "limits jaw*: are no range; give [low, high] with low <= high");
  EXPECT_EQ(error_with([](ControlConfig& c) {
              c.names = {{"*", ""}};
            }),
            "names: has an empty pattern; give both sides");
  EXPECT_EQ(error_with([](ControlConfig& c) { c.other = ""; }),
            "other: is empty; name the region of what fits nowhere");
}

TEST(MakeControls, EveryConventionFindsItsRegions) {
  for (const Convention convention :
       {Convention::arkit, Convention::live_link, Convention::ict, Convention::face_cap,
        Convention::makehuman, Convention::facs, Convention::vrm}) {
    std::vector<std::string> names;
    for (const std::string& name : names_in(convention))
      if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    const MadeControls made = make_controls(face_of(names));
    SCOPED_TRACE(name_of(convention));
    expect_whole(made);
    EXPECT_THAT(made.other_sliders, IsEmpty());
    EXPECT_THAT(made.unused, IsEmpty());
  }
}

TEST(MakeControls, ArkitByRegionsPadsAndMirrors) {
  std::vector<std::string> names = action_names();
  names.push_back("viseme_aa");
  names.push_back("madeUp");
  const MadeControls made = make_controls(face_of(names, {"head", "jaw", "eye_L", "eye_R", "antenna"}));
  const Character& c = made.character;
  expect_whole(made);
  EXPECT_THAT(made.other_sliders, ElementsAre("madeUp"));
  EXPECT_THAT(made.other_joints, ElementsAre("antenna"));
  EXPECT_EQ(control_of(c, "browInnerUp").region, "brows");
  EXPECT_EQ(control_of(c, "eyeSquintLeft").region, "eyes left");
  EXPECT_EQ(control_of(c, "noseSneerRight").region, "nose");
  EXPECT_EQ(control_of(c, "mouthUpperUpRight").region, "mouth right");
  EXPECT_EQ(control_of(c, "viseme_aa").region, "visemes");
  EXPECT_EQ(control_of(c, "madeUp").region, "other");
  EXPECT_EQ(control_of(c, "eye_L").region, "eyes left");
  EXPECT_EQ(control_of(c, "antenna").region, "other");
  const Control& look = control_of(c, "lookLeft");
  EXPECT_EQ(look.kind, Control::Kind::pad);
  EXPECT_EQ(c.sliders[look.sliders[0]].name, "eyeLookOutLeft");
  EXPECT_EQ(c.sliders[look.sliders[3]].name, "eyeLookDownLeft");
  EXPECT_EQ(control_of(c, "jaw").sliders[2], -1);
  EXPECT_EQ(control_of(c, "jaw 2").kind, Control::Kind::joint);
  EXPECT_EQ(control_of(c, "jaw 2").label, "jaw");
  EXPECT_TRUE(control_of(c, "head").moves);
  EXPECT_FALSE(control_of(c, "eye_L").moves);
  EXPECT_EQ(mirror_of(c, "lookLeft"), "lookRight");
  EXPECT_EQ(mirror_of(c, "eyeSquintLeft"), "eyeSquintRight");
  EXPECT_EQ(mirror_of(c, "eye_R"), "eye_L");
  EXPECT_EQ(mirror_of(c, "browInnerUp"), "");
  // The character's right lies on the left.
  EXPECT_LT(control_of(c, "eyeSquintRight").position.x(), control_of(c, "eyeSquintLeft").position.x());
}

TEST(MakeControls, APadNeedsTwo) {
  const MadeControls made = make_controls(face_of({"eyeBlinkLeft", "jawOpen", "jawLeft"}));
  EXPECT_EQ(control_of(made.character, "eyeBlinkLeft").kind, Control::Kind::slider);
  EXPECT_EQ(control_of(made.character, "jaw").kind, Control::Kind::pad);
}

TEST(MakeControls, ProductionsNamesLimitsAndMirrors) {
  ControlConfig config = default_control_config();
  config.names = {{"CTL_?_SmileUp", "mouthSmile?"}, {"JNT_mandible", "jaw"}, {"unseen*", "jaw"}};
  config.mirrors = {{"CTL_A_*", "CTL_B_*"}};
  ControlLimits smile{"CTL_*_SmileUp", ValueRange{-0.5, 1.5}, {}, {}}, jaw{"jaw", std::nullopt, {}, {}};
  jaw.rotation[0] = {0, 0.5};
  config.limits = {smile, jaw};
  Character face = face_of({"CTL_A_SmileUp", "CTL_B_SmileUp"}, {"JNT_mandible"});
  MadeControls made = make_controls(face, config);
  expect_whole(made);
  EXPECT_EQ(control_of(made.character, "CTL_A_SmileUp").region, "mouth");
  EXPECT_EQ(control_of(made.character, "JNT_mandible").region, "jaw");
  EXPECT_EQ(mirror_of(made.character, "CTL_B_SmileUp"), "CTL_A_SmileUp");
  EXPECT_EQ(made.character.sliders[0].maximum, 1.5);
  EXPECT_EQ(made.character.sliders[0].minimum, -0.5);
  ASSERT_EQ(made.character.constraints.size(), 1u);
  EXPECT_EQ(made.character.constraints[0].name, "JNT_mandible limits");
  EXPECT_EQ(made.character.constraints[0].rotation[0], (ValueRange{0, 0.5}));
  EXPECT_THAT(made.unused, ElementsAre("names unseen*"));
  // Made again, it is the same.
  const MadeControls again = make_controls(made.character, config);
  EXPECT_EQ(again.character.controls, made.character.controls);
  EXPECT_EQ(again.character.constraints.size(), 1u);
}

TEST(MakeControls, ManyNamesGoOnInOtherColumns) {
  std::vector<std::string> names;
  for (int k = 0; k < 150; ++k) names.push_back("thing" + std::to_string(k));
  ControlConfig config = default_control_config();
  config.layout.rows = 20;
  const MadeControls made = make_controls(face_of(names), config);
  expect_whole(made);
  for (const Control& control : made.character.controls)
    EXPECT_LE(control.position.y() + control.size.y(), 20 + 1e-9);
}

TEST(MakeControls, NothingToControlMakesNothing) {
  EXPECT_THAT(make_controls(Character{}).character.controls, IsEmpty());
}

}  // namespace
}  // namespace mien
