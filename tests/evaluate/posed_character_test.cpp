#include "mien/evaluate/posed_character.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/rigs.h"
#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

/// A grid over a hill, with normals, tangents and UVs, on one joint; "rise" makes the hill twice as high.
Character hill() {
  constexpr int side = 12;
  Character character;
  Part part;
  part.name = "hill";
  Mesh& mesh = part.mesh;
  mesh.positions.resize(side * side, 3);
  mesh.uvs.emplace_back();
  mesh.uvs[0].coordinates.resize(side * side, 2);
  PartDelta rise{0, {}, Points(side * side, 3), {}, {}};
  for (int v = 0; v < side * side; ++v) {
    const float x = static_cast<float>(v % side) / side, y = static_cast<float>(v / side) / side;
    mesh.positions.row(v) << x, y, 0.3f * std::sin(3 * x) * std::cos(2 * y);
    mesh.uvs[0].coordinates.row(v) << x, y;
    rise.vertices.push_back(v);
    rise.deltas.row(v) << 0, 0, mesh.positions(v, 2);
  }
  for (int r = 0; r + 1 < side; ++r)
    for (int c = 0; c + 1 < side; ++c) {
      const int a = r * side + c;
      mesh.faces.push_back({a, a + 1, a + side + 1, a + side});
    }
  mesh.normals = vertex_normals(mesh.positions, triangulate(mesh.faces));
  mesh.tangents.resize(side * side, 4);
  for (int v = 0; v < side * side; ++v) {
    Eigen::RowVector3f tangent = -mesh.normals(v, 0) * mesh.normals.row(v);
    tangent.x() += 1;
    mesh.tangents.row(v).head<3>() = tangent.normalized();
    mesh.tangents(v, 3) = 1;
  }
  character.nodes.resize(1);
  character.nodes[0].name = "joint";
  character.skins.push_back({"skin", {0}, {Eigen::Matrix4d::Identity()}, true, -1, {}});
  part.skin = 0;
  part.skin_weights.offsets = {0};
  for (int v = 0; v < side * side; ++v) {
    part.skin_weights.offsets.push_back(v + 1);
    part.skin_weights.joints.push_back(0);
    part.skin_weights.weights.push_back(1);
  }
  character.parts.push_back(part);
  character.shapes.push_back({"rise", {rise}});
  complete_sliders(character);
  return character;
}

float farthest(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) {
  EXPECT_EQ(a.rows(), b.rows());
  return (a - b).rowwise().norm().maxCoeff();
}

TEST(PosedCharacter, InvalidInputs) {
  const Character character = hill();
  Pose pose = rest_pose(character);
  EXPECT_THROW(posed_normals(character, pose, 3, SurfaceFrames::recomputed), Error);
  pose.locals.clear();
  EXPECT_THROW(posed_character(character, pose), Error);
}

TEST(PosedCharacter, AtRestFramesAreTheFilesOwn) {
  const Character character = hill();
  for (const SurfaceFrames frames : {SurfaceFrames::transformed, SurfaceFrames::recomputed}) {
    const Character still = posed_character(character, rest_pose(character), frames);
    EXPECT_TRUE(validate(still).empty());
    EXPECT_EQ(still.parts[0].mesh.positions, character.parts[0].mesh.positions);
    EXPECT_LT(farthest(still.parts[0].mesh.normals, character.parts[0].mesh.normals), 1e-6);
    const bool is_exact = frames == SurfaceFrames::transformed;  // along the faces, not along the surface
    EXPECT_LT(farthest(still.parts[0].mesh.tangents, character.parts[0].mesh.tangents),
              is_exact ? 1e-6 : 0.2);
  }
}

TEST(PosedCharacter, ScaledTurnedAndMirroredJointsCarryNormals) {
  Character character = hill();
  for (const SkinningMethod method : {SkinningMethod::linear_blend, SkinningMethod::dual_quaternion}) {
    character.skins[0].method = method;
    Pose pose = rest_pose(character);
    for (const Eigen::Vector3d& scale : {Eigen::Vector3d(1, 2, 0.5), Eigen::Vector3d(-1, 1, 1)}) {
      pose.locals[0] = {{1, 2, 3}, Eigen::Quaterniond(0.8, 0.1, -0.5, 0.3).normalized(), scale};
      const Points transformed = posed_normals(character, pose, 0, SurfaceFrames::transformed);
      const Points recomputed = posed_normals(character, pose, 0, SurfaceFrames::recomputed);
      EXPECT_LT(farthest(transformed, recomputed), 0.1);  // area weights change with an uneven scale
      const Character still = posed_character(character, pose, SurfaceFrames::transformed);
      for (Eigen::Index v = 0; v < transformed.rows(); ++v) {
        EXPECT_NEAR(transformed.row(v).norm(), 1, 1e-5);
        EXPECT_NEAR(still.parts[0].mesh.tangents.row(v).head<3>().dot(transformed.row(v)), 0, 1e-5);
      }
    }
  }
}

TEST(PosedCharacter, RecomputedNormalsFollowTheShape) {
  const Character character = hill();
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 1;
  const auto posed = evaluate(character, pose);
  EXPECT_LT(farthest(posed_normals(character, pose, 0, SurfaceFrames::recomputed),
                     vertex_normals(posed[0], triangulate(character.parts[0].mesh.faces))),
            1e-6);
}

TEST(PosedCharacter, ShapesNormalDeltasAreAdded) {
  Character character = hill();
  PartDelta& rise = character.shapes[0].parts[0];
  rise.normal_deltas = Points::Zero(rise.deltas.rows(), 3);
  rise.normal_deltas.col(0).setConstant(0.5f);
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = 0.5;
  Points expected = character.parts[0].mesh.normals;
  expected.col(0).array() += 0.25f;
  expected.rowwise().normalize();
  EXPECT_LT(farthest(posed_normals(character, pose, 0, SurfaceFrames::transformed), expected), 1e-6);
}

TEST(PosedCharacter, DroppedFramesAreGone) {
  const Character character = hill();
  const Character still = posed_character(character, rest_pose(character), SurfaceFrames::dropped);
  EXPECT_EQ(still.parts[0].mesh.normals.rows(), 0);
  EXPECT_EQ(still.parts[0].mesh.tangents.rows(), 0);
  EXPECT_TRUE(still.nodes.empty() && still.shapes.empty() && still.sliders.empty());
}

}  // namespace
}  // namespace mien
