#pragma once
/// What compiled evaluators must keep whatever moves the character: shapes, joints, wires, influence objects.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "evaluate/evaluated.h"
#include "mien/core/error.h"
#include "mien/evaluate/point_evaluator.h"

namespace mien::test {

/// What `evaluate`, an Evaluator and a PointEvaluator say of a pose that they refuse: the same.
inline std::string refusal_of(const Character& character, const Pose& pose) {
  Evaluator evaluator(character);
  PointEvaluator points(character, {{0, -1, 3, {1, 0, 0}, {0, 1, 2}}});
  std::vector<float> out(3 * evaluator.vertex_count());
  PointsD few;
  std::string text;
  for (const auto& call : {std::function<void()>([&] { evaluator.evaluate(pose, out); }),
                           std::function<void()>([&] { points.positions(pose, few); }),
                           std::function<void()>([&] { evaluate(character, pose); })}) {
    std::string here;
    try {
      call();
    } catch (const Error& error) {
      here = error.what();
    }
    EXPECT_TRUE(text.empty() || text == here) << text << " | " << here;
    text = here;
  }
  return text;
}

/// A bake gives the bytes of single frames, chosen vertices those of all; of a character of three parts.
inline void expect_bakes_and_choices(const Character& character, const std::vector<Pose>& poses) {
  for (const InstructionSet set : all_sets) {
    if (!is_supported(set)) continue;
    Evaluator whole(character, {DeltaPrecision::exact, set, {}});
    Evaluator part(character, {DeltaPrecision::exact, set, {{4, 0, 2}, {1}, {3}}});
    std::vector<float> frames(poses.size() * 3 * whole.vertex_count()), single;
    whole.bake(poses, frames);
    const std::size_t rows[] = {4, 0, 2, whole.first_row(1) + 1, whole.first_row(2) + 3};
    for (const Pose& pose : poses) {
      const auto all = evaluated(whole, pose), few = evaluated(part, pose);
      single.insert(single.end(), all.begin(), all.end());
      for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i], all[3 * rows[i / 3] + i % 3]);
    }
    EXPECT_TRUE(same_bytes(frames, single)) << name_of(set);
  }
}

/// A PointEvaluator has every vertex where `evaluate` has it.
inline void expect_points_follow(const Character& character, const Pose& pose, double tolerance) {
  PointEvaluator points(character, all_vertices(character));
  PointsD out;
  points.positions(pose, out);
  const auto exact = joined(evaluate(character, pose));
  double most = 0;
  for (Eigen::Index i = 0; i < out.size(); ++i)
    most = std::max(most, std::abs(out(i / 3, i % 3) - exact[static_cast<std::size_t>(i)]));
  EXPECT_LT(most, tolerance);
}

/// Every shape; every node's turns and shifts.
inline Freedoms all_freedoms(const Character& character) {
  Freedoms all;
  for (std::size_t s = 0; s < character.shapes.size(); ++s) all.shapes.push_back(static_cast<int>(s));
  for (std::size_t n = 0; n < character.nodes.size(); ++n)
    all.joints.push_back({static_cast<int>(n), true, true});
  return all;
}

/// `pose` with freedom `column` of all moved by `step`.
inline Pose moved(const Pose& pose, Eigen::Index column, double step) {
  Pose result = pose;
  const Eigen::Index shapes = pose.shape_weights.values.size();
  if (column < shapes) {
    result.shape_weights.values[column] += step;
    return result;
  }
  Transform& local = result.locals[static_cast<std::size_t>((column - shapes) / 6)];
  const auto axis = (column - shapes) % 6;
  if (axis < 3)
    local.rotation = local.rotation * Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(axis));
  else
    local.translation[axis - 3] += step;
  return result;
}

/// The Jacobian by central differences, against the analytic one, of the size of the largest entry.
inline void expect_jacobian(const Character& character, const Pose& pose,
                            const std::vector<SurfacePoint>& points) {
  PointEvaluator evaluator(character, points);
  const Freedoms all = all_freedoms(character);
  Eigen::MatrixXd analytic;
  evaluator.jacobian(pose, all, analytic);
  ASSERT_TRUE(analytic.allFinite());
  const double step = 1e-5, scale = std::max(1e-3, analytic.cwiseAbs().maxCoeff());
  PointsD up, down;
  for (Eigen::Index c = 0; c < all.column_count(); ++c) {
    evaluator.positions(moved(pose, c, step), up);
    evaluator.positions(moved(pose, c, -step), down);
    const PointsD slope = (up - down) / (2 * step);
    for (Eigen::Index p = 0; p < slope.rows(); ++p)
      ASSERT_LT((slope.row(p).transpose() - analytic.block<3, 1>(3 * p, c)).norm(), 1e-7 * scale)
          << "point " << p << ", column " << c;
  }
}

/// Positions are linear in shape weights, with the rows for slopes.
inline void expect_shape_rows(const Character& character, const Pose& pose,
                              const std::vector<SurfacePoint>& points, double tolerance) {
  PointEvaluator evaluator(character, points);
  Pose other = pose;
  other.shape_weights.values.setConstant(-0.7);
  Eigen::MatrixXd rows;
  evaluator.shape_rows(pose, rows);
  PointsD from, to;
  evaluator.positions(pose, from);
  evaluator.positions(other, to);
  const Eigen::VectorXd move = rows * (other.shape_weights.values - pose.shape_weights.values);
  for (Eigen::Index p = 0; p < from.rows(); ++p)
    EXPECT_LT((to.row(p) - from.row(p) - move.segment<3>(3 * p).transpose()).norm(), tolerance);
}

}  // namespace mien::test
