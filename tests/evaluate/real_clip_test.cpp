// The MakeHuman character's clip of 60 poses, 63 joints and up to 9 influences, against a plain loop.
#include <gtest/gtest.h>

#include <filesystem>

#include "mien/evaluate/evaluate.h"
#include "mien/io/load.h"

namespace mien {
namespace {

Eigen::Matrix4d model_of(const Character& character, const Pose& pose, int node) {
  const Eigen::Matrix4d local = pose.locals[node].matrix();
  const int parent = character.nodes[node].parent;
  return parent < 0 ? local : Eigen::Matrix4d(model_of(character, pose, parent) * local);
}

Eigen::Vector3d shaped_vertex(const Character& character, const Pose& pose, int part, int vertex) {
  Eigen::Vector3d position = character.parts[part].mesh.positions.row(vertex).cast<double>();
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    for (const PartDelta& delta : character.shapes[s].parts)
      for (std::size_t i = 0; delta.part == part && i < delta.vertices.size(); ++i)
        if (delta.vertices[i] == vertex)
          position += pose.shape_weights.values[static_cast<Eigen::Index>(s)] *
                      delta.deltas.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
  return position;
}

Eigen::Vector3d plain_vertex(const Character& character, const Pose& pose, int part, int vertex) {
  const Part& p = character.parts[part];
  const Eigen::Vector3d shaped = shaped_vertex(character, pose, part, vertex);
  const Skin& skin = character.skins[p.skin];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  for (int i = p.skin_weights.offsets[vertex]; i < p.skin_weights.offsets[vertex + 1]; ++i) {
    const int joint = p.skin_weights.joints[i];
    const Eigen::Matrix4d matrix = model_of(character, pose, skin.joints[joint]) * skin.inverse_bind[joint];
    sum += p.skin_weights.weights[i] * (matrix * shaped.homogeneous()).head<3>();
    total += p.skin_weights.weights[i];
  }
  return sum / total;
}

TEST(RealClip, MakeHumanPosesAgreeWithAPlainLoop) {
  const std::filesystem::path file =
      std::filesystem::path(MIEN_SHARED_DATA) / "makehuman/caucasian_male_young.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared data";
  const Character character = load(file);
  ASSERT_EQ(character.clips.size(), 1u);
  const double size = bounding_box(character.parts[0].mesh.positions).diagonal();
  double moved = 0;
  for (const double seconds : {0.0, 0.5, 7.25, 30.5, 59.9}) {
    Pose pose = sample_clip(character, character.clips[0], seconds);
    pose.shape_weights.values[3] = 0.7;
    const auto posed = evaluate(character, pose);
    for (std::size_t p = 0; p < posed.size(); ++p) {
      ASSERT_TRUE(posed[p].allFinite());
      ASSERT_GE(character.parts[p].skin, 0);
      for (Eigen::Index v = 0; v < posed[p].rows(); v += 37) {
        const Eigen::Vector3d plain = plain_vertex(character, pose, static_cast<int>(p), static_cast<int>(v));
        ASSERT_LT((posed[p].row(v).transpose().cast<double>() - plain).norm(),
                  1e-6 * size);  // float rounding
        moved = std::max(
            moved, (plain - character.parts[p].mesh.positions.row(v).transpose().cast<double>()).norm());
      }
    }
  }
  EXPECT_GT(moved, 0.01 * size);
}

TEST(RealClip, MakeHumanBindPoseGivesTheMesh) {
  const std::filesystem::path file =
      std::filesystem::path(MIEN_SHARED_DATA) / "makehuman/caucasian_male_young.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared data";
  const Character character = load(file);
  const auto posed = evaluate(character, rest_pose(character));
  for (std::size_t p = 0; p < posed.size(); ++p)
    EXPECT_LT((posed[p] - character.parts[p].mesh.positions).rowwise().norm().maxCoeff(), 2e-5);
}

}  // namespace
}  // namespace mien
