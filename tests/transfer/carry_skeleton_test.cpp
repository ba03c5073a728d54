#include "mien/transfer/carry_skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/evaluate/evaluate.h"
#include "transfer/faces.h"

namespace mien::test {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Node node(const std::string& name, int parent, const Vector3d& translation, double angle = 0) {
  Node n;
  n.name = name;
  n.parent = parent;
  n.rest.translation = translation;
  n.rest.rotation = Eigen::AngleAxisd(angle, Vector3d(1, 1, 0).normalized());
  return n;
}

/// Scene > head > jaw > chin, bound as they rest; a face that holds the skin and a tooth that hangs below the jaw.
Character rig() {
  Character character;
  character.nodes = {node("Scene", -1, {0, 0, 0}),     node("head", 0, {0, 1, 0}, 0.4),
                     node("jaw", 1, {0, -0.5, 1}, -1), node("chin", 2, {0.2, 0, 2}, 0.3),
                     node("Face", 0, {0, 0, 0}),       node("Tooth", 2, {0, 0.1, 1})};
  Skin skin;
  skin.name = "bones";
  skin.joints = {1, 3};
  const auto model = model_matrices(character);
  for (const int joint : skin.joints) skin.inverse_bind.push_back(model[joint].inverse());
  character.skins = {skin, skin};
  character.skins[1].joints = {3, 2};
  character.skins[1].inverse_bind = {model[3].inverse(), model[2].inverse()};
  Part face;
  face.node = 4;
  face.skin = 0;
  Part tooth;
  tooth.node = 5;
  character.parts = {face, tooth};
  return character;
}

SpaceMap of_similarity(const Similarity& s) {
  return {[s](const Vector3d& x) { return s(x); }, [s](const Vector3d&) { return s.rotation; },
          [s](const Vector3d&) { return s.scale; }};
}

/// The target's nodes as transfer makes them: `first` of its own, then the carried ones.
Character with_skeleton(const CarriedSkeleton& skeleton, int first) {
  Character target;
  for (int n = 0; n < first; ++n) target.nodes.push_back(node("own" + std::to_string(n), -1, {9, 9, 9}));
  target.nodes.insert(target.nodes.end(), skeleton.nodes.begin(), skeleton.nodes.end());
  target.skins.push_back(skeleton.skin);
  return target;
}

Channel channel(Channel::Property property, int node, std::vector<float> times, std::vector<float> values) {
  Channel c;
  c.property = property;
  c.node = node;
  c.times = std::move(times);
  c.values = std::move(values);
  return c;
}

TEST(carry_skeleton, a_singular_bind_matrix_is_named) {
  Character character = rig();
  character.skins[0].inverse_bind[1].row(2).setZero();
  EXPECT_EQ(invalid_input_of([&] { carry_skeleton(character, of_similarity({}), 0); }),
            "skin bones, joint chin: its inverse bind matrix is singular; an invertible matrix");
}

TEST(carry_skeleton, cyclic_nodes_are_refused) {
  Character character = rig();
  character.nodes[0].parent = 3;
  EXPECT_THAT(invalid_input_of([&] { carry_skeleton(character, of_similarity({}), 0); }),
              ::testing::HasSubstr("node"));
}

TEST(list_joints, every_joint_once_in_the_skins_order) {
  const JointList list = list_joints(rig());
  EXPECT_THAT(list.nodes, ElementsAre(1, 3, 2));
  EXPECT_THAT(list.skin_joint, ElementsAre(ElementsAre(0, 1), ElementsAre(1, 2)));
  EXPECT_THAT(list.joint_of_node, ElementsAre(-1, 0, 2, 1, -1, -1));
}

TEST(list_joints, a_joint_that_holds_a_part_is_one_of_them) {
  Character character = rig();
  EXPECT_EQ(holding_joint(character, character.parts[0]), -1);  // skinned
  EXPECT_EQ(holding_joint(character, character.parts[1]), 2);
  character.nodes[5].parent = 0;
  EXPECT_EQ(holding_joint(character, character.parts[1]), -1);  // below no joint
  character.nodes[5].parent = 3;
  EXPECT_EQ(holding_joint(character, character.parts[1]), 3);
  character.skins.clear();
  EXPECT_EQ(holding_joint(character, character.parts[1]), -1);
  EXPECT_THAT(list_joints(character).nodes, IsEmpty());
}

TEST(carry_skeleton, keeps_names_and_hierarchy_behind_the_targets_nodes) {
  const CarriedSkeleton skeleton = carry_skeleton(rig(), of_similarity(some_similarity(2)), 3);
  EXPECT_THAT(skeleton.node_of, ElementsAre(3, 4, 5, 6, -1, -1));  // not those that hold parts
  std::vector<std::string> names;
  std::vector<int> parents;
  for (const Node& n : skeleton.nodes) {
    names.push_back(n.name);
    parents.push_back(n.parent);
  }
  EXPECT_THAT(names, ElementsAre("Scene", "head", "jaw", "chin"));
  EXPECT_THAT(parents, ElementsAre(-1, 3, 4, 5));
  EXPECT_THAT(skeleton.skin.joints, ElementsAre(4, 6, 5));
}

TEST(carry_skeleton, joints_come_to_lie_where_the_map_puts_them) {
  const Character source = rig();
  SpaceMap map = of_similarity({});
  map.position = [](const Vector3d& x) {
    return Vector3d(x.x() + x.y() * x.y(), 2 * x.y(), std::sin(x.z()) + 3);
  };
  const CarriedSkeleton skeleton = carry_skeleton(source, map, 2);
  const Character target = with_skeleton(skeleton, 2);
  const auto before = model_matrices(source), after = model_matrices(target);
  for (const int joint : {1, 2, 3}) {
    const Matrix4d& m = after[skeleton.node_of[joint]];
    const Vector3d origin = before[joint].topRightCorner<3, 1>(), got = m.topRightCorner<3, 1>();
    EXPECT_TRUE(got.isApprox(map.position(origin), 1e-9)) << joint;
    EXPECT_TRUE((m.topLeftCorner<3, 3>().isApprox(before[joint].topLeftCorner<3, 3>(), 1e-9))) << joint;
  }
  for (std::size_t j = 0; j < skeleton.skin.joints.size(); ++j)
    EXPECT_TRUE((skeleton.skin.inverse_bind[j] * after[skeleton.skin.joints[j]]).isIdentity(1e-9)) << j;
}

TEST(carry_skeleton, local_rotations_stay_under_a_pure_scale) {
  const Character source = rig();
  const CarriedSkeleton skeleton =
      carry_skeleton(source, of_similarity({60, Eigen::Matrix3d::Identity(), {7, 8, 9}}), 0);
  for (const int n : {1, 2, 3}) {
    const Transform &before = source.nodes[n].rest, &after = skeleton.nodes[skeleton.node_of[n]].rest;
    EXPECT_LT(before.rotation.angularDistance(after.rotation), 1e-7) << n;
    EXPECT_TRUE(after.scale.isApprox(Vector3d::Ones(), 1e-9)) << n;
    EXPECT_FALSE(skeleton.nodes[skeleton.node_of[n]].has_matrix);
    EXPECT_TRUE(after.translation.isApprox(60 * before.translation, 1e-9)) << n;
    EXPECT_NEAR(skeleton.growth[n], 60, 1e-12);
  }
}

/// Scene, head, jaw and chin animated in every way.
Clip clip_of(const Character& source) {
  Clip clip;
  clip.name = "talk";
  const auto rotation = [](double angle, const Vector3d& axis) {
    return Eigen::Quaternionf(Eigen::AngleAxisf(static_cast<float>(angle), axis.cast<float>().normalized()));
  };
  for (int n = 0; n < 4; ++n) {
    const Vector3d rest = source.nodes[n].rest.translation;
    const Eigen::Vector3f a = (rest + Vector3d(0.3, n, -0.2)).cast<float>();
    clip.channels.push_back(
        channel(Channel::Property::translation, n, {0, 1},
                {float(rest.x()), float(rest.y()), float(rest.z()), a.x(), a.y(), a.z()}));
    const auto q = rotation(0.3 + n, {1, 2, -1}), r = rotation(1.4, {0, 1, double(n)});
    clip.channels.push_back(channel(Channel::Property::rotation, n, {0, 1},
                                    {q.x(), q.y(), q.z(), q.w(), r.x(), r.y(), r.z(), r.w()}));
    clip.channels.push_back(channel(Channel::Property::scale, n, {0, 1},
                                    {1, 1, 1, 1.5f + 0.1f * n, 1.5f + 0.1f * n, 1.5f + 0.1f * n}));
  }
  return clip;
}

void expect_plays_alike(const Character& source, const Clip& clip, const Similarity& map) {
  const CarriedSkeleton skeleton = carry_skeleton(source, of_similarity(map), 1);
  Character target = with_skeleton(skeleton, 1);
  std::vector<std::string> dropped;
  const Clip carried = carry_clip(source, clip, skeleton, {}, dropped);
  EXPECT_THAT(dropped, IsEmpty());
  for (const double seconds : {0.0, 0.25, 1.0}) {
    const auto before = model_matrices(source, sample_clip(source, clip, seconds)),
               after = model_matrices(target, sample_clip(target, carried, seconds));
    for (int n = 0; n < 4; ++n) {
      const Matrix4d &a = before[n], &b = after[skeleton.node_of[n]];
      const Vector3d expected = map(Vector3d(a.topRightCorner<3, 1>())), got = b.topRightCorner<3, 1>();
      EXPECT_LT((expected - got).norm(), 1e-5 * map.scale) << n << " at " << seconds;
      EXPECT_LT((map.rotation * a.topLeftCorner<3, 3>() - b.topLeftCorner<3, 3>()).norm(), 1e-5) << n;
    }
  }
}

TEST(carry_clip, plays_alike_after_a_similarity) {
  const Character source = rig();
  expect_plays_alike(source, clip_of(source), {});
  expect_plays_alike(source, clip_of(source), {60, Eigen::Matrix3d::Identity(), {1, 2, 3}});
  expect_plays_alike(source, clip_of(source), some_similarity(0.3));
}

TEST(carry_clip, cubic_tangents_have_no_rest) {
  const Character source = rig();
  const CarriedSkeleton skeleton =
      carry_skeleton(source, of_similarity({2, Eigen::Matrix3d::Identity(), {5, 5, 5}}), 0);
  Clip clip;
  clip.channels = {channel(Channel::Property::translation, 1, {0}, {1, 0, 0, 0, 1.5f, 0, 0, 0, 3})};
  clip.channels[0].interpolation = Interpolation::cubic_spline;
  std::vector<std::string> dropped;
  const Clip carried = carry_clip(source, clip, skeleton, {}, dropped);
  ASSERT_EQ(carried.channels.size(), 1u);
  EXPECT_EQ(carried.channels[0].interpolation, Interpolation::cubic_spline);
  const Eigen::Vector3f rest = skeleton.nodes[1].rest.translation.cast<float>();
  const std::vector<float> expected = {2, 0, 0, rest.x(), rest.y() + 1, rest.z(), 0, 0, 6};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(carried.channels[0].values[i], expected[i], 1e-5) << i;
}

TEST(carry_clip, rotations_of_an_unturned_skeleton_stay_to_the_bit) {
  const Character source = rig();
  const CarriedSkeleton skeleton =
      carry_skeleton(source, of_similarity({60, Eigen::Matrix3d::Identity(), {1, 2, 3}}), 0);
  const Clip clip = clip_of(source);
  std::vector<std::string> dropped;
  const Clip carried = carry_clip(source, clip, skeleton, {}, dropped);
  for (std::size_t c = 0; c < clip.channels.size(); ++c) {
    EXPECT_EQ(carried.channels[c].times, clip.channels[c].times);
    if (clip.channels[c].property == Channel::Property::translation) continue;
    for (std::size_t i = 0; i < clip.channels[c].values.size(); ++i)
      EXPECT_NEAR(carried.channels[c].values[i], clip.channels[c].values[i], 1e-6);
  }
}

TEST(carry_clip, what_the_target_does_not_get_is_named) {
  Character source = rig();
  source.shapes.resize(2);
  source.shapes[0].name = "smile";
  source.shapes[1].name = "frown";
  Clip clip;
  clip.name = "talk";
  clip.channels = {channel(Channel::Property::translation, 5, {0}, {1, 2, 3}), Channel{}, Channel{}};
  for (const int c : {1, 2}) {
    clip.channels[c].property = Channel::Property::shape_weight;
    clip.channels[c].shape = c - 1;
    clip.channels[c].part = 0;
    clip.channels[c].times = {0};
    clip.channels[c].values = {0.5f};
  }
  std::vector<std::string> dropped;
  const Clip carried =
      carry_clip(source, clip, carry_skeleton(source, of_similarity({}), 0), {-1, 7}, dropped);
  EXPECT_THAT(dropped, ElementsAre("clip talk: node Tooth", "clip talk: shape smile"));
  ASSERT_EQ(carried.channels.size(), 1u);
  EXPECT_EQ(carried.channels[0].shape, 7);
  EXPECT_EQ(carried.channels[0].part, -1);
  EXPECT_EQ(carried.channels[0].values, clip.channels[2].values);
}

TEST(carry_skeleton, a_rest_that_differs_from_the_bind_pose_keeps_differing) {
  Character source = rig();
  // Saved with an open jaw: the bind matrices are still those of the closed one.
  source.nodes[2].rest.rotation = source.nodes[2].rest.rotation * Eigen::AngleAxisd(0.5, Vector3d::UnitX());
  source.nodes[2].rest.translation += Vector3d(0, 0, 0.1);
  const Similarity map = some_similarity(4);
  const CarriedSkeleton skeleton = carry_skeleton(source, of_similarity(map), 0);
  const Character target = with_skeleton(skeleton, 0);
  const auto before = model_matrices(source), after = model_matrices(target);
  const JointList list = list_joints(source);
  for (std::size_t j = 0; j < list.nodes.size(); ++j) {
    Matrix4d inverse_bind = Matrix4d::Identity();
    for (std::size_t s = 0; s < source.skins.size(); ++s)
      for (std::size_t k = 0; k < source.skins[s].joints.size(); ++k)
        if (source.skins[s].joints[k] == list.nodes[j]) inverse_bind = source.skins[s].inverse_bind[k];
    // The skin moves from bind to rest as it does on the source, seen through the similarity.
    const Matrix4d moved = before[list.nodes[j]] * inverse_bind;
    const Matrix4d carried = after[skeleton.skin.joints[j]] * skeleton.skin.inverse_bind[j];
    const Vector3d x(0.3, -0.2, 1.5);
    const Vector3d expected = map(Vector3d((moved * x.homogeneous()).head<3>()));
    const Vector3d got = (carried * map(x).homogeneous()).head<3>();
    EXPECT_LT((expected - got).norm(), 1e-6) << source.nodes[list.nodes[j]].name;
  }
}

TEST(rig_differences, one_line_a_difference) {
  Character a = rig(), b = rig();
  EXPECT_THAT(rig_differences(a, b), IsEmpty());
  EXPECT_THAT(rig_differences(Character{}, Character{}), IsEmpty());
  a.shapes.resize(1);
  a.shapes[0].name = "smile";
  b.nodes[3].parent = 1;
  b.nodes[2].name = "mandible";
  EXPECT_THAT(rig_differences(a, b),
              ElementsAre("joint jaw is missing in the second", "joint chin hangs below jaw and below head",
                          "shape smile is missing in the second", "joint mandible is missing in the first"));
}

}  // namespace
}  // namespace mien::test
