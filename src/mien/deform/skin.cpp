#include "mien/deform/skin.h"

#include <string>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/dual_quaternion.h"

namespace mien {

void check_skin_weights(Eigen::Index vertices, const SkinWeights& weights, std::size_t joint_count) {
  const auto wanted = static_cast<std::size_t>(vertices) + 1;
  if (weights.offsets.size() != wanted)
    throw invalid_input("skin weights", "have " + std::to_string(weights.offsets.size()) + " offsets",
                        std::to_string(wanted) + ", one a vertex and the end");
  const auto influences = static_cast<int>(weights.joints.size());
  if (weights.weights.size() != weights.joints.size() || weights.offsets.front() != 0 ||
      weights.offsets.back() != influences)
    throw invalid_input("skin weights", "have offsets that do not cover the influences");
  for (std::size_t v = 1; v < wanted; ++v)
    if (weights.offsets[v] < weights.offsets[v - 1])
      throw invalid_input("skin weights", "have descending offsets at vertex " + std::to_string(v - 1));
  for (int joint : weights.joints)
    if (joint < 0 || static_cast<std::size_t>(joint) >= joint_count)
      throw invalid_input("skin weights", "name joint " + std::to_string(joint),
                          "a joint from 0 to " + std::to_string(static_cast<int>(joint_count) - 1));
}

std::vector<Eigen::Matrix4d> joint_matrices(const Skin& skin, const std::vector<Eigen::Matrix4d>& model) {
  if (skin.inverse_bind.size() != skin.joints.size())
    throw invalid_input("skin " + skin.name,
                        "has " + std::to_string(skin.inverse_bind.size()) + " inverse bind matrices",
                        std::to_string(skin.joints.size()) + ", one a joint");
  std::vector<Eigen::Matrix4d> matrices;
  matrices.reserve(skin.joints.size());
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const int node = skin.joints[j];
    if (node < 0 || static_cast<std::size_t>(node) >= model.size())
      throw invalid_input("skin " + skin.name, "names node " + std::to_string(node),
                          "a node from 0 to " + std::to_string(static_cast<int>(model.size()) - 1));
    matrices.push_back(model[node] * skin.inverse_bind[j]);
  }
  return matrices;
}

PointsD skin_linear(const PointsD& positions, const SkinWeights& weights,
                    const std::vector<Eigen::Matrix4d>& joints) {
  check_skin_weights(positions.rows(), weights, joints.size());
  PointsD moved = positions;
  parallel_for(static_cast<std::size_t>(positions.rows()), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Eigen::Matrix<double, 3, 4> sum = Eigen::Matrix<double, 3, 4>::Zero();
      double total = 0;
      for (int i = weights.offsets[v]; i < weights.offsets[v + 1]; ++i) {
        sum += static_cast<double>(weights.weights[i]) * joints[weights.joints[i]].topRows<3>();
        total += weights.weights[i];
      }
      if (total <= 0) continue;
      const auto row = static_cast<Eigen::Index>(v);
      moved.row(row) = (sum * positions.row(row).transpose().homogeneous() / total).transpose();
    }
  });
  return moved;
}

PointsD skin_points(const PointsD& positions, const SkinWeights& weights, const Skin& skin,
                    const std::vector<Eigen::Matrix4d>& joints) {
  return skin.method == SkinningMethod::dual_quaternion ? skin_dual_quaternion(positions, weights, joints)
                                                        : skin_linear(positions, weights, joints);
}

}  // namespace mien
