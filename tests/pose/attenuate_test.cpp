#include "mien/pose/attenuate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "mien/core/error.h"
#include "mien/pose/detail/dense_box_qp.h"
#include "mien/pose/solve_pins.h"
#include "pose/box_qp_cases.h"
#include "pose/small_face.h"

namespace mien {
namespace {

Tag tag_at(int vertex, const char* axes = "xyz") {
  Tag tag;
  tag.at.vertex = vertex;
  tag.axes = held_axes(axes);
  return tag;
}

Eigen::MatrixXd shape_matrix(const Character& face) {
  Eigen::MatrixXd d =
      Eigen::MatrixXd::Zero(3 * test::grid * test::grid, static_cast<Eigen::Index>(face.shapes.size()));
  for (Eigen::Index s = 0; s < d.cols(); ++s) {
    const PartDelta& delta = face.shapes[static_cast<std::size_t>(s)].parts[0];
    for (std::size_t i = 0; i < delta.vertices.size(); ++i)
      d.col(s).segment<3>(3 * delta.vertices[i]) =
          delta.deltas.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
  }
  return d;
}

std::string error_of(const Character& face, const std::vector<Tag>& tags,
                     const AttenuateOptions& options = {}) {
  try {
    attenuate(face, tags, rest_rig_pose(face), rest_sliders(face), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Attenuate, names_what_is_wrong) {
  const Character face = test::small_face(6);
  EXPECT_EQ(error_of(face, {}), "tags: are none; one or more coordinates to keep still");
  EXPECT_EQ(error_of(Character{}, {tag_at(0)}),
            "character: has no sliders; shapes, each with its slider, so that there is motion to attenuate");
  EXPECT_EQ(error_of(face, {tag_at(3), tag_at(200)}), "tag 2: vertex 200 is not on part Face; 0 to 143");
  AttenuateOptions options;
  options.alpha = -1;
  EXPECT_EQ(error_of(face, {tag_at(3)}, options), "alpha: is negative or not finite; 0 or more");
  EXPECT_THROW(held_axes("xx"), Error);
  EXPECT_THROW(held_axes(""), Error);
}

/// The paper's eq. 3 from its own matrices.
TEST(Attenuate, is_the_papers_formula_on_the_change) {
  const Character face = test::small_face(9);
  RigPose tagging = rest_rig_pose(face);
  tagging.sliders.values[2] = 0.3;
  SliderValues moved = tagging.sliders;
  moved.values.setConstant(0.6);
  const std::vector<Tag> tags{tag_at(65), tag_at(66, "y")};
  AttenuateOptions options;
  options.within_limits = false;
  const AttenuateResult result = attenuate(face, tags, tagging, moved, options);
  EXPECT_DOUBLE_EQ(result.alpha, (432.0 - 4) / 4);

  const Eigen::MatrixXd d = shape_matrix(face);
  Eigen::MatrixXd s(4, 9);
  s << d.row(195), d.row(196), d.row(197), d.row(199);
  const Eigen::MatrixXd q = s.transpose() * s, p = d.transpose() * d - q;
  const Eigen::VectorXd exact =
      tagging.sliders.values +
      (p + result.alpha * q).fullPivLu().solve(p * (moved.values - tagging.sliders.values));
  EXPECT_LT((result.sliders.values - exact).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(result.drift, 0.6 * result.unattenuated_drift);
  EXPECT_GT(result.unattenuated_drift, 0.01);
}

TEST(Attenuate, tagging_alone_moves_nothing) {
  const Character face = test::small_face(9);
  RigPose tagging = rest_rig_pose(face);
  tagging.sliders.values[2] = 0.3;
  tagging.sliders.values[6] = 1.4;  // outside its range
  Attenuator attenuator(face, tagging);
  for (const int v : {40, 65, 90}) {
    attenuator.add_tag(tag_at(v));
    EXPECT_LT((attenuator.attenuate(tagging.sliders).values - tagging.sliders.values).cwiseAbs().maxCoeff(),
              1e-12);
  }
}

TEST(Attenuate, alpha_0_changes_nothing_and_a_high_one_holds_still) {
  const Character face = test::small_face(16);
  const RigPose tagging = rest_rig_pose(face);
  SliderValues moved = tagging.sliders;
  moved.values.setConstant(0.4);
  AttenuateOptions options;
  options.within_limits = false;
  options.alpha = 0;
  EXPECT_LT((attenuate(face, {tag_at(65)}, tagging, moved, options).sliders.values - moved.values)
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
  double last = HUGE_VAL;
  for (const double alpha : {1.0, 10.0, 1e3, 1e6}) {
    options.alpha = alpha;
    const AttenuateResult result = attenuate(face, {tag_at(65)}, tagging, moved, options);
    EXPECT_LT(result.drift, last);
    last = result.drift;
  }
  EXPECT_LT(last, 1e-4);
}

TEST(Attenuate, stays_in_range_and_is_then_the_best_in_range) {
  const Character face = test::small_face(14);
  RigPose tagging = rest_rig_pose(face);
  tagging.sliders.values[3] = 0.9;
  SliderValues moved = tagging.sliders;
  for (int s = 0; s < 14; ++s) moved.values[s] = s % 2 ? 1 : 0.1;
  AttenuateOptions options, open;
  open.within_limits = false;
  const Eigen::VectorXd boxed = attenuate(face, {tag_at(65)}, tagging, moved, options).sliders.values;
  const Eigen::VectorXd free = attenuate(face, {tag_at(65)}, tagging, moved, open).sliders.values;
  EXPECT_TRUE(free.minCoeff() < 0 || free.maxCoeff() > 1);  // or the test shows nothing
  EXPECT_GE(boxed.minCoeff(), -1e-15);
  EXPECT_LE(boxed.maxCoeff(), 1 + 1e-15);
}

TEST(Attenuate, shapes_that_are_zero_or_doubled_are_no_obstacle) {
  Character face = test::small_face(8);
  face.shapes[3].parts[0].deltas.setZero();
  face.shapes[5].parts = face.shapes[4].parts;
  face.shapes[6].parts.clear();
  const RigPose tagging = rest_rig_pose(face);
  SliderValues moved = tagging.sliders;
  moved.values << 0.2, 0.4, 0.1, 0.6, 0.3, 0.5, 0.7, 0.2;
  const AttenuateResult result = attenuate(face, {tag_at(65)}, tagging, moved);
  EXPECT_TRUE(result.sliders.values.allFinite());
  EXPECT_NEAR(result.sliders.values[3], 0.6, 1e-9);  // what moves nothing stays where it was put
  EXPECT_NEAR(result.sliders.values[6], 0.7, 1e-9);
}

TEST(Attenuator, adding_and_removing_tags_ends_where_a_fresh_one_begins) {
  Character face = test::small_face(12);
  test::add_correctives(face, 5);
  RigPose tagging = rest_rig_pose(face);
  tagging.sliders.values.setConstant(0.3);
  Attenuator attenuator(face, tagging);
  attenuator.add_tag(tag_at(40));
  const int middle = attenuator.add_tag(tag_at(65));
  attenuator.add_tag(tag_at(90, "xz"));
  attenuator.remove_tag(middle);
  EXPECT_THROW(attenuator.remove_tag(middle), Error);
  Attenuator fresh(face, tagging);
  fresh.add_tag(tag_at(40));
  fresh.add_tag(tag_at(90, "xz"));
  EXPECT_LT((attenuator.map() - fresh.map()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(attenuator.alpha(), fresh.alpha());

  SliderValues one_by_one = tagging.sliders, all = tagging.sliders;
  all.values[1] += 0.01;
  all.values[4] -= 0.02;
  attenuator.move_slider(1, 0.01, one_by_one);
  attenuator.move_slider(4, -0.02, one_by_one);
  EXPECT_LT((attenuator.attenuate(all).values - one_by_one.values).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Attenuator, tags_hold_while_pins_pull) {
  const Character face = test::small_face(24);
  const RigPose start = rest_rig_pose(face);
  std::vector<Pin> pins{test::pin_at(65, {0.1, 0.1, 0})};
  const double without =
      (test::vertex_at(face, solve_pins(face, pins, start).pose, 80) - test::vertex_at(face, start, 80))
          .norm();
  const std::vector<Pin> held = held_by_tags({tag_at(80)}, 10);
  pins.insert(pins.end(), held.begin(), held.end());
  const double with =
      (test::vertex_at(face, solve_pins(face, pins, start).pose, 80) - test::vertex_at(face, start, 80))
          .norm();
  EXPECT_LT(with, 0.3 * without);
}

TEST(DenseBoxQp, agrees_with_the_other_solver) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const test::BoxQpCase c = test::random_box_qp(random, 30, false);
    detail::BoxQp solver;
    solver.set_rows(c.b);
    solver.set_sliders(c.sliders());
    solver.solve(test::BoxQpCase::span(c.goal));
    const Eigen::MatrixXd h = c.b.transpose() * c.b + Eigen::MatrixXd(c.stiffness.asDiagonal());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(c.stiffness.size());
    EXPECT_TRUE(detail::minimise_in_box(h, c.b.transpose() * c.goal + c.pull, c.low, c.high, x));
    EXPECT_LT((x - test::change_of(solver)).cwiseAbs().maxCoeff(), 1e-6 * (1 + x.cwiseAbs().maxCoeff()));
  }
}

}  // namespace
}  // namespace mien
