#include "mien/pose/detail/cholesky.h"

#include <algorithm>
#include <cmath>

namespace mien::detail {

void Cholesky::reserve(int size) {
  if (size <= reserved_) return;
  reserved_ = size;
  stride_ = (size + 7) / 8 * 8;
  lower_.resize(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(size));
}

double* Cholesky::lower(int size) {
  reserve(size);
  size_ = size;
  return lower_.data();
}

// Left-looking: each column takes away what the columns before it contribute, four at a time.
bool Cholesky::factor() {
  const DenseKernels& kernels = dense_kernels();
  double* const l = lower_.data();
  for (int k = 0; k < size_; ++k) {
    double* const column = l + static_cast<std::size_t>(k) * stride_;
    const double diagonal = column[k];
    int p = 0;
    for (; p + 4 <= k; p += 4) {
      const double* from = l + static_cast<std::size_t>(p) * stride_ + k;
      const double factors[4] = {from[0], from[stride_], from[2 * stride_], from[3 * stride_]};
      kernels.subtract_four(column + k, from, stride_, factors, size_ - k);
    }
    for (; p < k; ++p) {
      const double* from = l + static_cast<std::size_t>(p) * stride_ + k;
      kernels.add_scaled(column + k, from, -from[0], size_ - k);
    }
    if (!(column[k] > 1e-15 * diagonal)) return false;
    const double root = std::sqrt(column[k]);
    column[k] = root;
    for (int i = k + 1; i < size_; ++i) column[i] /= root;
  }
  return true;
}

bool Cholesky::update(double* vectors, std::span<const double> signs) {
  const DenseKernels& kernels = dense_kernels();
  for (int k = 0; k < size_; ++k) {
    double* const column = lower_.data() + static_cast<std::size_t>(k) * stride_;
    double* b = vectors;
    for (const double sign : signs) {
      if (b[k] != 0) {
        const double old = column[k], square = old * old + sign * b[k] * b[k];
        if (!(square > 1e-14 * old * old)) return false;
        const double root = std::sqrt(square), c = root / old, s = b[k] / old;
        column[k] = root;
        kernels.rotate(column + k + 1, b + k + 1, c, s, sign, size_ - k - 1);
      }
      b += size_;
    }
  }
  return true;
}

void Cholesky::solve(double* b) const {
  const DenseKernels& kernels = dense_kernels();
  const double* const l = lower_.data();
  const auto column = [&](int k) { return l + static_cast<std::size_t>(k) * stride_; };
  int k = 0;
  for (; k + 8 <= size_; k += 4) {  // four columns a pass: their own triangle first
    for (int i = 0; i < 4; ++i) {
      b[k + i] /= column(k + i)[k + i];
      for (int r = i + 1; r < 4; ++r) b[k + r] -= column(k + i)[k + r] * b[k + i];
    }
    kernels.subtract_four(b + k + 4, column(k) + k + 4, stride_, b + k, size_ - k - 4);
  }
  for (; k < size_; ++k) {
    b[k] /= column(k)[k];
    for (int r = k + 1; r < size_; ++r) b[r] -= column(k)[r] * b[k];
  }
  for (k = size_ - 1; k >= 0; --k) {
    double sum = 0;
    const int below = size_ - k - 1;
    if (below < 8)
      for (int r = k + 1; r < size_; ++r) sum += column(k)[r] * b[r];
    else
      sum = kernels.dot(column(k) + k + 1, b + k + 1, below);
    b[k] = (b[k] - sum) / column(k)[k];
  }
}

}  // namespace mien::detail
