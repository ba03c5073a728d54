#include "mien/transfer/carry_constraints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/character/validate.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/evaluate.h"
#include "transfer/faces.h"

namespace mien::test {
namespace {

using Eigen::Vector3d;
using Kind = Constraint::Kind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Node node(const std::string& name, int parent, const Vector3d& translation, double angle) {
  Node n;
  n.name = name;
  n.parent = parent;
  n.rest.translation = translation;
  n.rest.rotation = Eigen::AngleAxisd(angle, Vector3d(1, 1, 0).normalized());
  return n;
}

enum { head, jaw, eye, goal, face };

Constraint made(const char* name, Kind kind, int node, std::vector<ConstraintSource> sources) {
  Constraint c;
  c.name = name;
  c.kind = kind;
  c.node = node;
  c.sources = std::move(sources);
  return c;
}

/// A head with a limited jaw, an eye that looks at a goal and goes along with the jaw, and the node of the face.
Character rig() {
  Character c;
  c.nodes = {node("head", -1, {0, 1, 0}, 0.4), node("jaw", head, {0, -0.5, 1}, -1),
             node("eye", head, {0.3, 0.2, 1}, 0.3), node("goal", -1, {0.5, 1, 6}, 0),
             node("Face", -1, {0, 0, 0}, 0)};
  Skin skin;
  skin.joints = {head, jaw, eye};
  const auto model = model_matrices(c);
  for (const int joint : skin.joints) skin.inverse_bind.push_back(model[joint].inverse());
  c.skins = {skin};
  Part part;
  part.node = face;
  part.skin = 0;
  c.parts = {part};
  c.constraints = {made("jaw turns", Kind::limit, jaw, {}), made("jaw slides", Kind::limit, jaw, {}),
                   made("along", Kind::point, eye, {{jaw, 1}}), made("look", Kind::aim, eye, {{goal, 1}})};
  c.constraints[0].rotation[0] = {-0.2, 0.5};
  c.constraints[0].rotation[1] = c.constraints[0].rotation[2] = {0, 0};
  c.constraints[1].translation = {ValueRange{-0.1, 0.1}, ValueRange{-0.05, 0}, ValueRange{}};
  c.constraints[2].influence = 0.5;
  c.constraints[3].relative = false;
  return c;
}

/// The clip's one key turns and shifts the jaw out of its limits and moves the goal.
Clip pose_clip() {
  Channel turn;
  turn.property = Channel::Property::rotation;
  turn.node = jaw;
  turn.times = {0};
  turn.values = {0.6f, 0, 0, 0.8f};
  Channel shift = turn, look = turn;
  shift.property = look.property = Channel::Property::translation;
  shift.values = {0.5f, -0.7f, 1.3f};
  look.node = goal;
  look.values = {-2, 1.5f, 5};
  return {"pose", {turn, shift, look}, {}};
}

Character carried(const Character& source, const Similarity& s, std::vector<std::string>& dropped,
                  Clip& clip) {
  const SpaceMap map{[s](const Vector3d& x) { return s(x); }, [s](const Vector3d&) { return s.rotation; },
                     [s](const Vector3d&) { return s.scale; }};
  const CarriedSkeleton skeleton = carry_skeleton(source, map, 0);
  Character target;
  target.nodes = skeleton.nodes;
  target.skins = {skeleton.skin};
  target.sliders = source.sliders;
  clip = carry_clip(source, clip, skeleton, {}, dropped);
  target.constraints = carry_constraints(source, target, skeleton, dropped);
  target.controls = carry_controls(source, target, skeleton, dropped);
  return target;
}

TEST(CarryConstraints, ConstrainingAndCarryingCommute) {
  const Similarity s{
      2.5, Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix(), {3, -1, 2}};
  const Character source = rig();
  std::vector<std::string> dropped;
  Clip clip = pose_clip();
  const auto before = posed_matrices(source, sample_clip(source, clip, 0));
  Clip there = clip;
  const Character target = carried(source, s, dropped, there);
  EXPECT_THAT(dropped, IsEmpty());
  EXPECT_TRUE(constraint_problems(target).empty());
  const auto after = posed_matrices(target, sample_clip(target, there, 0));
  for (const int n : {head, jaw, eye, goal}) {
    const Vector3d expected = s(Vector3d(before[n].topRightCorner<3, 1>()));
    EXPECT_LT((after[n].topRightCorner<3, 1>() - expected).norm(), 2e-6) << n;
    EXPECT_LT((after[n].topLeftCorner<3, 3>() - s.rotation * before[n].topLeftCorner<3, 3>()).norm(), 2e-6)
        << n;
  }
}

TEST(CarryConstraints, AbsoluteRangesMoveWithTheRest) {
  Character source = rig();
  source.constraints.resize(2);
  source.constraints[1].relative = false;
  source.constraints[1].translation[1] = {-0.7, -0.4};
  const Similarity s{2, Eigen::Matrix3d::Identity(), {0, 0, 0}};
  std::vector<std::string> dropped;
  Clip clip = pose_clip();
  const Character target = carried(source, s, dropped, clip);
  EXPECT_NEAR(target.constraints[1].translation[1].low, -1.4, 1e-12);
  EXPECT_NEAR(target.constraints[1].translation[1].high, -0.8, 1e-12);
  EXPECT_TRUE(std::isinf(target.constraints[1].translation[2].high));
  EXPECT_EQ(target.constraints[0].rotation, source.constraints[0].rotation);
}

TEST(CarryConstraints, WhatIsNotCarriedIsSaid) {
  Character source = rig();
  source.constraints[3].sources = {{face, 1}};
  source.sliders = {{"smile", 0, 1, 0, {}}};
  Control slider, lost, kept;
  slider.name = "smile";
  slider.sliders = {0};
  lost.name = "face";
  lost.kind = kept.kind = Control::Kind::joint;
  lost.node = face;
  lost.mirror = 2;
  kept.name = "jaw";
  kept.node = jaw;
  kept.mirror = 1;
  source.controls = {slider, lost, kept};
  std::vector<std::string> dropped;
  Clip clip = pose_clip();
  const Character target = carried(source, {}, dropped, clip);
  EXPECT_THAT(dropped, ElementsAre("constraint look", "control face"));
  EXPECT_EQ(target.constraints.size(), 3u);
  ASSERT_EQ(target.controls.size(), 2u);
  EXPECT_EQ(target.controls[1].mirror, -1);
  EXPECT_TRUE(control_problems(target).empty());
}

}  // namespace
}  // namespace mien::test
