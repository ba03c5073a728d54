#include <gtest/gtest.h>

#include "character/objects_in_code.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"

// Poses that move influence objects, through the compiled evaluator.

namespace mien {
namespace {

Character rigged() {
  Character character = test::head_and_lip();
  character.objects = {test::line(), test::frame(Cluster{})};
  character.objects[0].node = 2;
  character.shapes[0].objects.push_back({0, PointsD::Ones(2, 3)});
  return character;
}

Pose posed(const Character& character, double weight, double angle) {
  Pose pose = rest_pose(character);
  pose.shape_weights.values[0] = weight;
  pose.locals[2].rotation =
      pose.locals[2].rotation * Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
  return pose;
}

void expect_same(const Points& wanted, const float* rows) {
  for (Eigen::Index v = 0; v < wanted.rows(); ++v)
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(rows[3 * v + axis], wanted(v, axis), 1e-5);
}

TEST(evaluator_objects, every_call_agrees_with_the_reference) {
  const Character character = rigged();
  Evaluator evaluator(character),
      updated(character);  // an update goes on from its evaluator's own last frame
  const std::vector<Pose> poses{posed(character, 0, 0), posed(character, 0.7, 0), posed(character, 0.7, 0.5),
                                posed(character, 0, 0.5), posed(character, 0, 0)};
  std::vector<float> rows(3 * evaluator.vertex_count()), kept(rows.size()),
      frames(poses.size() * rows.size()), blocks(48 * evaluator.block_count());
  evaluator.bake(poses, frames);
  for (std::size_t f = 0; f < poses.size(); ++f) {
    const Points wanted = evaluate(character, poses[f])[0];
    evaluator.evaluate(poses[f], rows);
    expect_same(wanted, rows.data());
    updated.update(poses[f], kept);
    expect_same(wanted, kept.data());
    expect_same(wanted, frames.data() + f * rows.size());
    evaluator.evaluate_blocks(poses[f], blocks);
    for (std::size_t lane = 0; lane < evaluator.lane_rows().size(); ++lane)
      if (const int row = evaluator.lane_rows()[lane]; row >= 0)
        for (std::size_t axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(blocks[48 * (lane / 16) + 16 * axis + lane % 16], wanted(row, static_cast<int>(axis)),
                      1e-5);
  }
}

TEST(evaluator_objects, chosen_vertices_come_in_their_order) {
  const Character character = rigged();
  EvaluatorOptions options;
  options.vertices = {{3, 0}};
  Evaluator evaluator(character, options);
  std::vector<float> rows(6);
  const Pose pose = posed(character, 1, 0.3);
  evaluator.evaluate(pose, rows);
  const Points wanted = evaluate(character, pose)[0];
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(rows[static_cast<std::size_t>(axis)], wanted(3, axis), 1e-5);
    EXPECT_NEAR(rows[static_cast<std::size_t>(3 + axis)], wanted(0, axis), 1e-5);
  }
}

TEST(evaluator_objects, a_move_of_an_object_that_is_not_there_is_refused) {
  const Character character = test::head_and_lip();
  Evaluator evaluator(character);
  std::vector<float> rows(3 * evaluator.vertex_count());
  Pose pose = rest_pose(character);
  pose.objects = {{0, PointsD::Zero(2, 3)}};
  EXPECT_THROW(evaluator.evaluate(pose, rows), Error);
}

}  // namespace
}  // namespace mien
