#include "mien/transfer/merge_rigs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/character/validate.h"
#include "transfer/small_rig.h"

namespace mien::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Shape shape_of(const std::string& name, std::vector<int> vertices, float move) {
  Shape shape;
  shape.name = name;
  PartDelta delta;
  delta.vertices = std::move(vertices);
  delta.deltas = Points::Constant(static_cast<Eigen::Index>(delta.vertices.size()), 3, move);
  shape.parts = {delta};
  return shape;
}

Slider slider_of(const std::string& name, int shape) {
  Slider slider;
  slider.name = name;
  slider.stops = {{1, shape}};
  return slider;
}

/// Five vertices in a row on two joints; a smile and a frown with a slider each; a clip of the smile.
Character base() {
  Character character = row_of_vertices(5);
  character.nodes = {node("head", -1, {0, 0, 0}), node("jaw", 0, {2, 0, 0})};
  Skin skin;
  skin.joints = {0, 1};
  for (const Eigen::Matrix4d& matrix : model_matrices(character))
    skin.inverse_bind.push_back(matrix.inverse());
  character.skins = {skin};
  character.parts[0].skin = 0;
  character.parts[0].skin_weights = {{0, 1, 2, 4, 5, 6}, {0, 0, 0, 1, 1, 1}, {1, 1, 0.5f, 0.5f, 1, 1}};
  character.shapes = {shape_of("smile", {1, 2}, 1), shape_of("frown", {3}, -1)};
  character.sliders = {slider_of("smile", 0), slider_of("frown", 1)};
  Clip clip;
  clip.name = "talk";
  clip.channels = {channel(Channel::Property::slider, -1, {0, 1}, {0, 1})};
  clip.channels[0].slider = 0;
  character.clips = {clip};
  character.expressions = {{"happy", {{0, 0.8}}}};
  return character;
}

MergedRig merge(const Character& before, const Character& after, const Character& edited) {
  const MergedRig merged = merge_rigs(before, after, edited, {});
  EXPECT_THAT(validate(merged.character), IsEmpty());
  return merged;
}

Eigen::RowVector3f move_of(const Character& character, const std::string& shape, int vertex) {
  const int s = find_shape(character, shape);
  if (s < 0) return Eigen::RowVector3f::Constant(-99);
  for (const PartDelta& part : character.shapes[s].parts)
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      if (part.vertices[i] == vertex) return part.deltas.row(static_cast<Eigen::Index>(i));
  return Eigen::RowVector3f::Zero();
}

TEST(merge_rigs, other_parts_are_refused) {
  Character other = base();
  other.parts[0].mesh.positions = Points::Zero(4, 3);
  EXPECT_EQ(invalid_input_of([&] { merge_rigs(base(), other, base(), {}); }),
            "target: has other parts than the rig that was transferred to it; the target that the source was "
            "transferred to, with its parts and vertices");
}

TEST(merge_rigs, nothing_done_is_nothing_changed) {
  const MergedRig merged = merge(base(), base(), base());
  EXPECT_THAT(merged.report.kept, IsEmpty());
  EXPECT_THAT(merged.report.updated, IsEmpty());
  EXPECT_THAT(merged.report.conflicts, IsEmpty());
  EXPECT_EQ(merged.character.parts[0].skin_weights, base().parts[0].skin_weights);
  EXPECT_EQ(merged.character.sliders, base().sliders);
  EXPECT_THAT(merged.character.clips, SizeIs(1));
}

TEST(merge_rigs, what_only_the_target_changed_stays) {
  Character edited = base();
  edited.shapes[0].parts[0].deltas(0, 1) = 3;
  edited.shapes.push_back(shape_of("wink", {0}, 2));
  edited.sliders.push_back(slider_of("wink", 2));
  edited.sliders[1].maximum = 1.5;
  edited.nodes[1].rest.translation.x() = 2.5;
  edited.skins[0].inverse_bind[1] = model_matrices(edited)[1].inverse();
  edited.parts[0].skin_weights.weights[2] = 0.25f;
  edited.parts[0].skin_weights.weights[3] = 0.75f;
  const MergedRig merged = merge(base(), base(), edited);
  EXPECT_THAT(merged.report.conflicts, IsEmpty());
  EXPECT_THAT(merged.report.kept, ElementsAre("node jaw", "shape smile", "shape wink", "slider frown",
                                              "slider wink", "skin weights of row: 1 vertices"));
  EXPECT_EQ(move_of(merged.character, "smile", 1).y(), 3);
  EXPECT_EQ(move_of(merged.character, "wink", 0).x(), 2);
  EXPECT_EQ(merged.character.sliders, edited.sliders);
  EXPECT_EQ(merged.character.parts[0].skin_weights, edited.parts[0].skin_weights);
  EXPECT_EQ(merged.character.nodes[1].rest.translation.x(), 2.5);
  EXPECT_TRUE(merged.character.skins[0].inverse_bind[1].isApprox(edited.skins[0].inverse_bind[1]));
}

TEST(merge_rigs, what_only_the_source_changed_comes) {
  Character after = base();
  after.shapes.insert(after.shapes.begin(), shape_of("blink", {4}, 0.5f));  // everything moves up a number
  after.shapes[1].parts[0].deltas(0, 0) = 7;
  after.sliders = {slider_of("blink", 0), slider_of("smile", 1), slider_of("frown", 2)};
  after.expressions[0].values = {{1, 0.8}};
  after.clips[0].channels[0].slider = 1;
  after.nodes[1].rest.translation.x() = 3;
  after.skins[0].inverse_bind[1] = model_matrices(after)[1].inverse();
  const MergedRig merged = merge(base(), after, base());
  EXPECT_THAT(merged.report.kept, IsEmpty());
  EXPECT_THAT(merged.report.conflicts, IsEmpty());
  ASSERT_THAT(merged.character.shapes, SizeIs(3));
  EXPECT_EQ(merged.character.shapes[0].name, "blink");
  EXPECT_EQ(merged.character.sliders, after.sliders);
  EXPECT_EQ(merged.character.expressions, after.expressions);
  EXPECT_EQ(merged.character.clips[0].channels[0].slider, 1);
  EXPECT_EQ(move_of(merged.character, "smile", 1).x(), 7);
  EXPECT_EQ(merged.character.nodes[1].rest.translation.x(), 3);
  EXPECT_EQ(merged.character.skins[0].inverse_bind[1], after.skins[0].inverse_bind[1]);
}

TEST(merge_rigs, changes_on_both_sides_add_up_and_are_named) {
  Character after = base(), edited = base();
  after.shapes[0].parts[0].deltas.array() *= 2;
  edited.shapes[0].parts[0].deltas(1, 2) += 0.5f;
  after.nodes[1].rest.translation += Eigen::Vector3d(0, 1, 0);
  edited.nodes[1].rest.translation += Eigen::Vector3d(0, 0, 1);
  for (Character* c : {&after, &edited}) c->skins[0].inverse_bind[1] = model_matrices(*c)[1].inverse();
  after.parts[0].skin_weights.weights[2] = 0.7f;
  after.parts[0].skin_weights.weights[3] = 0.3f;
  edited.parts[0].skin_weights.weights[2] = 0.4f;
  edited.parts[0].skin_weights.weights[3] = 0.6f;
  after.sliders[0].maximum = 2;
  edited.sliders[0].minimum = -1;
  after.clips[0].channels[0].values[1] = 0.5f;
  edited.clips[0].channels[0].values[1] = 0.9f;
  const MergedRig merged = merge(base(), after, edited);
  EXPECT_THAT(merged.report.conflicts, SizeIs(5));
  EXPECT_THAT(merged.report.conflicts, Contains(HasSubstr("shape smile: changed on both sides")));
  EXPECT_EQ(move_of(merged.character, "smile", 1).z(), 2);
  EXPECT_EQ(move_of(merged.character, "smile", 2).z(), 2.5f);
  EXPECT_EQ(merged.character.nodes[1].rest.translation, Eigen::Vector3d(2, 1, 1));
  EXPECT_TRUE(
      (merged.character.skins[0].inverse_bind[1] * model_matrices(merged.character)[1]).isIdentity(1e-9));
  EXPECT_NEAR(merged.character.parts[0].skin_weights.weights[2], 0.6, 1e-6);
  EXPECT_EQ(merged.character.sliders[0].maximum, 2);
  EXPECT_EQ(merged.character.sliders[0].minimum, -1);
  EXPECT_EQ(merged.character.clips[0].channels[0].values[1], 0.9f);
}

TEST(merge_rigs, what_one_side_removed_is_gone_unless_the_other_changed_it) {
  const auto without_frown = [](Character character) {
    character.shapes.pop_back();
    character.sliders.pop_back();
    return character;
  };
  for (const bool source : {true, false}) {
    const MergedRig merged =
        source ? merge(base(), without_frown(base()), base()) : merge(base(), base(), without_frown(base()));
    EXPECT_THAT(merged.report.removed, ElementsAre("shape frown", "slider frown"));
    EXPECT_THAT(merged.character.shapes, SizeIs(1));
    EXPECT_THAT(merged.report.conflicts, IsEmpty());
  }
  Character changed = base();
  changed.shapes[1].parts[0].deltas(0, 0) = 5;
  const MergedRig kept = merge(base(), without_frown(base()), changed);
  EXPECT_EQ(move_of(kept.character, "frown", 3).x(), 5);
  EXPECT_THAT(kept.report.conflicts,
              Contains(HasSubstr("shape frown: changed on the target, gone from the source")));
  const MergedRig left = merge(base(), changed, without_frown(base()));
  EXPECT_EQ(find_shape(left.character, "frown"), -1);
  EXPECT_THAT(left.report.conflicts, Contains(HasSubstr("shape frown: changed in the source, removed")));
}

TEST(merge_rigs, objects_and_controls_are_merged_by_name) {
  Character before = base();
  InfluenceObject cluster;
  cluster.name = "cheek";
  cluster.node = 1;
  cluster.controls = Eigen::RowVector3d(1, 0, 0);
  cluster.bindings = {{0, {1}, {0.5f}, {}, {}, {}}};
  before.objects = {cluster};
  Control smile;
  smile.name = "smile";
  smile.sliders = {0};
  before.controls = {smile};
  Character after = before, edited = before;
  after.objects[0].controls(0, 1) = 1;
  edited.objects[0].controls(0, 2) = 2;
  edited.objects[0].bindings[0].weights[0] = 0.9f;
  edited.controls[0].label = "Smile!";
  const MergedRig merged = merge(before, after, edited);
  EXPECT_EQ(merged.character.objects[0].controls, Eigen::RowVector3d(1, 1, 2));
  EXPECT_EQ(merged.character.objects[0].bindings[0].weights[0], 0.9f);
  EXPECT_EQ(merged.character.controls[0].label, "Smile!");
  EXPECT_THAT(merged.report.kept, ElementsAre("control smile"));
  EXPECT_THAT(merged.report.conflicts, SizeIs(1));
}

}  // namespace
}  // namespace mien::test
