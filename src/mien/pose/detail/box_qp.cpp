// Roads not taken (300 sliders, 1 / 5 / 50 pins): a primal active set is as fast warm but ten times slower cold; block pivoting
// fails to converge on duplicate columns; splitting methods (OSQP, ProxQP) are 14-600 times slower at 1e-9.
#include "mien/pose/detail/box_qp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace mien::detail {
namespace {

constexpr int most_iterations = 200;
constexpr double tight = 1e-12, loose = 1e-5;  // slider units

/// More changes of the free set than this are dearer than a new factor.
int most_updates(int rows) {
  return std::max(8, rows / 4);
}

double norm(const AlignedVector& a, int count) {
  return std::sqrt(dense_kernels().dot(a.data(), a.data(), count));
}

}  // namespace

double BoxQp::entry(int row, int slider) const {
  const int panel = slider / panel_width, column = slider % panel_width;
  return panels_[static_cast<std::size_t>(panel_width) * (static_cast<std::size_t>(panel) * rows_ + row) +
                 column];
}

void BoxQp::set_rows(const Eigen::Ref<const Eigen::MatrixXd>& b) {
  const bool same_size = rows_ == b.rows() && sliders_ == b.cols();
  rows_ = static_cast<int>(b.rows());
  sliders_ = static_cast<int>(b.cols());
  padded_ = padded(sliders_);
  if (!same_size) {
    panels_.resize(static_cast<std::size_t>(padded_) * rows_);
    for (AlignedVector* v : {&y_, &residual_, &dy_, &new_residual_}) v->resize(rows_);
    for (AlignedVector* v : {&v_, &x_, &slope_, &dv_, &moved_, &new_x_, &new_slope_, &factored_slope_})
      v->resize(padded_);
    for (AlignedVector* v : {&stiffness_, &inverse_, &pull_, &sparse_, &low_, &high_}) v->resize(padded_);
    column_.resize(std::max(rows_, sliders_));
    sums_.resize(static_cast<std::size_t>(16) * rows_);
    packed_.resize(static_cast<std::size_t>(padded_) * rows_);
    gram_.resize(few_rows() ? 0 : static_cast<std::size_t>(sliders_) * sliders_);
    cholesky_.reserve(std::min(rows_, sliders_));
    free_.reserve(sliders_);
    changed_.reserve(padded_);
    signs_.reserve(most_updates(rows_));
    updates_.resize(few_rows() ? static_cast<std::size_t>(rows_) * most_updates(rows_) : 0);
    events_.reserve(static_cast<std::size_t>(4) * sliders_);
  }
  for (int j = 0; j < sliders_; ++j) {
    double* column =
        panels_.data() + static_cast<std::size_t>(panel_width) * (j / panel_width) * rows_ + j % panel_width;
    for (int r = 0; r < rows_; ++r) column[static_cast<std::size_t>(panel_width) * r] = b(r, j);
  }
  if (!few_rows()) {
    const int stride = padded(rows_);
    packed_.resize(static_cast<std::size_t>(sliders_) * stride);
    for (int j = 0; j < sliders_; ++j)
      for (int r = 0; r < rows_; ++r) packed_[static_cast<std::size_t>(j) * stride + r] = b(r, j);
    dense_kernels().multiply_by_transpose(packed_.data(), sliders_, stride, gram_.data(), sliders_);
  }
  has_factor_ = false;
  stale_ = true;
}

void BoxQp::set_sliders(const Sliders& sliders) {
  assert(static_cast<int>(sliders.stiffness.size()) == sliders_);
  std::copy(sliders.stiffness.begin(), sliders.stiffness.end(), stiffness_.data());
  std::copy(sliders.pull.begin(), sliders.pull.end(), pull_.data());
  std::copy(sliders.sparse.begin(), sliders.sparse.end(), sparse_.data());
  std::copy(sliders.low.begin(), sliders.low.end(), low_.data());
  std::copy(sliders.high.begin(), sliders.high.end(), high_.data());
  scale_ = 0;
  for (int j = 0; j < padded_; ++j) inverse_[j] = j < sliders_ ? 1 / stiffness_[j] : 1;
  for (int j = 0; j < sliders_; ++j) {
    double square = 0;
    for (int r = 0; r < rows_; ++r) square += entry(r, j) * entry(r, j);
    scale_ = std::max(scale_, std::sqrt(square) * inverse_[j]);
  }
  has_factor_ = false;
  stale_ = true;
}

void BoxQp::restart() {
  std::fill(y_.span().begin(), y_.span().end(), 0.0);
  stale_ = true;
}

double BoxQp::error_of(const AlignedVector& residual) const {
  return norm(residual, rows_) * scale_;
}

/// x, slopes and F where y is.
void BoxQp::refresh(std::span<const double> goal) {
  if (stale_) {
    std::copy_n(pull_.data(), padded_, v_.data());
    std::copy_n(y_.data(), rows_, dy_.data());
    std::fill_n(y_.data(), rows_, 0.0);
    try_move(goal, 1);
    accept_move();
    stale_ = false;
    return;
  }
  // Between solves residual_ holds B x alone.
  for (int r = 0; r < rows_; ++r) residual_[r] += y_[r] - goal[r];
}

/// Where the sliders and F would be after `step` dy; a step below 1 follows a full one along the same dy.
void BoxQp::try_move(std::span<const double> goal, double step) {
  const SliderMove move{v_.data(),  sparse_.data(), inverse_.data(), low_.data(),      high_.data(),
                        dv_.data(), moved_.data(),  new_x_.data(),   new_slope_.data()};
  dense_kernels().move_sliders(panels_.data(), rows_, padded_, step == 1 ? dy_.data() : nullptr, step, move,
                               sums_.data(), new_residual_.data());
  if (step != 1)
    for (int r = 0; r < rows_; ++r) dy_[r] *= step;
  for (int r = 0; r < rows_; ++r) new_residual_[r] += y_[r] + dy_[r] - goal[r];
}

void BoxQp::accept_move() {
  for (int r = 0; r < rows_; ++r) y_[r] += dy_[r];
  std::swap(v_, moved_);
  std::swap(x_, new_x_);
  std::swap(slope_, new_slope_);
  std::swap(residual_, new_residual_);
}

/// I + B_F D_F^-1 B_F'
bool BoxQp::factor_rows() {
  const int stride = (static_cast<int>(free_.size()) + 7) / 8 * 8;
  for (int r = 0; r < rows_; ++r) {
    double* row = packed_.data() + static_cast<std::size_t>(r) * stride;
    std::fill_n(row, stride, 0.0);
  }
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const int j = free_[f];
    const double root = std::sqrt(inverse_[j]);
    const double* from =
        panels_.data() + static_cast<std::size_t>(panel_width) * (j / panel_width) * rows_ + j % panel_width;
    for (int r = 0; r < rows_; ++r)
      packed_[static_cast<std::size_t>(r) * stride + f] =
          root * from[static_cast<std::size_t>(panel_width) * r];
  }
  double* lower = cholesky_.lower(rows_);
  dense_kernels().multiply_by_transpose(packed_.data(), rows_, stride, lower, cholesky_.stride());
  for (int r = 0; r < rows_; ++r) lower[static_cast<std::size_t>(r) * cholesky_.stride() + r] += 1;
  return cholesky_.factor();
}

/// D_F + B_F'B_F
bool BoxQp::factor_sliders() {
  const int count = static_cast<int>(free_.size());
  double* lower = cholesky_.lower(count);
  for (int c = 0; c < count; ++c) {
    double* column = lower + static_cast<std::size_t>(c) * cholesky_.stride();
    const double* from = gram_.data() + static_cast<std::size_t>(free_[c]) * sliders_;
    for (int r = c; r < count; ++r) column[r] = from[free_[r]];
    column[c] += stiffness_[free_[c]];
  }
  return cholesky_.factor();
}

/// The factor follows the sliders that became free or held, one after the other, when they are few.
bool BoxQp::update_free_set() {
  changed_.clear();
  for (int p = 0; p < padded_; p += panel_width) {
    if (std::memcmp(slope_.data() + p, factored_slope_.data() + p, panel_width * sizeof(double)) == 0)
      continue;
    for (int j = p; j < p + panel_width; ++j)
      if (slope_[j] != factored_slope_[j]) changed_.push_back(j);
  }
  if (changed_.empty()) return true;
  if (!few_rows() || static_cast<int>(changed_.size()) > most_updates(rows_)) return false;
  signs_.clear();
  double* vector = updates_.data();
  for (const double sign : {1.0, -1.0})  // additions first: they keep it away from singular
    for (const int j : changed_) {
      if ((slope_[j] > 0) != (sign > 0)) continue;
      const double root = std::sqrt(inverse_[j]);
      for (int r = 0; r < rows_; ++r) vector[r] = root * entry(r, j);
      vector += rows_;
      signs_.push_back(sign);
      factored_slope_[j] = slope_[j];
    }
  return cholesky_.update(updates_.data(), signs_);
}

bool BoxQp::factor_free_set() {
  if (has_factor_ && update_free_set()) return true;
  free_.clear();
  for (int j = 0; j < sliders_; ++j)
    if (slope_[j] > 0) free_.push_back(j);
  std::copy_n(slope_.data(), padded_, factored_slope_.data());
  has_factor_ = few_rows() ? factor_rows() : factor_sliders();
  return has_factor_;
}

void BoxQp::newton_direction() {
  for (int r = 0; r < rows_; ++r) dy_[r] = -residual_[r];
  if (few_rows()) return cholesky_.solve(dy_.data());
  // (I + B D^-1 B')^-1 = I - B (D + B'B)^-1 B'
  for (std::size_t f = 0; f < free_.size(); ++f) {
    double sum = 0;
    for (int r = 0; r < rows_; ++r) sum += entry(r, free_[f]) * dy_[r];
    column_[f] = sum;
  }
  cholesky_.solve(column_.data());
  for (std::size_t f = 0; f < free_.size(); ++f)
    for (int r = 0; r < rows_; ++r) dy_[r] -= entry(r, free_[f]) * column_[f];
}

/// A stretch (from, to) of v where the slider is free, as bends of the search's slope.
void BoxQp::add_events(int slider, double from, double to, double& bend) {
  const double v = v_[slider], end = moved_[slider], dv = dv_[slider];
  if (!(from < to) || (v <= from && end <= from) || (v >= to && end >= to)) return;
  const double weight = inverse_[slider] * dv * dv;
  if (v > from && v < to)
    bend += weight;
  else
    events_.push_back({((v <= from ? from : to) - v) / dv, weight});
  if (end <= from || end >= to) events_.push_back({((end <= from ? from : to) - v) / dv, -weight});
}

/// Where along dy (at most 1) the slope F'dy vanishes.
double BoxQp::search_step() {
  events_.clear();
  double slope = dense_kernels().dot(residual_.data(), dy_.data(), rows_);
  double bend = dense_kernels().dot(dy_.data(), dy_.data(), rows_);
  for (int j = 0; j < sliders_; ++j) {
    if (slope_[j] > 0 && new_slope_[j] > 0) {  // free all the way (or, with a dead zone, across it)
      if (sparse_[j] == 0 || (v_[j] > 0) == (moved_[j] > 0)) {
        bend += slope_[j] * dv_[j] * dv_[j];
        continue;
      }
    } else if (slope_[j] == new_slope_[j] && x_[j] == new_x_[j]) {
      continue;  // held all the way
    }
    const double d = stiffness_[j], s = sparse_[j], low = low_[j], high = high_[j];
    if (s == 0) {
      add_events(j, low * d, high * d, bend);
      continue;
    }
    if (low < 0) add_events(j, low * d - s, std::min(high, 0.0) * d - s, bend);
    if (high > 0) add_events(j, std::max(low, 0.0) * d + s, high * d + s, bend);
  }
  std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.t < b.t; });
  double t = 0;
  for (const Event& event : events_) {
    const double next = slope + bend * (event.t - t);
    if (next >= 0) break;
    slope = next;
    t = event.t;
    bend += event.bend;
  }
  return std::clamp(t - slope / bend, 0.0, 1.0);
}

/// The largest |x - x(g - B x)|: what the optimality conditions are missed by, in slider units.
double BoxQp::gap(std::span<const double> goal) {
  for (int r = 0; r < rows_; ++r) dy_[r] = -residual_[r];
  try_move(goal, 1);
  double worst = 0, size = 1;
  for (int j = 0; j < sliders_; ++j) {
    worst = std::max(worst, std::abs(new_x_[j] - x_[j]));
    size = std::max({size, std::abs(x_[j]), sparse_[j] * inverse_[j]});
  }
  return worst / size;
}

BoxQp::Outcome BoxQp::solve(std::span<const double> goal) {
  assert(static_cast<int>(goal.size()) == rows_);
  refresh(goal);
  Outcome outcome;
  double error = error_of(residual_), best = error;
  for (int stalled = 0; error > tight && stalled < 6 && outcome.iterations < most_iterations;
       ++outcome.iterations) {
    if (!factor_free_set()) break;
    newton_direction();
    try_move(goal, 1);
    double next = error_of(new_residual_);
    // A full step is taken where the function still falls, or where F shrinks as never before (which cannot go on).
    if (next > best / 2 && dense_kernels().dot(new_residual_.data(), dy_.data(), rows_) > 0) {
      try_move(goal, search_step());
      next = error_of(new_residual_);
    }
    accept_move();
    error = next;
    // An error that no longer halves is rounding when it is small, or when y does not move.
    const bool still = error < loose || norm(dy_, rows_) < 1e-14 * norm(y_, rows_);
    stalled = error < best / 2 || !still ? 0 : stalled + 1;
    best = std::min(best, error);
  }
  outcome.residual = error > tight ? gap(goal) : error;
  outcome.converged = outcome.residual <= 1e-9;
  for (int r = 0; r < rows_; ++r) residual_[r] += goal[r] - y_[r];
  return outcome;
}

}  // namespace mien::detail
