// Plain C++ over the compiler's vector type: each body is inlined into one function an instruction set, so that the same
// text becomes AVX-512, AVX2 and SSE2 code. No Eigen here: its inline functions must not be compiled for other sets.
#include "mien/pose/detail/dense_kernels.h"

#include <algorithm>

namespace mien::detail {
namespace {

using V = double __attribute__((vector_size(64)));

#define MIEN_INLINE inline __attribute__((always_inline))

MIEN_INLINE void load(V& v, const double* p) {
  __builtin_memcpy(&v, p, sizeof v);
}
MIEN_INLINE void store(double* p, const V& v) {
  __builtin_memcpy(p, &v, sizeof v);
}
MIEN_INLINE double sum(const V& v) {
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/// What clipping makes of one vector of sliders.
MIEN_INLINE V settle(const V& moved, const SliderMove& move, int j, V& slope) {
  V sparse, inverse, low, high;
  load(sparse, move.sparse + j);
  load(inverse, move.inverse + j);
  load(low, move.low + j);
  load(high, move.high + j);
  const V beyond = moved > sparse ? moved - sparse : (moved < -sparse ? moved + sparse : V{});
  const V wish = beyond * inverse;
  const auto dead = (moved < sparse) & (moved > -sparse);
  const auto free = (wish > low) & (wish < high) & ~dead;
  slope = free ? inverse : V{};
  const V raised = wish > low ? wish : low;
  return raised < high ? raised : high;
}

MIEN_INLINE void move_sliders_body(const double* panels, int rows, int padded_sliders, const double* dy,
                                   double step, const SliderMove& move, double* sums, double* out) {
  for (int i = 0; i < 16 * rows; ++i) sums[i] = 0;
  for (int j = 0; j < padded_sliders; j += panel_width) {
    const double* b = panels + static_cast<std::size_t>(j) * rows;
    V d0{}, d1{}, e0{}, e1{}, p, q, s, t;
    int r = dy ? 0 : rows;
    if (!dy) {
      load(d0, move.dv + j);
      load(d1, move.dv + j + 8);
    }
    for (; r + 1 < rows; r += 2) {
      load(p, b + 16 * r);
      load(q, b + 16 * r + 8);
      load(s, b + 16 * r + 16);
      load(t, b + 16 * r + 24);
      d0 += p * dy[r];
      d1 += q * dy[r];
      e0 += s * dy[r + 1];
      e1 += t * dy[r + 1];
    }
    if (r < rows) {
      load(p, b + 16 * r);
      load(q, b + 16 * r + 8);
      d0 += p * dy[r];
      d1 += q * dy[r];
    }
    V v0, v1, slope0, slope1;
    load(v0, move.v + j);
    load(v1, move.v + j + 8);
    d0 += e0;
    d1 += e1;
    v0 += d0 * step;
    v1 += d1 * step;
    const V x0 = settle(v0, move, j, slope0), x1 = settle(v1, move, j + 8, slope1);
    store(move.dv + j, d0);
    store(move.dv + j + 8, d1);
    store(move.moved + j, v0);
    store(move.moved + j + 8, v1);
    store(move.x + j, x0);
    store(move.x + j + 8, x1);
    store(move.slope + j, slope0);
    store(move.slope + j + 8, slope1);
    for (r = 0; r < rows; ++r) {
      load(p, b + 16 * r);
      load(q, b + 16 * r + 8);
      load(s, sums + 16 * r);
      load(t, sums + 16 * r + 8);
      s += p * x0;
      t += q * x1;
      store(sums + 16 * r, s);
      store(sums + 16 * r + 8, t);
    }
  }
  for (int r = 0; r < rows; ++r) {
    V s, t;
    load(s, sums + 16 * r);
    load(t, sums + 16 * r + 8);
    s += t;
    out[r] = sum(s);
  }
}

/// One block of up to 4 x 4 entries.
template <int N, int M>
MIEN_INLINE void multiply_block(const double* a, const double* b, int row_stride, double* lower, int stride) {
  V sums[N][M];
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < M; ++j) sums[i][j] = V{};
  for (int c = 0; c < row_stride; c += 8) {
    V left[N], right[M];
    for (int i = 0; i < N; ++i) load(left[i], a + static_cast<std::size_t>(i) * row_stride + c);
    for (int j = 0; j < M; ++j) load(right[j], b + static_cast<std::size_t>(j) * row_stride + c);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < M; ++j) sums[i][j] += left[i] * right[j];
  }
  for (int j = 0; j < M; ++j)
    for (int i = 0; i < N; ++i) lower[static_cast<std::size_t>(j) * stride + i] = sum(sums[i][j]);
}

MIEN_INLINE void multiply_by_transpose_body(const double* a, int rows, int row_stride, double* lower,
                                            int stride) {
  const auto row = [&](int r) { return a + static_cast<std::size_t>(r) * row_stride; };
  const auto entry = [&](int r, int c) { return lower + static_cast<std::size_t>(c) * stride + r; };
  const int whole = rows / 4 * 4;
  for (int c = 0; c < whole; c += 4) {
    int r = c;
    for (; r < whole; r += 4) multiply_block<4, 4>(row(r), row(c), row_stride, entry(r, c), stride);
    for (; r < rows; ++r) multiply_block<1, 4>(row(r), row(c), row_stride, entry(r, c), stride);
  }
  for (int c = whole; c < rows; ++c)
    for (int r = c; r < rows; ++r) multiply_block<1, 1>(row(r), row(c), row_stride, entry(r, c), stride);
}

MIEN_INLINE void add_scaled_body(double* y, const double* x, double factor, int count) {
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    V p, q;
    load(p, y + i);
    load(q, x + i);
    p += q * factor;
    store(y + i, p);
  }
  for (; i < count; ++i) y[i] += factor * x[i];
}

MIEN_INLINE void subtract_four_body(double* y, const double* x, int stride, const double* factors,
                                    int count) {
  const double *x1 = x + stride, *x2 = x1 + stride, *x3 = x2 + stride;
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    V p, a, b, c, d;
    load(p, y + i);
    load(a, x + i);
    load(b, x1 + i);
    load(c, x2 + i);
    load(d, x3 + i);
    p -= (a * factors[0] + b * factors[1]) + (c * factors[2] + d * factors[3]);
    store(y + i, p);
  }
  for (; i < count; ++i)
    y[i] -= (x[i] * factors[0] + x1[i] * factors[1]) + (x2[i] * factors[2] + x3[i] * factors[3]);
}

MIEN_INLINE double dot_body(const double* x, const double* y, int count) {
  V s{}, t{};
  int i = 0;
  for (; i + 16 <= count; i += 16) {
    V a, b, c, d;
    load(a, x + i);
    load(b, y + i);
    load(c, x + i + 8);
    load(d, y + i + 8);
    s += a * b;
    t += c * d;
  }
  double rest = 0;
  for (; i < count; ++i) rest += x[i] * y[i];
  s += t;
  return sum(s) + rest;
}

MIEN_INLINE void rotate_body(double* l, double* x, double c, double s, double sign, int count) {
  const double inverse = 1 / c, signed_s = sign * s;
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    V p, q;
    load(p, l + i);
    load(q, x + i);
    p = (p + q * signed_s) * inverse;
    q = q * c - p * s;
    store(l + i, p);
    store(x + i, q);
  }
  for (; i < count; ++i) {
    l[i] = (l[i] + signed_s * x[i]) * inverse;
    x[i] = c * x[i] - s * l[i];
  }
}

// One set of functions an instruction set. `TARGET` is an attribute or nothing.
#define MIEN_KERNELS(NAME, TARGET)                                                                   \
  TARGET void move_sliders_##NAME(const double* panels, int rows, int sliders, const double* dy,     \
                                  double step, const SliderMove& move, double* sums, double* out) {  \
    move_sliders_body(panels, rows, sliders, dy, step, move, sums, out);                             \
  }                                                                                                  \
  TARGET void multiply_by_transpose_##NAME(const double* a, int rows, int row_stride, double* lower, \
                                           int stride) {                                             \
    multiply_by_transpose_body(a, rows, row_stride, lower, stride);                                  \
  }                                                                                                  \
  TARGET void add_scaled_##NAME(double* y, const double* x, double factor, int count) {              \
    add_scaled_body(y, x, factor, count);                                                            \
  }                                                                                                  \
  TARGET void subtract_four_##NAME(double* y, const double* x, int stride, const double* factors,    \
                                   int count) {                                                      \
    subtract_four_body(y, x, stride, factors, count);                                                \
  }                                                                                                  \
  TARGET double dot_##NAME(const double* x, const double* y, int count) {                            \
    return dot_body(x, y, count);                                                                    \
  }                                                                                                  \
  TARGET void rotate_##NAME(double* l, double* x, double c, double s, double sign, int count) {      \
    rotate_body(l, x, c, s, sign, count);                                                            \
  }                                                                                                  \
  const DenseKernels kernels_##NAME = {move_sliders_##NAME, multiply_by_transpose_##NAME,            \
                                       add_scaled_##NAME,   subtract_four_##NAME,                    \
                                       dot_##NAME,          rotate_##NAME};

#if defined(__x86_64__)
MIEN_KERNELS(avx512, __attribute__((target("avx512f,avx512dq,avx512vl,fma"))))
MIEN_KERNELS(avx2, __attribute__((target("avx2,fma"))))
#endif
MIEN_KERNELS(any, )

}  // namespace

const DenseKernels* dense_kernels_of(int level) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (level == 2)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl")
               ? &kernels_avx512
               : nullptr;
  if (level == 1)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &kernels_avx2 : nullptr;
#endif
  return level == 0 ? &kernels_any : nullptr;
}

const DenseKernels& dense_kernels() {
  static const DenseKernels* const best = [] {
    for (const int level : {2, 1})
      if (const DenseKernels* kernels = dense_kernels_of(level)) return kernels;
    return dense_kernels_of(0);
  }();
  return *best;
}

}  // namespace mien::detail
