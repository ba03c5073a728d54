#include "mien/pose/detail/box_qp.h"

#include <gtest/gtest.h>

#include <limits>

#include "pose/box_qp_cases.h"

namespace mien {
namespace {

using detail::BoxQp;
using test::BoxQpCase;
using test::change_of;
using test::optimality_gap;

double objective(const BoxQpCase& c, const Eigen::VectorXd& x) {
  return (c.b * x - c.goal).squaredNorm() / 2 + x.cwiseAbs2().dot(c.stiffness) / 2 - c.pull.dot(x) +
         c.sparse.dot(x.cwiseAbs());
}

/// Tries every set of sliders held at a limit; the dead zone is not its business.
Eigen::VectorXd brute_force(const BoxQpCase& c) {
  const int n = static_cast<int>(c.stiffness.size());
  const Eigen::MatrixXd h = c.b.transpose() * c.b + Eigen::MatrixXd(c.stiffness.asDiagonal());
  const Eigen::VectorXd q = c.b.transpose() * c.goal + c.pull;
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double least = std::numeric_limits<double>::infinity();
  for (int code = 0; code < std::pow(3, n); ++code) {
    Eigen::MatrixXd a = h;
    Eigen::VectorXd right = q;
    int rest = code;
    bool possible = true;
    for (int j = 0; j < n; ++j, rest /= 3) {
      if (rest % 3 == 0) continue;
      const double limit = rest % 3 == 1 ? c.low[j] : c.high[j];
      possible &= std::isfinite(limit);
      a.row(j).setZero();
      a(j, j) = 1;
      right[j] = limit;
    }
    if (!possible) continue;
    const Eigen::VectorXd x = a.partialPivLu().solve(right);
    if (((x - c.low).array() < -1e-10).any() || ((x - c.high).array() > 1e-10).any()) continue;
    if (objective(c, x) < least) {
      least = objective(c, x);
      best = x;
    }
  }
  return best;
}

TEST(BoxQp, agrees_with_every_set_of_held_sliders_tried) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const BoxQpCase c = test::random_box_qp(random, 6, false);
    BoxQp solver;
    solver.set_rows(c.b);
    solver.set_sliders(c.sliders());
    ASSERT_TRUE(solver.solve(BoxQpCase::span(c.goal)).converged);
    const Eigen::VectorXd exact = brute_force(c);
    EXPECT_NEAR(objective(c, change_of(solver)), objective(c, exact), 1e-9 * (1 + objective(c, exact)));
    EXPECT_LT((change_of(solver) - exact).cwiseAbs().maxCoeff(), 1e-5);  // LU on H: it squares the condition
  }
}

TEST(BoxQp, satisfies_the_optimality_conditions_on_hard_cases) {
  std::mt19937 random(2);
  BoxQp solver;  // one for all: sizes grow and shrink
  for (int trial = 0; trial < 3000; ++trial) {
    const BoxQpCase c = test::random_box_qp(random, 80, trial % 3 == 0);
    solver.set_rows(c.b);
    solver.restart();
    solver.set_sliders(c.sliders());
    const BoxQp::Outcome outcome = solver.solve(BoxQpCase::span(c.goal));
    const double tolerance = trial % 3 == 0 ? 1e-8 : 1e-9;  // a dead zone takes digits away
    ASSERT_LT(optimality_gap(c, change_of(solver)), tolerance) << trial << ", " << outcome.residual;
    ASSERT_LT(outcome.iterations, 60);
  }
}

TEST(BoxQp, a_warm_start_ends_where_a_cold_one_does) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const BoxQpCase c = test::random_box_qp(random, 60, false);
    BoxQp warm;
    warm.set_rows(c.b);
    warm.set_sliders(c.sliders());
    for (int step = 0; step <= 20; ++step) {
      const Eigen::VectorXd goal = c.goal * (0.1 * step - 1);
      ASSERT_TRUE(warm.solve(BoxQpCase::span(goal)).converged);
      BoxQpCase here = c;
      here.goal = goal;
      ASSERT_LT(optimality_gap(here, change_of(warm)), 1e-9) << trial << " " << step;
    }
  }
}

TEST(BoxQp, a_goal_that_is_met_moves_nothing_at_all) {
  std::mt19937 random(4);
  BoxQpCase c = test::random_box_qp(random, 40, false);
  c.pull.setZero();
  c.low = c.low.cwiseMin(0.0);
  c.high = c.high.cwiseMax(0.0);
  BoxQp solver;
  solver.set_rows(c.b);
  solver.set_sliders(c.sliders());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(c.goal.size());
  solver.solve(BoxQpCase::span(zero));
  EXPECT_EQ(change_of(solver).cwiseAbs().maxCoeff(), 0);
}

TEST(BoxQp, a_dead_zone_as_wide_as_the_goal_pulls_holds_every_slider) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    BoxQpCase c = test::random_box_qp(random, 40, false);
    c.pull.setZero();
    c.low = c.low.cwiseMin(0.0);
    c.high = c.high.cwiseMax(0.0);
    c.sparse.setConstant(1.0001 * (c.b.transpose() * c.goal).cwiseAbs().maxCoeff());
    BoxQp solver;
    solver.set_rows(c.b);
    solver.set_sliders(c.sliders());
    solver.solve(BoxQpCase::span(c.goal));
    EXPECT_EQ(change_of(solver).cwiseAbs().maxCoeff(), 0);
  }
}

TEST(DenseKernels, every_instruction_set_says_the_same) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const int rows = 7, count = 41;
  std::vector<double> a(rows * 48), x(count), y(count);
  for (auto* v : {&a, &x, &y})
    for (double& value : *v) value = normal(random);
  const detail::DenseKernels& any = *detail::dense_kernels_of(0);
  for (const int level : {1, 2}) {
    const detail::DenseKernels* kernels = detail::dense_kernels_of(level);
    if (!kernels) continue;
    EXPECT_NEAR(kernels->dot(x.data(), y.data(), count), any.dot(x.data(), y.data(), count), 1e-12);
    std::vector<double> first(rows * rows), second(rows * rows), one = x, two = x;
    any.multiply_by_transpose(a.data(), rows, 48, first.data(), rows);
    kernels->multiply_by_transpose(a.data(), rows, 48, second.data(), rows);
    any.add_scaled(one.data(), y.data(), 0.3, count);
    kernels->add_scaled(two.data(), y.data(), 0.3, count);
    for (int i = 0; i < rows * rows; ++i) EXPECT_NEAR(first[i], second[i], 1e-11);
    for (int i = 0; i < count; ++i) EXPECT_NEAR(one[i], two[i], 1e-12);
  }
}

}  // namespace
}  // namespace mien
