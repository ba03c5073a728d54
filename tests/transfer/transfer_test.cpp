// What transfer refuses, and what it does with half a rig, a coarse target and options. Whole heads are in heads_test.cpp.
#include "mien/transfer/transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
#include <set>

#include "mien/character/validate.h"
#include "mien/geometry/surface_query.h"
#include "transfer/faces.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Character without_shapes(Character character) {
  character.shapes.clear();
  character.clips.clear();
  return character;
}

std::string failure(const Character& source, const Character& target, const TransferOptions& options = {}) {
  return invalid_input_of([&] { transfer(source, target, options); });
}

TEST(transfer, needs_a_mesh_on_either_side) {
  EXPECT_EQ(failure({}, made("cartoon")), "source: has no mesh; a rigged face");
  EXPECT_EQ(failure(made("human"), {}), "target: has no mesh; a face");
}

TEST(transfer, needs_a_rig) {
  EXPECT_EQ(failure(made("cartoon"), made("cartoon")),
            "source: has neither shapes nor joints: there is no rig to transfer; a character with shapes, "
            "joints or "
            "both (`mien assemble` makes one of OBJ files)");
}

TEST(transfer, exaggeration_is_checked_before_any_work) {
  TransferOptions options;
  options.shape_exaggeration["jawOpn"] = 1.2;
  EXPECT_EQ(failure(made("human"), made("cartoon"), options),
            "exaggeration of jawOpn: the source has no such shape; a name that `mien inspect` lists");
  options.shape_exaggeration = {{"jawOpen", std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_EQ(failure(made("human"), made("cartoon"), options),
            "exaggeration of jawOpen: is not a number; a percentage");
  options.shape_exaggeration.clear();
  options.exaggeration = std::numeric_limits<double>::infinity();
  EXPECT_EQ(failure(made("human"), made("cartoon"), options), "exaggeration: is not a number; a percentage");
}

TEST(transfer, landmarks_that_cannot_carry_a_warp_are_named) {
  Character target = made("cartoon");
  target.curves.clear();
  target.landmarks.resize(3);
  EXPECT_THAT(failure(made("human"), target), HasSubstr("landmarks: 3 of the source's 68 have a partner"));
  target = made("cartoon");
  target.landmarks[5].at = target.landmarks[9].at;
  EXPECT_EQ(failure(made("human"), target),
            "target landmarks: " + target.landmarks[5].name + " and " + target.landmarks[9].name +
                " are at the same place; two different places, or one of them left out");
}

TEST(transfer, needs_faces_under_the_landmarks) {
  Character target = made("cartoon");
  target.parts.resize(1);
  target.parts[0].mesh.faces = {};
  target.parts[0].mesh.groups.clear();
  target.parts[0].mesh.uvs.clear();
  EXPECT_EQ(failure(made("human"), target),
            "target: has no faces under its landmarks; landmarks on the face's skin");
}

TEST(transfer, a_position_that_is_no_number_is_refused) {
  Character target = made("cartoon");
  target.parts[0].mesh.positions(100, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(failure(made("human"), target), "");
  Character source = made("human");
  source.parts[0].mesh.positions(100, 1) = std::numeric_limits<float>::infinity();
  EXPECT_NE(failure(source, made("cartoon")), "");
}

TEST(transfer, progress_can_cancel) {
  TransferOptions options;
  std::vector<std::string> steps;
  options.progress = [&](std::string_view step, double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    steps.emplace_back(step);
    return step != "dense correspondence";
  };
  try {
    transfer(made("human"), made("cartoon"), options);
    FAIL() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::cancelled);
  }
  EXPECT_EQ(steps.front(), "landmarks");
  EXPECT_EQ(steps.back(), "dense correspondence");
}

TEST(transfer, shapes_alone_make_no_joints) {
  const Character result = transfer(without_joints(made("human")), made("cartoon")).character;
  EXPECT_THAT(validate(result), IsEmpty());
  EXPECT_THAT(result.shapes, SizeIs(52));
  EXPECT_THAT(result.skins, IsEmpty());
  EXPECT_EQ(result.nodes.size(), made("cartoon").nodes.size());
  const Character& whole = transferred("human", "cartoon").character;
  double worst = 0;
  for (std::size_t s = 0; s < 52; ++s) worst = std::max(worst, difference(result, s, whole, s));
  EXPECT_LT(worst, 0.15);  // joints have a say in which places are trusted
}

TEST(transfer, joints_alone_make_no_shapes) {
  const Character result = transfer(without_shapes(made("human")), made("cartoon")).character;
  EXPECT_THAT(validate(result), IsEmpty());
  EXPECT_THAT(result.shapes, IsEmpty());
  EXPECT_EQ(joint_names(result), joint_names(made("human")));
  for (const Part& part : result.parts) EXPECT_FALSE(part.skin_weights.empty()) << part.name;
}

TEST(transfer, a_part_that_hangs_below_a_joint_gives_its_motion_as_skin_weights) {
  Character source = without_shapes(made("human"));
  const int jaw = find_node(source, "jaw"), teeth = find_part(source, "teethLower");
  ASSERT_GE(jaw, 0);
  ASSERT_GE(teeth, 0);
  // The same place as before, now held by the jaw alone.
  Node holder;
  holder.name = "teeth_holder";
  holder.parent = jaw;
  holder.has_matrix = true;
  holder.matrix = model_matrices(source)[jaw].inverse();
  source.parts[teeth].node = static_cast<int>(source.nodes.size());
  source.parts[teeth].skin = -1;
  source.parts[teeth].skin_weights = {};
  source.nodes.push_back(holder);
  const Character result = transfer(source, made("cartoon")).character;
  EXPECT_THAT(validate(result), IsEmpty());
  EXPECT_EQ(find_node(result, "teeth_holder"), -1);
  const SkinWeights& weights = result.parts[find_part(result, "teethLower")].skin_weights;
  ASSERT_FALSE(weights.empty());
  for (const int joint : weights.joints) EXPECT_EQ(result.nodes[result.skins[0].joints[joint]].name, "jaw");
}

TEST(transfer, exaggeration_multiplies_displacements) {
  // Lids stop at the eyeballs, so shapes of the mouth are asked.
  TransferOptions options;
  options.exaggeration = 2;
  options.shape_exaggeration["mouthSmileLeft"] = 0.25;
  options.shape_exaggeration["mouthPucker"] = 0;
  const Character result = transfer(made("human"), made("cartoon"), options).character;
  const Character& plain = transferred("human", "cartoon").character;
  EXPECT_THAT(validate(result), IsEmpty());
  for (const auto& [name, factor] : std::map<std::string, double>{
           {"mouthSmileRight", 2}, {"mouthFrownLeft", 2}, {"mouthSmileLeft", 0.5}}) {
    const auto shape = static_cast<std::size_t>(find_shape(plain, name));
    double off = 0, size = 0;
    for (std::size_t p = 0; p < plain.parts.size(); ++p) {
      const PointsD expected = factor * delta_of(plain, shape, static_cast<int>(p));
      off += (delta_of(result, shape, static_cast<int>(p)) - expected).squaredNorm();
      size += expected.squaredNorm();
    }
    EXPECT_LT(std::sqrt(off / size), 1e-3) << name;
  }
  const auto pucker = static_cast<std::size_t>(find_shape(plain, "mouthPucker"));
  for (std::size_t p = 0; p < plain.parts.size(); ++p)
    EXPECT_EQ(delta_of(result, pucker, static_cast<int>(p)).norm(), 0);
}

TEST(transfer, max_influences_is_kept) {
  TransferOptions options;
  options.max_influences = 2;
  const Character result = transfer(without_shapes(made("human")), made("cartoon"), options).character;
  EXPECT_THAT(validate(result), IsEmpty());
  int most = 0;
  for (const Part& part : result.parts)
    for (std::size_t v = 0; v + 1 < part.skin_weights.offsets.size(); ++v)
      most = std::max(most, part.skin_weights.offsets[v + 1] - part.skin_weights.offsets[v]);
  EXPECT_EQ(most, 2);
}

TEST(transfer, the_targets_own_uvs_stay_unless_told_otherwise) {
  const Character& target = made("cartoon");
  const Character kept = transfer(without_shapes(made("human")), target).character;
  TransferOptions options;
  options.replace_uvs = true;
  const Character replaced = transfer(without_shapes(made("human")), target, options).character;
  EXPECT_EQ(kept.parts[0].mesh.uvs, target.parts[0].mesh.uvs);
  EXPECT_NE(replaced.parts[0].mesh.uvs, target.parts[0].mesh.uvs);
  EXPECT_THAT(validate(replaced), IsEmpty());
}

TEST(transfer, a_rig_that_the_target_had_is_replaced) {
  Character source = without_joints(made("human"));
  source.shapes.resize(3);
  source.sliders.clear();
  const Character result = transfer(source, made("human")).character;
  EXPECT_THAT(validate(result), IsEmpty());
  EXPECT_THAT(result.shapes, SizeIs(3));
  EXPECT_THAT(result.skins, IsEmpty());
  EXPECT_THAT(result.clips, IsEmpty());
}

/// The skin of a head with its vertices gathered in cells; landmarks on what is left.
Character coarse(const Character& head, double cell) {
  const Mesh& fine = head.parts[0].mesh;
  std::map<std::array<long, 3>, int> cells;
  std::vector<int> cell_of;
  std::vector<Eigen::Vector3f> sums;
  std::vector<int> counts;
  for (Eigen::Index v = 0; v < fine.positions.rows(); ++v) {
    std::array<long, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = std::lround(fine.positions(v, k) / cell);
    const auto [place, fresh] = cells.emplace(key, static_cast<int>(sums.size()));
    if (fresh) {
      sums.push_back(Eigen::Vector3f::Zero());
      counts.push_back(0);
    }
    cell_of.push_back(place->second);
    sums[place->second] += fine.positions.row(v).transpose();
    ++counts[place->second];
  }
  Character result;
  result.parts.emplace_back();
  Mesh& mesh = result.parts[0].mesh;
  result.parts[0].name = "Coarse";
  mesh.positions.resize(static_cast<Eigen::Index>(sums.size()), 3);
  for (std::size_t c = 0; c < sums.size(); ++c)
    mesh.positions.row(static_cast<Eigen::Index>(c)) = sums[c].transpose() / static_cast<float>(counts[c]);
  const Triangles triangles = triangulate(fine.faces);
  std::set<std::array<int, 3>> known;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const int a = cell_of[triangles(t, 0)], b = cell_of[triangles(t, 1)], c = cell_of[triangles(t, 2)];
    std::array<int, 3> key{a, b, c};
    std::sort(key.begin(), key.end());
    if (a != b && b != c && c != a && known.insert(key).second) mesh.faces.push_back({a, b, c});
  }
  const SurfaceQuery surface(mesh.positions, triangulate(mesh.faces));
  for (const Landmark& landmark : head.landmarks) {
    const auto hit = surface.closest(position_of(fine, fine.positions, landmark.at));
    SurfacePoint at;
    at.face = hit.triangle;
    at.barycentric = hit.barycentric;
    result.landmarks.push_back({landmark.name, at});
  }
  return result;
}

TEST(transfer, a_head_of_300_vertices_works) {
  const Character& fine = made("cartoon");
  const double size = bounding_box(fine.parts[0].mesh.positions).diagonal();
  const Character target = coarse(fine, size / 14);
  EXPECT_GT(target.parts[0].mesh.vertex_count(), 200u);
  EXPECT_LT(target.parts[0].mesh.vertex_count(), 400u);
  const TransferResult result = transfer(made("human"), target);
  EXPECT_THAT(validate(result.character), IsEmpty());
  EXPECT_THAT(result.character.shapes, SizeIs(52));
  const auto jaw = static_cast<std::size_t>(find_shape(result.character, "jawOpen"));
  EXPECT_GT(delta_of(result.character, jaw, 0).rowwise().norm().maxCoeff(), 0.02 * result.report.unit);
  std::cerr << target.parts[0].mesh.vertex_count() << " vertices; jaw "
            << delta_of(result.character, jaw, 0).rowwise().norm().maxCoeff() / result.report.unit << "\n";
}

}  // namespace
}  // namespace mien::test
