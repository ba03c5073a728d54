#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "full_character.h"
#include "mien/io/constraints_file.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

using test::expect_same;
using test::Folder;
using test::full_character;
using ::testing::HasSubstr;

Constraint made(const char* name, Constraint::Kind kind, int node) {
  Constraint c;
  c.name = name;
  c.kind = kind;
  c.node = node;
  return c;
}

/// One of each kind, every member away from its default somewhere; a panel with each kind of control.
Character constrained_character() {
  using Kind = Constraint::Kind;
  Character c = full_character();
  c.constraints = {made("limit", Kind::limit, 3), made("parent", Kind::parent, 3),
                   made("point", Kind::point, 4), made("orient", Kind::orient, 4),
                   made("scale", Kind::scale, 5), made("aim", Kind::aim, 5)};
  c.constraints[0].translation[1] = {-0.1, std::numeric_limits<double>::infinity()};
  c.constraints[0].rotation[0] = {0, 1. / 3};
  c.constraints[0].scale[2].high = 2;
  c.constraints[0].relative = false;
  for (std::size_t k = 1; k < 6; ++k) c.constraints[k].sources = {{0, 1}, {6, 0.1}};
  c.constraints[2].axes = {true, false, true};
  c.constraints[3].influence = 0.7;
  c.constraints[5].aim_axis = {1, 0, 0};
  c.constraints[5].up_axis = {0, 0, 1};
  c.constraints[5].up = {0.1, 0.2, 0.3};
  c.constraints[5].up_node = 1;
  Control slider, pad, joint;
  slider.name = "smile";
  slider.label = "Smile";
  slider.region = "mouth";
  slider.sliders = {1};
  slider.mirror = 2;
  pad.name = "jaw";
  pad.kind = Control::Kind::pad;
  pad.sliders = {-1, 2, -1, 0};
  pad.position = {1.25, 3};
  pad.size = {3, 3};
  joint.name = "head";
  joint.kind = Control::Kind::joint;
  joint.node = 0;
  joint.moves = true;
  joint.mirror = 0;
  c.controls = {slider, pad, joint};
  return c;
}

void expect_same_constraints(const Character& a, const Character& b) {
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t k = 0; k < a.constraints.size(); ++k) {
    const Constraint &x = a.constraints[k], &y = b.constraints[k];
    SCOPED_TRACE(x.name);
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.kind, y.kind);
    EXPECT_EQ(x.node, y.node);
    EXPECT_EQ(x.sources, y.sources);
    EXPECT_EQ(x.relative, y.relative);
    EXPECT_EQ(x.axes, y.axes);
    EXPECT_EQ(x.influence, y.influence);
    EXPECT_EQ(x.translation, y.translation);
    EXPECT_EQ(x.rotation, y.rotation);
    EXPECT_EQ(x.scale, y.scale);
    EXPECT_EQ(x.aim_axis, y.aim_axis);
    EXPECT_EQ(x.up_axis, y.up_axis);
    EXPECT_EQ(x.up, y.up);
    EXPECT_EQ(x.up_node, y.up_node);
  }
}

TEST(ConstraintRoundTrip, BadMembersAreSaid) {
  const Folder folder;
  save(constrained_character(), folder / "c.gltf");
  const std::vector<std::uint8_t> bytes = read_file(folder / "c.gltf");
  const auto error_with = [&](const char* change_at, const nlohmann::json& value) {
    nlohmann::json file = nlohmann::json::parse(bytes);
    file["extensions"]["MIEN_character"][nlohmann::json::json_pointer(change_at)] = value;
    const auto path = folder.write("bad.gltf", file.dump());
    return test::error_of([&] { load(path); });
  };
  EXPECT_THAT(error_with("/constraints/0/kind", "pole"),
              HasSubstr("constraints[0].kind: is \"pole\"; give limit, parent, point, orient, scale or aim"));
  EXPECT_THAT(error_with("/constraints/0/node", 99), HasSubstr("constraints[0].node: is 99"));
  EXPECT_THAT(error_with("/constraints/1/sources/0/node", -1),
              HasSubstr("constraints[1].sources[0].node: is -1"));
  EXPECT_THAT(error_with("/constraints/0/axes", "xw"), HasSubstr("axes: is \"xw\"; give some of x, y and z"));
  EXPECT_THAT(error_with("/constraints/0/rotation/x", 3),
              HasSubstr("rotation.x: is no range; give [low, high]; null where there is no limit"));
  EXPECT_THAT(error_with("/constraints/0/rotation/x", {2, 1}),
              HasSubstr("constraint limit: rotation x: ranges from 2.000000 to 1.000000"));
  EXPECT_THAT(error_with("/constraints/0/angle", 3), HasSubstr("angle"));
  EXPECT_THAT(error_with("/constraints/1/sources/0/node", 3),
              HasSubstr("constraint parent: joint3 depends on joint3"));
  EXPECT_THAT(error_with("/controls/0/kind", "dial"),
              HasSubstr("kind: is \"dial\"; give slider, pad or joint"));
  EXPECT_THAT(error_with("/controls/0/sliders", {"gone"}), HasSubstr("names no slider"));
  EXPECT_THAT(error_with("/controls/0/mirror", "gone"), HasSubstr("names gone; name one of the controls"));
  EXPECT_THAT(error_with("/controls/0/size", {1, 0}), HasSubstr("control smile: has a place or a size"));
}

TEST(ConstraintRoundTrip, ConstraintsAndControlsComeBack) {
  const Folder folder;
  const Character c = constrained_character();
  for (const char* name : {"c.glb", "c.gltf"}) {
    save(c, folder / name);
    const Character again = load(folder / name);
    expect_same(c, again);
    expect_same_constraints(c, again);
    EXPECT_EQ(c.controls, again.controls);
    const std::vector<std::uint8_t> first = read_file(folder / name);
    save(again, folder / name);
    EXPECT_EQ(first, read_file(folder / name));
  }
}

TEST(ConstraintRoundTrip, ANodeThatOthersFollowStaysWhereItIs) {
  // The node of a skinned part is written as a bare root unless something hangs on it.
  const Folder folder;
  Character c = full_character();
  c.nodes[6].rest.translation = {1, 2, 3};
  c.constraints = {made("follow", Constraint::Kind::point, 7)};
  c.constraints[0].sources = {{6, 1}};
  save(c, folder / "c.glb");
  EXPECT_EQ(load(folder / "c.glb").nodes[6].rest.translation, Eigen::Vector3d(1, 2, 3));
}

TEST(ConstraintsFile, BadOnesAreSaid) {
  const Folder folder;
  const Character c = full_character();
  const auto error_in = [&](const std::string& text) {
    const auto path = folder.write("c.json", text);
    return test::error_of([&] { read_constraint_set(path, c); });
  };
  EXPECT_THAT(error_in("{"), HasSubstr("c.json: JSON"));
  EXPECT_THAT(error_in("{}"), HasSubstr("has no \"constraints\""));
  EXPECT_THAT(error_in(R"({"constraint": []})"), HasSubstr("constraint"));
  EXPECT_THAT(error_in(R"({"constraints": [{"name": "a", "kind": "limit", "node": "jaw"}]})"),
              HasSubstr("constraints[0].node: names jaw; name a node of the character or of \"nodes\""));
  EXPECT_THAT(error_in(R"({"constraints": [{"kind": "limit", "node": "joint1"}]})"), HasSubstr("name"));
  EXPECT_THAT(error_in(R"({"nodes": [{"name": "joint1", "at": [0, 0, 0]}], "constraints": []})"),
              HasSubstr("nodes[0].name: is joint1, which is there already; give a new name"));
  EXPECT_THAT(error_in(R"({"nodes": [{"name": "goal"}], "constraints": []})"), HasSubstr("has no \"at\""));
  EXPECT_THAT(error_in(R"({"nodes": [{"name": "goal", "at": [0, 0, "far"]}], "constraints": []})"),
              HasSubstr("give a number"));
}

TEST(ConstraintsFile, NamesBecomeNodes) {
  const Folder folder;
  const Character c = full_character();
  const auto path = folder.write("c.json", R"({
    "nodes": [{"name": "goal", "at": [1, 2, 3], "parent": "joint2"}, {"name": "up", "at": [0, 9, 0]}],
    "constraints": [{"name": "look", "kind": "aim", "node": "joint5", "sources": [{"node": "goal", "share": 2}], "upNode": "up",
                     "aimAxis": [0, 1, 0], "upAxis": [1, 0, 0], "influence": 0.5},
                    {"name": "jaw", "kind": "limit", "node": "joint4", "rotation": {"x": [0, 0.5], "y": [null, 0]}}]})");
  const ConstraintSet set = read_constraint_set(path, c);
  ASSERT_EQ(set.nodes.size(), 2u);
  ASSERT_EQ(set.constraints.size(), 2u);
  Character with = c;
  with.nodes.insert(with.nodes.end(), set.nodes.begin(), set.nodes.end());
  EXPECT_LT((model_matrices(with)[8].topRightCorner<3, 1>() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_EQ(set.nodes[0].parent, 2);
  EXPECT_EQ(set.constraints[0].node, 5);
  EXPECT_EQ(set.constraints[0].sources, (std::vector<ConstraintSource>{{8, 2}}));
  EXPECT_EQ(set.constraints[0].up_node, 9);
  EXPECT_EQ(set.constraints[1].rotation[0], (ValueRange{0, 0.5}));
  EXPECT_EQ(set.constraints[1].rotation[1].high, 0);
  EXPECT_TRUE(std::isinf(set.constraints[1].rotation[1].low));
}

}  // namespace
}  // namespace mien
