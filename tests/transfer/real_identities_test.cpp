// A character on heads of its own base mesh, whose own joints and skin weights are known.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "mien/geometry/surface_query.h"
#include "transfer/load_marked.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

const std::filesystem::path data = MIEN_SHARED_DATA;

/// Mean distance from the joints' own places, of the diagonal of the head's box.
double joint_error(const Character& rigged, const std::string& identity) {
  std::ifstream file(data / "makehuman/truth" / (identity + ".joints.json"));
  const auto truth = nlohmann::json::parse(file);
  const auto model = model_matrices(rigged);
  double sum = 0;
  int count = 0;
  for (const auto& bone : truth["bones"]) {
    const int node = find_node(rigged, bone["name"].get<std::string>());
    if (node < 0) continue;
    const auto head = bone["head"].get<std::array<double, 3>>();
    sum += (model[static_cast<std::size_t>(node)].topRightCorner<3, 1>() -
            Eigen::Vector3d(head[0], head[1], head[2]))
               .norm();
    ++count;
  }
  EXPECT_GT(count, 60);
  return sum / count / bounding_box(rigged.parts[0].mesh.positions).diagonal();
}

/// Per vertex its weights by the joints' names.
std::vector<std::map<std::string, double>> weights_of(const Character& character) {
  std::vector<std::map<std::string, double>> rows;
  for (const Part& part : character.parts) {
    const auto& joints = character.skins[static_cast<std::size_t>(part.skin)].joints;
    const SkinWeights& all = part.skin_weights;
    for (std::size_t v = 0; v < part.mesh.vertex_count(); ++v) {
      rows.emplace_back();
      for (auto e = static_cast<std::size_t>(all.offsets[v]);
           e < static_cast<std::size_t>(all.offsets[v + 1]); ++e)
        rows.back()[character.nodes[static_cast<std::size_t>(joints[static_cast<std::size_t>(all.joints[e])])]
                        .name] += all.weights[e];
    }
  }
  return rows;
}

/// Mean L1 difference of the target's weights from those of the source's vertex of the same number in `base`, the source's
/// neutral in the targets' vertex order.
double weight_error(const Character& source, const Character& base, const Character& rigged) {
  std::vector<Eigen::RowVector3f> places;
  for (const Part& part : source.parts)
    for (Eigen::Index v = 0; v < part.mesh.positions.rows(); ++v)
      places.push_back(part.mesh.positions.row(v));
  const auto own = weights_of(source), got = weights_of(rigged);
  double sum = 0;
  for (std::size_t v = 0; v < got.size(); ++v) {
    const Eigen::RowVector3f place = base.parts[0].mesh.positions.row(static_cast<Eigen::Index>(v));
    std::size_t nearest = 0;
    for (std::size_t s = 1; s < places.size(); ++s)
      if ((places[s] - place).squaredNorm() < (places[nearest] - place).squaredNorm()) nearest = s;
    std::map<std::string, double> off = got[v];
    for (const auto& [joint, weight] : own[nearest]) off[joint] -= weight;
    for (const auto& [joint, difference] : off) sum += std::abs(difference);
  }
  return sum / static_cast<double>(got.size());
}

struct Expected {
  std::string identity;
  double joints, joints_by_surfaces, weights_by_surfaces;
};

class identities : public ::testing::TestWithParam<Expected> {};

TEST_P(identities, get_joints_and_weights) {
  if (!std::filesystem::exists(data / "makehuman")) GTEST_SKIP() << "no shared data";
  const Expected& expected = GetParam();
  const Character source =
      load_marked(data / "makehuman/caucasian_male_young.glb", data / "landmarks/makehuman.glb.json");
  const Character base = load(data / "makehuman/caucasian_male_young.obj");
  const Character target =
      load_marked(data / "makehuman" / (expected.identity + ".obj"), data / "landmarks/makehuman.json");
  const TransferResult shared = transfer(source, target);
  EXPECT_EQ(shared.report.correspondence, Correspondence::shared_uvs);
  EXPECT_LT(joint_error(shared.character, expected.identity), expected.joints);
  EXPECT_LT(weight_error(source, base, shared.character), 1e-3);
  TransferOptions options;
  options.correspondence = Correspondence::surfaces;
  const TransferResult registered = transfer(source, target, options);
  EXPECT_LT(joint_error(registered.character, expected.identity), expected.joints_by_surfaces);
  EXPECT_LT(weight_error(source, base, registered.character), expected.weights_by_surfaces);
}

INSTANTIATE_TEST_SUITE_P(makehuman, identities,
                         ::testing::Values(Expected{"african_male_young", .0025, .0037, .030},
                                           Expected{"asian_female_young", .0040, .0066, .054},
                                           Expected{"x_elf", .0045, .0071, .064}),
                         [](const auto& info) { return info.param.identity; });

}  // namespace
}  // namespace mien::test
