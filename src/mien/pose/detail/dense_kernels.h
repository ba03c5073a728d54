#pragma once
/// The three loops that dragging spends its time in, compiled for AVX-512, for AVX2 and for any processor; the best one
/// that runs here is chosen once.
///
/// Rows of B (#R x #S) lie in panels of 16 columns: panel p holds B(r, 16 p + c) at 16 (p #R + r) + c. Vectors over
/// sliders are padded to a multiple of 16; a padded slider has a zero column and zero limits, so that it never moves.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mien::detail {

constexpr int panel_width = 16;

/// `count` rounded up to whole panels.
constexpr int padded(int count) {
  return (count + panel_width - 1) / panel_width * panel_width;
}

/// A vector that starts on a cache line.
class AlignedVector {
 public:
  /// Zeros. Allocates only when it grows beyond any earlier size.
  void resize(std::size_t count) {
    storage_.assign(count + 8, 0.0);
    begin_ = (64 - reinterpret_cast<std::uintptr_t>(storage_.data()) % 64) / sizeof(double) % 8;
    count_ = count;
  }
  double* data() { return storage_.data() + begin_; }
  const double* data() const { return storage_.data() + begin_; }
  std::size_t size() const { return count_; }
  double& operator[](std::size_t i) { return data()[i]; }
  double operator[](std::size_t i) const { return data()[i]; }
  std::span<double> span() { return {data(), count_}; }
  std::span<const double> span() const { return {data(), count_}; }

 private:
  std::vector<double> storage_;
  std::size_t begin_ = 0, count_ = 0;
};

/// Arrays of one move of all sliders, each padded.
struct SliderMove {
  const double* v;        ///< where the sliders' slopes are before the move
  const double* sparse;   ///< half width of the dead zone around no change, >= 0
  const double* inverse;  ///< 1 / stiffness, > 0
  const double* low;      ///< limits of the change
  const double* high;
  double* dv;     ///< B' dy
  double* moved;  ///< out: v + step dv
  double* x;      ///< out: the sliders' changes there
  double* slope;  ///< out: `inverse` where the slider is free, 0 where a limit or the dead zone holds it
};

struct DenseKernels {
  /// dv = B' dy (with dy null: dv as it is), moved = v + step dv, x = clip((moved - clip(moved, +-sparse)) inverse, low, high), out = B x. `sums` is work
  /// space of 16 #R.
  void (*move_sliders)(const double* panels, int rows, int padded_sliders, const double* dy, double step,
                       const SliderMove& move, double* sums, double* out);
  /// Lower triangle, column-major with leading dimension `stride`, of A A' for A of `rows` x `width` stored by rows of
  /// `row_stride` (multiples of 8, zeros behind the width).
  void (*multiply_by_transpose)(const double* a, int rows, int row_stride, double* lower, int stride);
  /// y[i] += factor x[i]
  void (*add_scaled)(double* y, const double* x, double factor, int count);
  /// y[i] -= sum of four factor[k] x[k stride + i]
  void (*subtract_four)(double* y, const double* x, int stride, const double* factors, int count);
  /// sum of x[i] y[i]
  double (*dot)(const double* x, const double* y, int count);
  /// (l, x) <- ((l + s x) / c, c x - s l'), the step of a Cholesky update; `sign` -1 makes it a downdate's.
  void (*rotate)(double* l, double* x, double c, double s, double sign, int count);
};

/// The best kernels for this processor.
const DenseKernels& dense_kernels();

/// The kernels of one instruction set, for tests: 0 any processor, 1 AVX2, 2 AVX-512; nullptr if it does not run here.
const DenseKernels* dense_kernels_of(int level);

}  // namespace mien::detail
