#include "mien/naming/plan_vrm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// One vertex that every shape moves.
Character face_of(const std::vector<std::string>& shapes) {
  Character c;
  Part part;
  part.name = "Face";
  part.mesh.positions = Points::Zero(2, 3);
  part.mesh.positions(1, 1) = 2;
  c.parts = {part};
  for (const std::string& name : shapes) {
    PartDelta delta;
    delta.vertices = {0};
    delta.deltas = Points::Ones(1, 3);
    c.shapes.push_back({name, {delta}});
  }
  complete_sliders(c);
  return c;
}

void add_joints(Character& c, const std::vector<std::pair<std::string, int>>& joints) {
  Skin skin;
  for (const auto& [name, parent] : joints) {
    Node node;
    node.name = name;
    node.parent = parent;
    node.rest.translation = {0.1, 1, 0.2};
    node.rest.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
    skin.joints.push_back(static_cast<int>(c.nodes.size()));
    skin.inverse_bind.push_back(Eigen::Matrix4d::Identity());
    c.nodes.push_back(node);
  }
  c.skins = {skin};
}

const VrmExpression& expression_of(const VrmPlan& plan, const std::string& name) {
  for (const VrmExpression& expression : plan.avatar.expressions)
    if (expression.name == name) return expression;
  throw std::runtime_error("no expression " + name);
}

double weight_in(const VrmPlan& plan, const std::string& expression, const std::string& shape) {
  for (const VrmBind& bind : expression_of(plan, expression).binds)
    if (plan.character.shapes[static_cast<std::size_t>(bind.shape)].name == shape) return bind.weight;
  return 0;
}

int bone_of(const VrmPlan& plan, const std::string& name) {
  for (const VrmBone& bone : plan.avatar.bones)
    if (bone.name == name) return bone.node;
  return -1;
}

VrmMeta meta() {
  VrmMeta meta;
  meta.name = "a";
  meta.authors = {"b"};
  return meta;
}

TEST(PlanVrm, ACharacterWithoutPartsIsRefused) {
  EXPECT_THROW(plan_vrm(Character{}, meta()), Error);
}

TEST(PlanVrm, ArkitMakesEveryPreset) {
  const VrmPlan plan = plan_vrm(face_of(action_names()), meta());
  EXPECT_THAT(plan.missing_presets, IsEmpty());
  EXPECT_EQ(weight_in(plan, "blink", "eyeBlinkLeft"), 1);
  EXPECT_EQ(weight_in(plan, "blink", "eyeBlinkRight"), 1);
  EXPECT_EQ(weight_in(plan, "blinkLeft", "eyeBlinkLeft"), 1);
  EXPECT_EQ(weight_in(plan, "blinkLeft", "eyeBlinkRight"), 0);
  EXPECT_EQ(weight_in(plan, "lookLeft", "eyeLookOutLeft"), 1);
  EXPECT_EQ(weight_in(plan, "lookLeft", "eyeLookInRight"), 1);
  EXPECT_NEAR(weight_in(plan, "aa", "jawOpen"), 0.6, 1e-12);
  EXPECT_NEAR(weight_in(plan, "happy", "mouthSmileRight"), 0.8, 1e-12);
  EXPECT_EQ(expression_of(plan, "happy").mouth, VrmOverride::blend);
  EXPECT_EQ(expression_of(plan, "happy").blink, VrmOverride::blend);
  EXPECT_EQ(expression_of(plan, "aa").mouth, VrmOverride::none);
  EXPECT_FALSE(expression_of(plan, "jawOpen").is_preset);
  ASSERT_TRUE(plan.avatar.look_at.has_value());
  EXPECT_FALSE(plan.avatar.look_at->by_bones);
}

TEST(PlanVrm, AShapeOfItsOwnComesFirst) {
  const VrmPlan plan =
      plan_vrm(face_of({"happy", "mouthSmileLeft", "viseme_aa", "jawOpen", "browDown_L"}), meta());
  EXPECT_EQ(weight_in(plan, "happy", "happy"), 1);
  EXPECT_EQ(weight_in(plan, "happy", "mouthSmileLeft"), 0);
  EXPECT_EQ(weight_in(plan, "aa", "viseme_aa"), 1);
  EXPECT_EQ(weight_in(plan, "aa", "jawOpen"), 0);
  EXPECT_THAT(plan.missing_presets, Contains("blink"));
}

TEST(PlanVrm, SavedExpressionsAreCustomOnes) {
  Character c = face_of({"jawOpen", "mouthSmileLeft"});
  c.expressions = {{"grin", {{0, 0.25}, {1, 0.5}}}, {"sad", {{1, 1}}}};
  const VrmPlan plan = plan_vrm(c, meta());
  EXPECT_EQ(weight_in(plan, "grin", "jawOpen"), 0.25);
  EXPECT_EQ(weight_in(plan, "sad", "mouthSmileLeft"), 1);
  EXPECT_TRUE(expression_of(plan, "sad").is_preset);
}

TEST(PlanVrm, AHeadAloneGetsABodyAndStaysWhereItIs) {
  Character c = face_of({"jawOpen"});
  add_joints(c, {{"base", -1}, {"head", 0}, {"jaw", 1}, {"eye_L", 1}, {"eye_R", 1}});
  const auto before = model_matrices(c);
  const VrmPlan plan = plan_vrm(c, meta());
  const auto after = model_matrices(plan.character);
  for (std::size_t n = 0; n < before.size(); ++n) {
    EXPECT_EQ(before[n], after[n]);
    EXPECT_EQ(c.nodes[n].name, plan.character.nodes[n].name);
  }
  for (const char* bone :
       {"hips", "spine", "leftUpperArm", "leftLowerArm", "leftHand", "rightUpperLeg", "rightFoot"})
    EXPECT_THAT(plan.made_bones, Contains(bone));
  EXPECT_THAT(plan.made_bones, Not(Contains("head")));
  EXPECT_EQ(bone_of(plan, "head"), 1);
  EXPECT_EQ(bone_of(plan, "jaw"), 2);
  EXPECT_GT(after[bone_of(plan, "leftHand")](0, 3), after[bone_of(plan, "rightHand")](0, 3));
  ASSERT_TRUE(plan.avatar.look_at.has_value());
  EXPECT_TRUE(plan.avatar.look_at->by_bones);
}

TEST(PlanVrm, ARigifyBodyIsTakenAsItIs) {
  Character c = face_of({"jawOpen"});
  std::vector<std::pair<std::string, int>> joints = {{"spine", -1}, {"spine.001", 0}, {"spine.006", 1}};
  for (const std::string side : {"L", "R"}) {
    const int first = static_cast<int>(joints.size());
    joints.insert(joints.end(), {{"upper_arm." + side, 1},
                                 {"forearm." + side, first},
                                 {"hand." + side, first + 1},
                                 {"thigh." + side, 0},
                                 {"shin." + side, first + 3},
                                 {"foot." + side, first + 4}});
  }
  add_joints(c, joints);
  const VrmPlan plan = plan_vrm(c, meta());
  EXPECT_THAT(plan.made_bones, IsEmpty());
  EXPECT_EQ(bone_of(plan, "hips"), 0);
  EXPECT_EQ(bone_of(plan, "rightFoot"), 14);
}

TEST(PlanVrm, NoJointsAtAll) {
  const VrmPlan plan = plan_vrm(face_of({"jawOpen"}), meta());
  EXPECT_THAT(plan.made_bones, Contains("head"));
  EXPECT_EQ(plan.avatar.bones.size(), 15u);
}

}  // namespace
}  // namespace mien
