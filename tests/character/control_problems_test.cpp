#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "mien/character/validate.h"

namespace mien {
namespace {

/// Four sliders, a node, a control of each kind and a mirrored pair.
Character panel() {
  Character c;
  c.nodes.resize(1);
  c.nodes[0].name = "jaw";
  for (const char* name : {"smileLeft", "smileRight", "up", "down"}) c.sliders.push_back({name, 0, 1, 0, {}});
  Control left, right, pad, joint;
  left.name = "smileLeft";
  left.sliders = {0};
  left.mirror = 1;
  right.name = "smileRight";
  right.sliders = {1};
  right.mirror = 0;
  pad.name = "look";
  pad.kind = Control::Kind::pad;
  pad.sliders = {-1, -1, 2, 3};
  joint.name = "jaw";
  joint.kind = Control::Kind::joint;
  joint.node = 0;
  c.controls = {left, right, pad, joint};
  return c;
}

struct ControlCase {
  const char* expected;
  std::function<void(Character&)> spoil;
};

TEST(ControlProblems, SoundOnesHaveNone) {
  EXPECT_TRUE(validate(panel()).empty());
}

TEST(ControlProblems, EachIsNamed) {
  const ControlCase cases[] = {
      {"control 0: has no name; give it one of its own", [](Character& c) { c.controls[0].name = ""; }},
      {"control smileLeft: has the name of another control; give each its own name",
       [](Character& c) { c.controls[1].name = "smileLeft"; }},
      {"control smileLeft: has 0 sliders; a slider's control has one, a pad four, a joint none",
       [](Character& c) { c.controls[0].sliders.clear(); }},
      {"control look: has 3 sliders; a slider's control has one, a pad four, a joint none",
       [](Character& c) { c.controls[2].sliders.pop_back(); }},
      {"control jaw: has 1 sliders; a slider's control has one, a pad four, a joint none",
       [](Character& c) { c.controls[3].sliders = {0}; }},
      {"control smileLeft: names slider -1; there are 4",
       [](Character& c) { c.controls[0].sliders[0] = -1; }},
      {"control look: names slider 4; there are 4", [](Character& c) { c.controls[2].sliders[0] = 4; }},
      {"control look: has slider up twice; a pad's directions differ",
       [](Character& c) { c.controls[2].sliders[0] = 2; }},
      {"control look: is a pad without sliders; give one to a direction or more",
       [](Character& c) { c.controls[2].sliders.assign(4, -1); }},
      {"control smileLeft: is no joint and names a node; leave the node out",
       [](Character& c) { c.controls[0].node = 0; }},
      {"control jaw: names node 1; there are 1", [](Character& c) { c.controls[3].node = 1; }},
      {"control look: names control 9 as its mirror; another one of the 4",
       [](Character& c) { c.controls[2].mirror = 9; }},
      {"control look: names control 2 as its mirror; another one of the 4",
       [](Character& c) { c.controls[2].mirror = 2; }},
      {"control look: has the mirror smileLeft, whose own is another; mirrors name each other",
       [](Character& c) { c.controls[2].mirror = 0; }},
      {"control look: has a place or a size that is not finite or not above 0; give finite numbers",
       [](Character& c) { c.controls[2].size.x() = 0; }},
  };
  for (const ControlCase& test : cases) {
    Character character = panel();
    test.spoil(character);
    const std::vector<Problem> problems = validate(character);
    ASSERT_FALSE(problems.empty()) << test.expected;
    EXPECT_STREQ(problems[0].error().what(), test.expected);
  }
}

}  // namespace
}  // namespace mien
