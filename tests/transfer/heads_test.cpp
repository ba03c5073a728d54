// Whole transfers between the built-in heads: onto itself, onto other faces, the same whatever the size and the threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "mien/character/validate.h"
#include "mien/core/parallel.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/load.h"
#include "transfer/faces.h"
#include "transfer/transferred.h"

namespace mien::test {
namespace {

using ::testing::IsEmpty;

/// The file's bytes that this character is saved as: all its arrays in one.
std::string bytes_of(const Character& character) {
  const auto path =
      std::filesystem::temp_directory_path() / ("mien_heads_" + std::to_string(::getpid()) + ".glb");
  save(character, path);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  return bytes;
}

std::map<std::string, Eigen::Vector3d> joint_places(const Character& character) {
  const auto model = model_matrices(character);
  std::map<std::string, Eigen::Vector3d> places;
  for (const Skin& skin : character.skins)
    for (const int joint : skin.joints)
      places[character.nodes[joint].name] = model[joint].topRightCorner<3, 1>();
  return places;
}

Eigen::MatrixXd dense_weights(const Part& part, std::size_t joints) {
  Eigen::MatrixXd weights =
      Eigen::MatrixXd::Zero(part.mesh.positions.rows(), static_cast<Eigen::Index>(joints));
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    for (int i = part.skin_weights.offsets[v]; i < part.skin_weights.offsets[v + 1]; ++i)
      weights(v, part.skin_weights.joints[i]) = part.skin_weights.weights[i];
  return weights;
}

/// The human without its eyes: lids are pushed out of eyeballs that some of its own shapes touch.
Character without_eyes(Character character) {
  std::erase_if(character.parts, [](const Part& part) { return part.name.starts_with("eye"); });
  return character;
}

TEST(human_onto_itself, gives_the_rig_back) {
  const Character& human = made("human");
  Character bare = without_eyes(human);
  bare.shapes.clear();
  const TransferResult result = transfer(human, bare);
  for (std::size_t s = 0; s < human.shapes.size(); ++s) {
    ASSERT_EQ(result.character.shapes[s].name, human.shapes[s].name);
    const PointsD wanted = delta_of(human, s, 0);
    EXPECT_LE((delta_of(result.character, s, 0) - wanted).norm(), 0.03 * wanted.norm())
        << human.shapes[s].name;
  }
  const auto before = joint_places(human), after = joint_places(result.character);
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [name, place] : before)
    EXPECT_LT((after.at(name) - place).norm(), 1e-3 * result.report.unit) << name;
  const Eigen::MatrixXd off =
      dense_weights(human.parts[0], 28) - dense_weights(result.character.parts[0], 28);
  EXPECT_LT(off.rowwise().lpNorm<1>().mean(), 1e-3);
}

TEST(human_onto_itself, eyes_teeth_and_tongue_get_their_own_motion_back) {
  const Character& human = made("human");
  const TransferResult& result = transferred("human", "human");
  std::vector<double> off;
  for (std::size_t s = 0; s < human.shapes.size(); ++s) {
    off.push_back(difference(result.character, s, human, s));
    EXPECT_LT(off.back(), 0.3) << human.shapes[s].name;
    for (std::size_t p = 1; p < human.parts.size(); ++p) {
      const std::string& name = human.parts[p].name;
      if (name == "brows" || name == "lashes") continue;  // they follow the skin beneath
      const PointsD wanted = delta_of(human, s, static_cast<int>(p));
      EXPECT_LE((delta_of(result.character, s, static_cast<int>(p)) - wanted).norm(), 1e-4 * wanted.norm())
          << name << " " << human.shapes[s].name;
    }
  }
  std::nth_element(off.begin(), off.begin() + 26, off.end());
  EXPECT_LT(off[26], 1e-3);
}

/// Without the UVs, which would say where everything is.
Character wide_human() {
  const Character& human = made("human");
  Character wide = human;
  wide.shapes.clear();
  for (Part& part : wide.parts) part.mesh.positions *= Eigen::Vector3f(1.12F, 1, 0.95F).asDiagonal();
  Points& tongue = wide.parts[find_part(wide, "tongue")].mesh.positions;
  const Eigen::RowVector3f middle = tongue.colwise().mean();
  const Eigen::Matrix3f pitch(Eigen::AngleAxisf(0.15F, Eigen::Vector3f::UnitX()));
  tongue = ((tongue.rowwise() - middle) * pitch.transpose()).rowwise() + middle;
  for (Part& part : wide.parts) part.mesh.uvs.clear();
  return wide;
}

double weights_off(const Character& rigged, const std::string& name) {
  const Character& human = made("human");
  const int part = find_part(human, name);
  const Eigen::MatrixXd off = dense_weights(rigged.parts[part], 28) - dense_weights(human.parts[part], 28);
  return off.rowwise().lpNorm<1>().mean();
}

TEST(human_onto_a_wide_human, lashes_and_tongue_keep_their_joints) {
  const Character rigged = transfer(made("human"), wide_human()).character;
  for (const std::string name : {"lashes", "tongue"}) EXPECT_LT(weights_off(rigged, name), 0.1) << name;
}

TEST(human_onto_a_wide_human, lashes_that_are_one_piece_go_with_each_of_the_sources) {
  Character wide = wide_human();
  Mesh& lashes = wide.parts[find_part(wide, "lashes")].mesh;
  // From every face a thread to the first.
  const int first = lashes.faces[0][0], second = lashes.faces[0][1];
  for (std::size_t f = 1, count = lashes.faces.size(); f < count; ++f)
    lashes.faces.push_back({first, second, lashes.faces[f][0]});
  lashes.groups.clear();
  EXPECT_LT(weights_off(transfer(made("human"), wide).character, "lashes"), 0.15);
}

/// What holds for every target.
void expect_sound(const Character& source, const Character& target, const TransferResult& result) {
  const Character& character = result.character;
  EXPECT_THAT(validate(character), IsEmpty());
  ASSERT_EQ(character.parts.size(), target.parts.size());
  for (std::size_t p = 0; p < target.parts.size(); ++p) {
    EXPECT_EQ(character.parts[p].name, target.parts[p].name);
    EXPECT_EQ(character.parts[p].mesh.positions, target.parts[p].mesh.positions);
    EXPECT_EQ(character.parts[p].mesh.faces, target.parts[p].mesh.faces);
    const Eigen::VectorXd sums =
        dense_weights(character.parts[p], character.skins[0].joints.size()).rowwise().sum();
    EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-5) << target.parts[p].name;
  }
  ASSERT_EQ(character.shapes.size(), source.shapes.size());
  for (std::size_t s = 0; s < source.shapes.size(); ++s)
    EXPECT_EQ(character.shapes[s].name, source.shapes[s].name);
  EXPECT_EQ(joint_names(character), joint_names(source));
  ASSERT_EQ(character.clips.size(), source.clips.size());
  EXPECT_EQ(character.clips[0].name, source.clips[0].name);
  EXPECT_EQ(character.clips[0].channels.size(), source.clips[0].channels.size());
  for (const double seconds : {0.0, 1.3, 4.0})
    for (const Points& part : evaluate(character, sample_clip(character, character.clips[0], seconds)))
      EXPECT_TRUE(part.allFinite());
  EXPECT_EQ(result.report.flips.size(), source.shapes.size());
  EXPECT_EQ(result.report.guide.size(), source.parts.size());
  EXPECT_EQ(result.report.distance.size(), target.parts.size());
}

/// How far a piece's motion is from rigid (and its size), of its motion.
double bend(const Character& character, int part, std::size_t shape) {
  const PointsD neutral = character.parts[part].mesh.positions.cast<double>();
  const PointsD delta = delta_of(character, shape, part);
  const PointsD moved = neutral + delta;
  const Similarity rigid = fit_similarity(neutral, moved);
  return (rigid(neutral) - moved).norm() / delta.norm();
}

void expect_inner_parts_move_rigidly(const Character& source, const Character& character) {
  for (const std::string name : {"eyeLeft", "eyeRight", "teethUpper", "teethLower"}) {
    const int part = part_named(character, name), donor = part_named(source, name);
    for (std::size_t s = 0; s < character.shapes.size(); ++s) {
      const double wanted = delta_of(source, s, donor).norm(), got = delta_of(character, s, part).norm();
      EXPECT_EQ(wanted > 0, got > 0) << name << " " << character.shapes[s].name;
      if (got == 0) continue;
      EXPECT_LT(bend(character, part, s), bend(source, donor, s) + 0.01)
          << name << " " << character.shapes[s].name;
    }
  }
}

TEST(human_onto_cartoon, is_sound) {
  expect_sound(made("human"), made("cartoon"), transferred("human", "cartoon"));
  expect_inner_parts_move_rigidly(made("human"), transferred("human", "cartoon").character);
}

TEST(human_onto_creature, is_sound) {
  expect_sound(made("human"), made("creature"), transferred("human", "creature"));
  expect_inner_parts_move_rigidly(made("human"), transferred("human", "creature").character);
}

TEST(human_onto_cartoon, does_the_same_at_any_thread_count) {
  std::string bytes[2];
  std::vector<Points> guide[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const TransferResult result = transfer(made("human"), made("cartoon"));
    bytes[threads - 1] = bytes_of(result.character);
    guide[threads - 1] = result.report.guide;
  }
  set_thread_count(0);
  EXPECT_GT(bytes[0].size(), 100000u);
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_EQ(guide[0], guide[1]);
}

/// A character whose parts are moved by a similarity; only for parts in model space.
Character moved(Character character, const Similarity& by) {
  for (Part& part : character.parts) {
    EXPECT_TRUE(part.node < 0 || character.nodes[part.node].rest.matrix().isIdentity());
    part.mesh.positions = by(PointsD(part.mesh.positions.cast<double>())).cast<float>();
    if (part.mesh.normals.rows() > 0)
      part.mesh.normals = (part.mesh.normals.cast<double>() * by.rotation.transpose()).cast<float>();
  }
  return character;
}

/// How far a transfer onto a moved target is from the moved transfer: per shape, sorted, and per joint in face sizes.
struct Off {
  std::vector<double> shapes;
  double joints = 0;
};
Off off_after(const Similarity& turn) {
  const TransferResult result = transfer(made("human"), moved(made("cartoon"), turn));
  const TransferResult& plain = transferred("human", "cartoon");
  EXPECT_THAT(validate(result.character), IsEmpty());
  EXPECT_NEAR(result.report.unit / plain.report.unit, turn.scale, 1e-4 * turn.scale);
  EXPECT_EQ(result.report.deltas.contact_shapes, plain.report.deltas.contact_shapes);
  Off off;
  for (std::size_t s = 0; s < plain.character.shapes.size(); ++s) {
    double sum = 0, size = 0;
    for (std::size_t p = 0; p < plain.character.parts.size(); ++p) {
      const PointsD expected = turn.of_vectors(delta_of(plain.character, s, static_cast<int>(p)));
      sum += (delta_of(result.character, s, static_cast<int>(p)) - expected).squaredNorm();
      size += expected.squaredNorm();
    }
    off.shapes.push_back(std::sqrt(sum / size));
  }
  std::sort(off.shapes.begin(), off.shapes.end());
  const auto after = joint_places(result.character);
  for (const auto& [name, place] : joint_places(plain.character))
    off.joints = std::max(off.joints, (after.at(name) - turn(place)).norm() / result.report.unit);
  return off;
}

TEST(human_onto_cartoon, does_the_same_at_any_size_and_turn) {
  const Off scaled = off_after({64, Eigen::Matrix3d::Identity(), {0, 0, 0}});  // no digit changes
  EXPECT_LT(scaled.shapes.back(), 1e-6);
  EXPECT_LT(scaled.joints, 1e-6);
  const Off turned = off_after(some_similarity(60));
  EXPECT_LT(turned.shapes[26], 0.01);
  EXPECT_LT(turned.shapes.back(), 0.06);
  EXPECT_LT(turned.joints, 0.02);
}

TEST(human_onto_cartoon, the_thesis_method_turns_over_more) {
  TransferOptions options;
  options.method = TransferMethod::thesis;
  const TransferResult thesis = transfer(made("human"), made("cartoon"), options);
  expect_sound(made("human"), made("cartoon"), thesis);
  const auto total = [](const std::vector<int>& flips) {
    return std::accumulate(flips.begin(), flips.end(), 0);
  };
  const int source = total(thesis.report.source_flips);
  EXPECT_GT(total(thesis.report.flips) - source,
            2 * (total(transferred("human", "cartoon").report.flips) - source));
}

}  // namespace
}  // namespace mien::test
