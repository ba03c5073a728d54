#pragma once
/// A Cholesky factor L L' that follows its matrix when a multiple of b b' is added or taken away.

#include <span>

#include "mien/pose/detail/dense_kernels.h"

namespace mien::detail {

class Cholesky {
 public:
  /// Room for matrices up to `size`; allocates only when it grows.
  void reserve(int size);
  int size() const { return size_; }
  /// The lower triangle (column-major, leading dimension `stride()`) to be filled in before `factor`.
  double* lower(int size);
  int stride() const { return stride_; }
  /// Turns the filled-in triangle into its factor. False: it is not positive definite.
  bool factor();
  /// L L' + sum of sign_i b_i b_i', each sign 1 or -1; `vectors` holds the b_i one after the other, size() each, and is
  /// overwritten. False: a difference is not positive definite, and the factor is lost. Cost: 2 n^2 multiplications each; they
  /// go column by column together, so that one waits for its square root while others work.
  bool update(double* vectors, std::span<const double> signs);
  /// b <- (L L')^-1 b
  void solve(double* b) const;

 private:
  AlignedVector lower_;
  int size_ = 0, stride_ = 0, reserved_ = 0;
};

}  // namespace mien::detail
