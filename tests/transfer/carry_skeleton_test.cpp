#include "mien/transfer/carry_skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transfer/small_rig.h"

namespace mien::test {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

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
}  // namespace
}  // namespace mien::test
