#include "mien/report/detail/measure_joints.h"

#include <algorithm>
#include <map>

#include "mien/report/detail/at.h"
#include "mien/report/detail/face_box.h"
#include "mien/report/detail/poses.h"

namespace mien::detail {
namespace {

/// Joints beyond the face would otherwise lead the list on a whole body; in landmarks' boxes.
constexpr double around_face = 0.4;

/// Per joint node its share of the skin weight inside the box around the face.
std::map<int, double> shares(const Character& character, const std::vector<Points>& rest, const Box& box) {
  std::map<int, double> sums;
  double total = 0;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Part& part = character.parts[p];
    if (part.skin < 0 || part.skin_weights.empty()) continue;
    const Skin& skin = character.skins[at(part.skin)];
    for (Eigen::Index v = 0; v < rest[p].rows(); ++v) {
      const Eigen::Array3d x = rest[p].row(v).transpose().cast<double>().array();
      if ((x < box.low.array()).any() || (x > box.high.array()).any()) continue;
      const SkinWeights& weights = part.skin_weights;
      for (int i = weights.offsets[static_cast<std::size_t>(v)];
           i < weights.offsets[static_cast<std::size_t>(v) + 1]; ++i) {
        sums[skin.joints[at(weights.joints[at(i)])]] += weights.weights[at(i)];
        total += weights.weights[at(i)];
      }
    }
  }
  if (total > 0)
    for (auto& [node, sum] : sums) sum /= total;
  return sums;
}

}  // namespace

std::vector<JointRow> measure_joints(const ReportInput& input, std::size_t most) {
  const Character &source = input.source, &target = input.result.character;
  if (source.skins.empty() || target.skins.empty()) return {};
  const LandmarkPairs& pairs = input.result.report.pairs;
  const auto source_shares =
      shares(source, at_rest(source), grown_box(pairs.source_positions(), around_face));
  const auto target_shares =
      shares(target, at_rest(target), grown_box(pairs.target_positions(), around_face));
  std::map<std::string, int> by_name;
  for (const Skin& skin : source.skins)
    for (const int node : skin.joints) by_name.emplace(source.nodes[at(node)].name, node);
  std::vector<JointRow> rows;
  for (const auto& [node, share] : target_shares) {
    const auto found = by_name.find(target.nodes[at(node)].name);
    if (found == by_name.end()) continue;
    const auto source_share = source_shares.find(found->second);
    rows.push_back({found->first, found->second, node,
                    source_share == source_shares.end() ? 0 : source_share->second, share});
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const JointRow& a, const JointRow& b) { return a.target_share > b.target_share; });
  rows.resize(std::min(rows.size(), most));
  return rows;
}

std::vector<Eigen::VectorXf> weight_map(const Character& character, int node) {
  std::vector<Eigen::VectorXf> map;
  for (const Part& part : character.parts) {
    map.emplace_back();
    if (part.skin < 0 || part.skin_weights.empty()) continue;
    const Skin& skin = character.skins[at(part.skin)];
    Eigen::VectorXf& values = map.back();
    values = Eigen::VectorXf::Zero(part.mesh.positions.rows());
    const SkinWeights& weights = part.skin_weights;
    for (Eigen::Index v = 0; v < values.size(); ++v)
      for (int i = weights.offsets[static_cast<std::size_t>(v)];
           i < weights.offsets[static_cast<std::size_t>(v) + 1]; ++i)
        if (skin.joints[at(weights.joints[at(i)])] == node) values[v] += weights.weights[at(i)];
  }
  return map;
}

}  // namespace mien::detail
