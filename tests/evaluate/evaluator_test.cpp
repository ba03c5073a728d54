#include "mien/evaluate/evaluator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "error_of.h"
#include "evaluate/evaluated.h"
#include "evaluate/rigs.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/load.h"

namespace mien {
namespace {

using test::all_sets;
using test::error_of;
using test::evaluated;
using test::same_bytes;
using ::testing::HasSubstr;

EvaluatorOptions with(InstructionSet set, DeltaPrecision precision = DeltaPrecision::exact) {
  return {precision, set, {}};
}

/// The largest coordinate that an evaluation meets.
double largest_coordinate(const Character& character, const Pose& pose) {
  double most = 0;
  for (const Part& part : character.parts)
    most = std::max<double>(most, part.mesh.positions.cwiseAbs().maxCoeff());
  for (const Points& points : evaluate(character, pose))
    most = std::max<double>(most, points.cwiseAbs().maxCoeff());
  for (const Eigen::Matrix4d& matrix : model_matrices(character, pose))
    most = std::max(most, matrix.topRightCorner<3, 1>().cwiseAbs().maxCoeff());
  return most;
}

double distance(const std::vector<Points>& exact, const std::vector<float>& positions) {
  double most = 0;
  const float* at = positions.data();
  for (const Points& points : exact) {
    const Eigen::Map<const Points> same(at, points.rows(), 3);
    most = std::max<double>(most, (points - same).cwiseAbs().maxCoeff());
    at += points.size();
  }
  EXPECT_EQ(at, positions.data() + positions.size());
  return most;
}

TEST(Evaluator, InvalidInputs) {
  const Character character = test::random_rig(2);
  Character broken = character;
  broken.parts[0].skin_weights.joints[0] = 77;
  EXPECT_THAT(error_of([&] { Evaluator evaluator(broken); }), HasSubstr("joint"));
  EvaluatorOptions options;
  options.vertices = {{0}};
  EXPECT_THAT(error_of([&] { Evaluator evaluator(character, options); }),
              HasSubstr("vertices: are of 1 parts; 3"));
  options.vertices = {{0, 999}, {}, {}};
  EXPECT_THAT(error_of([&] { Evaluator evaluator(character, options); }), HasSubstr("vertex 999"));
  options.vertices = {{0, 1, 0}, {}, {}};
  EXPECT_THAT(error_of([&] { Evaluator evaluator(character, options); }), HasSubstr("vertex 0 twice"));
  for (const InstructionSet set : all_sets) {
    if (is_supported(set)) continue;
    EXPECT_THAT(error_of([&] { Evaluator evaluator(character, with(set)); }), HasSubstr("does not run"));
  }

  Evaluator evaluator(character);
  std::vector<float> out(3 * evaluator.vertex_count());
  Pose pose = rest_pose(character);
  EXPECT_THAT(error_of([&] { evaluator.evaluate(pose, std::span(out).first(4)); }),
              HasSubstr("output: holds 4"));
  EXPECT_THAT(error_of([&] {
                evaluator.bake({&pose, 1}, std::span(out).first(4));
              }),
              HasSubstr("output: holds 4"));
  pose.shape_weights.values[1] = NAN;
  EXPECT_THAT(error_of([&] { evaluator.evaluate(pose, out); }),
              HasSubstr("shape weight of shape1: is not finite"));
  EXPECT_THAT(error_of([&] { evaluator.bake({&pose, 1}, out); }), HasSubstr("not finite"));
  EXPECT_THAT(error_of([&] { evaluator.compact_error(ShapeWeights(std::size_t{9})); }),
              HasSubstr("number 9; 5"));
}

TEST(Evaluator, EmptyCharacter) {
  const Character nothing;
  Evaluator evaluator(nothing);
  EXPECT_EQ(evaluator.vertex_count(), 0u);
  evaluator.evaluate(rest_pose(nothing), {});
  evaluator.bake({}, {});
}

TEST(Evaluator, ZeroWeightsGiveTheNeutralBitForBit) {
  Character character = test::random_rig(4);
  for (Part& part : character.parts) part.node = part.skin = -1;
  for (Part& part : character.parts) part.skin_weights = {};
  for (const InstructionSet set : all_sets) {
    if (!is_supported(set)) continue;
    for (const DeltaPrecision precision : {DeltaPrecision::exact, DeltaPrecision::compact}) {
      Evaluator evaluator(character, with(set, precision));
      EXPECT_EQ(
          distance(evaluate(character, rest_pose(character)), evaluated(evaluator, rest_pose(character))), 0);
    }
  }
}

TEST(Evaluator, AgreesWithEvaluateOnRandomRigs) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Character character = test::random_rig(seed);
    const Pose pose = test::random_pose(character, seed);
    const auto exact = evaluate(character, pose);
    for (const InstructionSet set : all_sets) {
      if (!is_supported(set)) continue;
      Evaluator evaluator(character, with(set));
      EXPECT_LT(distance(exact, evaluated(evaluator, pose)),
                evaluator_tolerance * largest_coordinate(character, pose))
          << "seed " << seed << ", " << name_of(set);
    }
  }
}

TEST(Evaluator, VectorSetsGiveTheSameBytes) {
  if (!is_supported(InstructionSet::avx512) || !is_supported(InstructionSet::avx2))
    GTEST_SKIP() << "not both here";
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Character character = test::random_rig(seed);
    const Pose pose = test::random_pose(character, seed);
    for (const DeltaPrecision precision : {DeltaPrecision::exact, DeltaPrecision::compact}) {
      Evaluator wide(character, with(InstructionSet::avx512, precision));
      Evaluator narrow(character, with(InstructionSet::avx2, precision));
      EXPECT_TRUE(same_bytes(evaluated(wide, pose), evaluated(narrow, pose))) << "seed " << seed;
    }
  }
}

TEST(Evaluator, CompactDeltasStayWithinTheirBound) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Character character = test::random_rig(seed);
    for (Part& part : character.parts) {  // the bound is of the shapes, before skinning
      part.node = part.skin = -1;
      part.skin_weights = {};
    }
    const Pose pose = test::random_pose(character, seed);
    for (const InstructionSet set : all_sets) {
      if (!is_supported(set)) continue;
      Evaluator evaluator(character, with(set, DeltaPrecision::compact));
      const double bound = evaluator.compact_error(pose.shape_weights);
      EXPECT_LT(bound, 1e-4);
      EXPECT_LE(distance(evaluate(character, pose), evaluated(evaluator, pose)),
                bound + evaluator_tolerance * largest_coordinate(character, pose));
      EXPECT_EQ(Evaluator(character, with(set)).compact_error(pose.shape_weights), 0);
    }
  }
}

TEST(Evaluator, BlocksHoldWhatRowsHold) {
  const Character character = test::random_rig(7);
  const Pose pose = test::random_pose(character, 7);
  Evaluator evaluator(character);
  const auto rows = evaluated(evaluator, pose);
  std::vector<float> blocks(48 * evaluator.block_count());
  evaluator.evaluate_blocks(pose, blocks);
  std::vector<int> times(evaluator.vertex_count(), 0);
  for (std::size_t i = 0; i < evaluator.lane_rows().size(); ++i) {
    const auto row = evaluator.lane_rows()[i];
    if (row < 0) continue;
    ++times[static_cast<std::size_t>(row)];
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(blocks[48 * (i / 16) + 16 * axis + i % 16], rows[3 * static_cast<std::size_t>(row) + axis]);
  }
  EXPECT_THAT(times, ::testing::Each(1));
}

TEST(Evaluator, UpdateGivesWhatEvaluateGives) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Character character = test::random_rig(seed);
    Evaluator evaluator(character), other(character);
    std::vector<float> kept(3 * evaluator.vertex_count());
    Pose pose = test::random_pose(character, seed);
    EXPECT_EQ(evaluator.update(pose, kept), evaluator.block_count());
    EXPECT_EQ(evaluator.update(pose, kept), 0u);
    test::Random random(seed);
    for (int step = 0; step < 12; ++step) {
      if (step % 3 == 0) pose.shape_weights.values[random.index(5)] = random.number(-1, 1);
      if (step % 3 == 1) pose.locals[random.index(7)].rotation = random.rotation(3);
      if (step % 4 == 2) pose.part_shape_weights = {{random.index(3), random.index(5), random.number(-1, 1)}};
      evaluator.update(pose, kept);
      ASSERT_TRUE(same_bytes(kept, evaluated(other, pose))) << "seed " << seed << ", step " << step;
    }
  }
}

TEST(Evaluator, ShapeThatMovesFewVerticesUpdatesFewBlocks) {
  Character character;
  character.parts.emplace_back();
  character.parts[0].mesh.positions = Points::Random(1600, 3);
  PartDelta delta{0, {5, 700, 1500}, Points::Ones(3, 3), {}, {}};
  character.shapes.push_back({"few", {delta}});
  Evaluator evaluator(character);
  std::vector<float> out(3 * 1600);
  Pose pose = rest_pose(character);
  EXPECT_EQ(evaluator.update(pose, out), 100u);
  pose.shape_weights.values[0] = 1;
  EXPECT_EQ(evaluator.update(pose, out), 1u);
  EXPECT_EQ(out[3 * 700], character.parts[0].mesh.positions(700, 0) + 1);
}

TEST(Evaluator, ChosenVerticesInTheOrderChosen) {
  const Character character = test::random_rig(9);
  const Pose pose = test::random_pose(character, 9);
  Evaluator whole(character),
      part(character, {DeltaPrecision::exact, InstructionSet::best, {{4, 0, 2}, {}, {3}}});
  const auto all = evaluated(whole, pose), few = evaluated(part, pose);
  ASSERT_EQ(few.size(), 12u);
  EXPECT_EQ(part.first_row(1), 3u);
  EXPECT_EQ(part.first_row(2), 3u);
  const std::size_t rows[] = {4, 0, 2, whole.first_row(2) + 3};
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(few[i], all[3 * rows[i / 3] + i % 3]);
}

std::vector<float> baked_blocks(Evaluator& evaluator, const std::vector<Pose>& poses, std::size_t offset) {
  const std::size_t size = poses.size() * 48 * evaluator.block_count();
  std::vector<float> memory(size + 32);
  std::size_t first = 0;
  while (reinterpret_cast<std::uintptr_t>(memory.data() + first) % 64) ++first;
  evaluator.bake_blocks(poses, std::span(memory).subspan(first + offset, size));
  const auto begin = memory.begin() + static_cast<std::ptrdiff_t>(first + offset);
  return {begin, begin + static_cast<std::ptrdiff_t>(size)};
}

std::vector<float> single_blocks(Evaluator& evaluator, const std::vector<Pose>& poses) {
  const std::size_t size = 48 * evaluator.block_count();
  std::vector<float> blocks(poses.size() * size);
  for (std::size_t f = 0; f < poses.size(); ++f)
    evaluator.evaluate_blocks(poses[f], std::span(blocks).subspan(f * size, size));
  return blocks;
}

TEST(Evaluator, BakeGivesWhatSingleFramesGive) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Character character = test::random_rig(seed);
    std::vector<Pose> poses;
    for (unsigned f = 0; f < 19; ++f) poses.push_back(test::random_pose(character, 100 * seed + f));
    poses[3].part_shape_weights = {{1, 2, 0.4}};
    for (const InstructionSet set : all_sets) {
      if (!is_supported(set)) continue;
      for (const DeltaPrecision precision : {DeltaPrecision::exact, DeltaPrecision::compact}) {
        Evaluator evaluator(character, with(set, precision));
        std::vector<float> frames(poses.size() * 3 * evaluator.vertex_count()), single;
        evaluator.bake(poses, frames);
        for (const Pose& pose : poses) {
          const auto one = evaluated(evaluator, pose);
          single.insert(single.end(), one.begin(), one.end());
        }
        EXPECT_TRUE(same_bytes(frames, single)) << "seed " << seed << ", " << name_of(set);
        for (const std::size_t offset : {0, 1})  // on a cache line, and off it
          EXPECT_TRUE(same_bytes(baked_blocks(evaluator, poses, offset), single_blocks(evaluator, poses)))
              << "seed " << seed << ", " << name_of(set);
      }
    }
  }
}

TEST(Evaluator, CopiesWorkApart) {
  const Character character = test::random_rig(3);
  const Pose a = test::random_pose(character, 1), b = test::random_pose(character, 2);
  Evaluator first(character);
  std::vector<float> kept(3 * first.vertex_count());
  first.update(a, kept);
  Evaluator second = first;
  evaluated(second, b);
  EXPECT_EQ(first.update(a, kept), 0u);
}

TEST(Evaluator, MakeHumanClipEveryVertexOfEveryFrame) {
  const std::filesystem::path file =
      std::filesystem::path(MIEN_SHARED_DATA) / "makehuman/caucasian_male_young.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared data";
  Character character = load(file);
  for (const SkinningMethod method : {SkinningMethod::linear_blend, SkinningMethod::dual_quaternion}) {
    for (Skin& skin : character.skins) skin.method = method;
    std::vector<Pose> poses;
    for (int frame = 0; frame < 60; ++frame) {
      poses.push_back(sample_clip(character, character.clips[0], frame + 0.5));
      poses.back().shape_weights.values[frame % poses.back().shape_weights.values.size()] = 0.8;
    }
    for (const InstructionSet set : all_sets) {
      if (!is_supported(set)) continue;
      Evaluator evaluator(character, with(set));
      const std::size_t size = 3 * evaluator.vertex_count();
      std::vector<float> frames(poses.size() * size);
      evaluator.bake(poses, frames);
      for (std::size_t f = 0; f < poses.size(); ++f)
        ASSERT_LT(distance(evaluate(character, poses[f]),
                           std::vector<float>(frames.begin() + static_cast<std::ptrdiff_t>(f * size),
                                              frames.begin() + static_cast<std::ptrdiff_t>((f + 1) * size))),
                  evaluator_tolerance * largest_coordinate(character, poses[f]))
            << "frame " << f << ", " << name_of(set);
    }
  }
}

}  // namespace
}  // namespace mien
