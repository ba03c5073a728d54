#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "mien/character/validate.h"

namespace mien {
namespace {

using Kind = Constraint::Kind;

/// root, head on it, eye and chin on head; goal alone. The eye aims at goal, the chin is limited.
Character aiming() {
  Character c;
  c.nodes.resize(5);
  const char* names[] = {"root", "head", "eye", "chin", "goal"};
  const int parents[] = {-1, 0, 1, 1, -1};
  for (int n = 0; n < 5; ++n) {
    c.nodes[n].name = names[n];
    c.nodes[n].parent = parents[n];
  }
  Constraint aim;
  aim.name = "look";
  aim.kind = Kind::aim;
  aim.node = 2;
  aim.sources = {{4, 1}};
  Constraint limit;
  limit.name = "jaw range";
  limit.node = 3;
  limit.rotation[0] = {0, 0.5};
  c.constraints = {aim, limit};
  return c;
}

struct ConstraintCase {
  const char* expected;
  std::function<void(Character&)> spoil;
};

TEST(ConstraintProblems, SoundOnesHaveNone) {
  EXPECT_TRUE(validate(aiming()).empty());
}

TEST(ConstraintProblems, EachIsNamed) {
  const double infinite = std::numeric_limits<double>::infinity();
  const ConstraintCase cases[] = {
      {"constraint 0: has no name; give it one of its own", [](Character& c) { c.constraints[0].name = ""; }},
      {"constraint look: has the name of another constraint; give each its own name",
       [](Character& c) { c.constraints[1].name = "look"; }},
      {"constraint look: names node 5; there are 5", [](Character& c) { c.constraints[0].node = 5; }},
      {"constraint look: names node -2; there are 5",
       [](Character& c) { c.constraints[0].sources[0].node = -2; }},
      {"constraint look: names node 7; there are 5", [](Character& c) { c.constraints[0].up_node = 7; }},
      {"constraint look: has no sources; name one or more nodes to follow",
       [](Character& c) { c.constraints[0].sources.clear(); }},
      {"constraint jaw range: is a limit with sources; leave the sources out",
       [](Character& c) {
         c.constraints[1].sources = {{4, 1}};
       }},
      {"constraint look: gives goal a share that is negative or not finite; give 0 or more",
       [](Character& c) { c.constraints[0].sources[0].share = -1; }},
      {"constraint look: has shares that sum to no number above 0; give one of them more",
       [](Character& c) { c.constraints[0].sources[0].share = 0; }},
      {"constraint look: has an influence of 1.500000; give a number in [0, 1]",
       [](Character& c) { c.constraints[0].influence = 1.5; }},
      {"constraint jaw range: rotation x: ranges from 1.000000 to 0.500000; give a low that is not above its "
       "high",
       [](Character& c) { c.constraints[1].rotation[0].low = 1; }},
      {"constraint jaw range: scale z: ranges from inf to inf; give a low that is not above its high",
       [=](Character& c) { c.constraints[1].scale[2].low = infinite; }},
      {"constraint look: has an aim axis that is not unit; normalise it",
       [](Character& c) { c.constraints[0].aim_axis *= 2; }},
      {"constraint look: has an up axis that is not unit; normalise it",
       [](Character& c) { c.constraints[0].up_axis.setZero(); }},
      {"constraint look: has an up axis along its aim axis; give one across it",
       [](Character& c) { c.constraints[0].up_axis = -c.constraints[0].aim_axis; }},
      {"constraint look: has no up direction; give a finite direction or an up node",
       [](Character& c) { c.constraints[0].up.setZero(); }},
  };
  for (const ConstraintCase& test : cases) {
    Character character = aiming();
    test.spoil(character);
    const std::vector<Problem> problems = validate(character);
    ASSERT_FALSE(problems.empty()) << test.expected;
    EXPECT_STREQ(problems[0].error().what(), test.expected);
  }
}

std::string circle_in(const Character& character) {
  const std::vector<Problem> problems = constraint_problems(character);
  return problems.empty() ? "none" : problems[0].error().what();
}

TEST(ConstraintProblems, CirclesAreRefusedByName) {
  const std::string remedy = "; a node may not follow itself, also not through others' sources and parents";
  Character own = aiming();
  own.constraints[0].sources[0].node = 2;
  EXPECT_EQ(circle_in(own), "constraint look: eye depends on eye" + remedy);

  Character child = aiming();
  child.nodes[4].parent = 2;
  EXPECT_EQ(circle_in(child), "constraint look: eye depends on goal, that on eye" + remedy);

  Character up = aiming();
  up.nodes[4].parent = 2;
  up.constraints[0].sources[0].node = 0;
  up.constraints[0].up_node = 4;
  EXPECT_EQ(circle_in(up), "constraint look: eye depends on goal, that on eye" + remedy);

  Character two = aiming();
  Constraint back;
  back.name = "back";
  back.kind = Kind::point;
  back.node = 4;
  back.sources = {{2, 1}};
  two.constraints.push_back(back);
  EXPECT_EQ(circle_in(two), "constraint look: eye depends on goal, that on eye" + remedy);
  two.constraints.back().sources = {{3, 1}};
  EXPECT_EQ(circle_in(two), "none");
  two.constraints[0].node = 1;  // the head follows goal, goal the chin, which is the head's child
  EXPECT_EQ(circle_in(two), "constraint look: head depends on goal, that on chin, that on head" + remedy);
}

TEST(ConstraintProblems, OwnParentIsNoCircle) {
  Character character = aiming();
  character.constraints[0].sources = {{1, 1}, {0, 2}};
  EXPECT_EQ(circle_in(character), "none");
}

}  // namespace
}  // namespace mien
