#pragma once
/// The quadratic program of a drag: least squares over few rows, a stiffness a slider, limits, and a dead zone that
/// keeps sliders from moving for little.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mien/pose/detail/cholesky.h"
#include "mien/pose/detail/dense_kernels.h"

namespace mien::detail {

/// min over x in [low, high] of  1/2 |B x - g|^2 + sum_j (1/2 d_j x_j^2 - pull_j x_j + sparse_j |x_j|)
///
/// x is the sliders' change from the start of the drag. Eq. 3 of Lewis and Anjyo 2010 in these terms:
/// d = alpha stiffness + mu, pull = -mu w0, g = m - B w0, low = -w0, high = t - w0, sparse = 0.
///
/// Method: the dual's semismooth Newton. With y = g - B x unknown, x_j(y) = clip(shrink(pull_j + B_j'y, sparse_j) / d_j,
/// low_j, high_j) solves every slider for itself, and F(y) = y - g + B x(y) is the gradient of a strongly convex,
/// piecewise quadratic function. A Newton step solves (I + B_F D_F^-1 B_F') dy = -F over the free sliders F, exactly
/// searched along its piecewise linear slope, so that finitely many steps end at the solution: there is no cycling, and
/// no step length to tune. The matrix is kept as a Cholesky factor that follows the few sliders that become free or held
/// from one solve to the next. With more rows than sliders the same matrix is inverted by way of D_F + B_F'B_F
/// (Woodbury), which is then the smaller one.
class BoxQp {
 public:
  struct Sliders {
    std::span<const double> stiffness;  ///< d, > 0
    std::span<const double> pull;
    std::span<const double> sparse;     ///< >= 0
    std::span<const double> low, high;  ///< low <= high; equal: the slider is held there; may be infinite
  };
  struct Outcome {
    bool converged = false;
    int iterations = 0;
    /// At most how far a slider is from where the optimality conditions want it, in slider units; over the largest change
    /// or dead zone (sparse / d), where that is above 1.
    double residual = 0;
  };

  /// #R x #S. The next solve starts from the last one's y if #R is the same.
  void set_rows(const Eigen::Ref<const Eigen::MatrixXd>& b);
  /// #S each. To be called after `set_rows`.
  void set_sliders(const Sliders& sliders);
  /// Forgets what the last solve found.
  void restart();
  /// #R. Allocates nothing.
  Outcome solve(std::span<const double> goal);
  /// #S, of the last solve.
  std::span<const double> change() const { return {x_.data(), static_cast<std::size_t>(sliders_)}; }

  /// #R: g - B x, of the last solve, as exact as the change.
  std::span<const double> remainder() const { return {y_.data(), static_cast<std::size_t>(rows_)}; }

 private:
  struct Event {
    double t, bend;
  };
  bool few_rows() const { return rows_ <= sliders_; }
  double entry(int row, int slider) const;
  void refresh(std::span<const double> goal);
  bool factor_free_set();
  bool update_free_set();
  bool factor_rows();
  bool factor_sliders();
  void newton_direction();
  double error_of(const AlignedVector& residual) const;
  void try_move(std::span<const double> goal, double step);
  void accept_move();
  double gap(std::span<const double> goal);
  double search_step();
  void add_events(int slider, double from, double to, double& bend);

  int rows_ = 0, sliders_ = 0, padded_ = 0;
  AlignedVector panels_;  // B
  AlignedVector gram_;    // B'B when there are more rows than sliders
  AlignedVector stiffness_, inverse_, pull_, sparse_, low_, high_;
  AlignedVector y_, v_, x_, slope_, residual_;  // the present point; v = pull + B'y
  AlignedVector dy_, dv_, moved_, new_x_, new_slope_, new_residual_;
  AlignedVector factored_slope_, packed_, column_, sums_, updates_;
  Cholesky cholesky_;
  std::vector<int> free_, changed_;
  std::vector<Event> events_;
  std::vector<double> signs_;
  double scale_ = 0;  // what one unit of F may be worth in slider units
  bool has_factor_ = false, stale_ = true;
};

}  // namespace mien::detail
