#include "mien/character/validate.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace mien {
namespace {

const float nan_value = std::numeric_limits<float>::quiet_NaN();

/// Two skinned triangles, a shape, a clip, a landmark: all right.
Character sound_character() {
  Character c;
  c.nodes.resize(2);
  c.nodes[0].name = "root";
  c.nodes[1].name = "jaw";
  c.nodes[1].parent = 0;
  Skin skin;
  skin.name = "rig";
  skin.joints = {0, 1};
  skin.inverse_bind.assign(2, Eigen::Matrix4d::Identity());
  c.skins.push_back(skin);
  Part part;
  part.name = "Skin";
  part.mesh.positions.resize(4, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  part.mesh.faces.push_back({0, 1, 2});
  part.mesh.faces.push_back({0, 2, 3});
  part.mesh.uvs.push_back({Points2::Zero(6, 2), {0, 1, 2, 3, 4, -1}});
  part.mesh.groups = {{"a", -1, 0, 1, 0, 4}, {"b", -1, 1, 2, 0, 4}};
  part.skin = 0;
  part.skin_weights = {{0, 1, 2, 3, 5}, {0, 0, 1, 0, 1}, {1, 1, 1, 0.5f, 0.5f}};
  c.parts.push_back(part);
  Shape shape;
  shape.name = "jawOpen";
  shape.parts.resize(1);
  shape.parts[0].vertices = {1, 3};
  shape.parts[0].deltas = Points::Ones(2, 3);
  c.shapes.push_back(shape);
  Clip clip;
  clip.name = "talk";
  clip.channels.resize(1);
  clip.channels[0].property = Channel::Property::rotation;
  clip.channels[0].node = 1;
  clip.channels[0].times = {0, 1};
  clip.channels[0].values = {0, 0, 0, 1, 1, 0, 0, 0};
  c.clips.push_back(clip);
  c.landmarks.push_back({"nose", {}});
  c.landmarks[0].at.vertex = 2;
  return c;
}

TEST(validate, a_sound_character_and_an_empty_one_have_no_problems) {
  EXPECT_TRUE(validate(sound_character()).empty());
  EXPECT_TRUE(validate(Character{}).empty());
}

struct DamagedCase {
  std::function<void(Character&)> damage;
  const char* error;
};

const DamagedCase cases[] = {
    {[](Character& c) { c.nodes[1].parent = 5; }, "node jaw: names parent 5; there are 2"},
    {[](Character& c) { c.nodes[0].parent = 1; }, "node jaw: is its own ancestor; nodes must form trees"},
    {[](Character& c) { c.nodes[0].rest.scale[1] = nan_value; },
     "node root: has a transform that is not finite; give finite numbers"},
    {[](Character& c) { c.nodes[0].rest.rotation.w() = 2; },
     "node root: has a rotation that is not unit; normalise it"},
    {[](Character& c) {
       c.skins[0].joints = {0, 7};
     },
     "skin rig: names node 7; there are 2"},
    {[](Character& c) {
       c.skins[0].joints = {1, 1};
     },
     "skin rig: lists node 1 twice; list each joint once"},
    {[](Character& c) { c.skins[0].inverse_bind.pop_back(); },
     "skin rig: has 1 inverse bind matrices; there are 2 joints"},
    {[](Character& c) { c.parts[0].mesh.positions(2, 0) = nan_value; },
     "part Skin: vertex 2: is not finite; give finite numbers"},
    {[](Character& c) { c.parts[0].mesh.normals = Points::Ones(3, 3); },
     "part Skin: has 3 normals; there are 4 vertices"},
    {[](Character& c) { c.parts[0].mesh.faces.corners()[4] = 9; },
     "part Skin: face 1: names vertex 9; there are 4"},
    {[](Character& c) { c.parts[0].mesh.uvs[0].corners[3] = 6; },
     "part Skin: UV set 0: names coordinate 6; there are 6"},
    {[](Character& c) { c.parts[0].mesh.uvs[0].corners.pop_back(); },
     "part Skin: UV set 0: has 5 corners; the faces have 6"},
    {[](Character& c) { c.parts[0].mesh.groups.pop_back(); },
     "part Skin: has groups up to face 1; they must cover 2 faces"},
    {[](Character& c) { c.parts[0].mesh.groups[1].face_begin = 0; },
     "part Skin: group 1: has faces 0 to 2; groups follow one another from face 1"},
    {[](Character& c) { c.parts[0].mesh.groups[0].material = 0; },
     "part Skin: group 0: names material 0; there are 0"},
    {[](Character& c) { c.parts[0].node = 2; }, "part Skin: names node 2; there are 2"},
    {[](Character& c) { c.parts[0].skin_weights.offsets.pop_back(); },
     "part Skin: has skin weights whose counts do not fit together; give each vertex its influences"},
    {[](Character& c) { c.parts[0].skin_weights.joints[2] = 2; },
     "part Skin: vertex 2: names joint 2; there are 2"},
    {[](Character& c) { c.parts[0].skin_weights.weights[0] = 0.5f; },
     "part Skin: vertex 0: has skin weights that sum to 0.500000; they sum to 1"},
    {[](Character& c) { c.parts[0].skin_weights.weights[3] = nan_value; },
     "part Skin: vertex 3: has a skin weight that is negative or not finite; give weights in [0, 1]"},
    {[](Character& c) { c.shapes.push_back(c.shapes[0]); },
     "shape jawOpen: has the name of another shape; give each its own name"},
    {[](Character& c) { c.shapes[0].parts[0].part = 1; }, "shape jawOpen: names part 1; there are 1"},
    {[](Character& c) {
       c.shapes[0].parts[0].vertices = {3, 1};
     },
     "shape jawOpen: has vertices that do not ascend; sort them and name each once"},
    {[](Character& c) {
       c.shapes[0].parts[0].vertices = {1, 4};
     },
     "shape jawOpen: names vertex 4; there are 4"},
    {[](Character& c) { c.shapes[0].parts[0].deltas = Points::Ones(3, 3); },
     "shape jawOpen: has arrays of unequal length; give one row a vertex"},
    {[](Character& c) { c.shapes[0].parts[0].deltas(1, 1) = nan_value; },
     "shape jawOpen: displacement 1: is not finite; give finite numbers"},
    {[](Character& c) { c.shapes[0].parts.push_back(c.shapes[0].parts[0]); },
     "shape jawOpen: lists its parts out of order; list each part once, ascending"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, 0, {}}, {"jaw", 0, 1, 0, {}}};
     },
     "slider jaw: has the name of another slider; give each its own name"},
    {[](Character& c) {
       c.sliders = {{"jaw", 1, 1, 0, {}}};
     },
     "slider jaw: has no range; give a minimum below a maximum"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, nan_value, {}}};
     },
     "slider jaw: has a rest value that is not finite; give a finite number"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, 0, {{1, 0}, {0.5, 0}}}};
     },
     "slider jaw: has a stop at 0.500000; stops ascend and none is at 0"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, 0, {{1, 9}}}};
     },
     "slider jaw: names shape 9; there are 1"},
    {[](Character& c) {
       c.correctives = {{0, CorrectiveRule::product, {}}};
     },
     "corrective 0: has no inputs; name the sliders that fire it"},
    {[](Character& c) {
       c.correctives = {{0, CorrectiveRule::product, {{3, 1}}}};
     },
     "corrective 0: names slider 3; there are 0"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, 0, {}}};
       c.correctives = {{0, CorrectiveRule::product, {{0, 1}, {0, 1}}}};
     },
     "corrective 0: lists slider 0 twice; list each slider once"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, 0, {}}};
       c.correctives = {{0, CorrectiveRule::product, {{0, 0}}}};
     },
     "corrective 0: has an input that is full at 0.000000; give a value other than 0"},
    {[](Character& c) {
       c.expressions = {{"grin", {{0, 1}}}};
     },
     "expression grin: names slider 0; there are 0"},
    {[](Character& c) {
       c.sliders = {{"jaw", 0, 1, 0, {}}, {"lip", 0, 1, 0, {}}};
       c.expressions = {{"grin", {{1, 1}, {0, 1}}}};
     },
     "expression grin: lists its sliders out of order; list each once, ascending"},
    {[](Character& c) { c.clips[0].channels[0].property = Channel::Property::slider; },
     "clip talk: channel 0: names slider -1; there are 0"},
    {[](Character& c) {
       c.clips[0].channels[0].times = {1, 1};
     },
     "clip talk: channel 0: key 1: is not later than the one before it; times must ascend from 0"},
    {[](Character& c) { c.clips[0].channels[0].values.pop_back(); },
     "clip talk: channel 0: has 7 values; 8 are needed"},
    {[](Character& c) { c.clips[0].channels[0].values[3] = 2; },
     "clip talk: channel 0: key 0: has a rotation that is not unit; normalise it"},
    {[](Character& c) { c.clips[0].channels[0].node = 2; },
     "clip talk: channel 0: names node 2; there are 2"},
    {[](Character& c) { c.landmarks[0].at.vertex = 4; }, "landmark nose: names vertex 4; there are 4"},
    {[](Character& c) { c.landmarks.push_back(c.landmarks[0]); },
     "landmark nose: has the name of another landmark; give each its own name"},
    {[](Character& c) {
       c.curves.push_back({"brow", {c.landmarks[0].at}, 3});
     },
     "curve brow: has fewer than two points; give two or more"},
};

TEST(validate, each_problem_is_named_with_its_place) {
  for (const DamagedCase& bad : cases) {
    SCOPED_TRACE(bad.error);
    Character c = sound_character();
    bad.damage(c);
    try {
      require_valid(c);
      ADD_FAILURE() << "should have thrown";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), bad.error);
    }
  }
}

TEST(validate, lists_every_problem) {
  Character c = sound_character();
  c.nodes[0].rest.scale[0] = nan_value;
  c.shapes[0].parts[0].vertices = {1, 4};
  c.landmarks[0].at.vertex = 4;
  EXPECT_EQ(validate(c).size(), 3u);
}

}  // namespace
}  // namespace mien
