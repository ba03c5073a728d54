// Plain C++ over the compiler's vector types: each body is inlined into one function an instruction set, with vectors as wide
// as that set's registers (wider ones would live in memory). No Eigen here: its inline functions must not be compiled for other sets.
#include "mien/pose/detail/dense_kernels.h"

#include <algorithm>

namespace mien::detail {
namespace {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

#define MIEN_INLINE inline __attribute__((always_inline))

template <typename V>
constexpr int lanes = static_cast<int>(sizeof(V) / sizeof(double));

template <typename V>
MIEN_INLINE void load(V& v, const double* p) {
  __builtin_memcpy(&v, p, sizeof v);
}
template <typename V>
MIEN_INLINE void store(double* p, const V& v) {
  __builtin_memcpy(p, &v, sizeof v);
}
template <typename V>
MIEN_INLINE double sum(const V& v) {
  if constexpr (lanes<V> == 8)
    return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
  else if constexpr (lanes<V> == 4)
    return (v[0] + v[2]) + (v[1] + v[3]);
  else
    return v[0] + v[1];
}

/// What clipping makes of one panel of sliders. Plain loops over copies: the compiler turns these comparisons into vector
/// ones, but takes its own vector type's apart.
MIEN_INLINE void settle(const SliderMove& move, int j) {
  double v[panel_width], sparse[panel_width], inverse[panel_width], low[panel_width], high[panel_width];
  double x[panel_width], slope[panel_width];
  __builtin_memcpy(v, move.moved + j, sizeof v);
  __builtin_memcpy(sparse, move.sparse + j, sizeof sparse);
  __builtin_memcpy(inverse, move.inverse + j, sizeof inverse);
  __builtin_memcpy(low, move.low + j, sizeof low);
  __builtin_memcpy(high, move.high + j, sizeof high);
  for (int i = 0; i < panel_width; ++i) {
    const double above = v[i] > -sparse[i] ? v[i] : -sparse[i];
    const double inside = above < sparse[i] ? above : sparse[i];
    const double wish = (v[i] - inside) * inverse[i];
    const double raised = wish > low[i] ? wish : low[i];
    x[i] = raised < high[i] ? raised : high[i];
    // In the dead zone `inside` is v itself; on its edge, and without one, the slider is free.
    const bool dead = (v[i] < sparse[i]) & (v[i] > -sparse[i]);
    const bool free = (wish > low[i]) & (wish < high[i]) & !dead;
    slope[i] = free ? inverse[i] : 0.0;
  }
  __builtin_memcpy(move.x + j, x, sizeof x);
  __builtin_memcpy(move.slope + j, slope, sizeof slope);
}

template <typename V>
MIEN_INLINE void move_sliders_body(const double* panels, int rows, int padded_sliders, const double* dy,
                                   double step, const SliderMove& move, double* sums, double* out) {
  constexpr int n = panel_width / lanes<V>;
  for (int i = 0; i < panel_width * rows; ++i) sums[i] = 0;
  for (int j = 0; j < padded_sliders; j += panel_width) {
    const double* b = panels + static_cast<std::size_t>(j) * rows;
    V d[n], e[n], p, q;
    for (int k = 0; k < n; ++k) {
      e[k] = V{};
      if (dy)
        d[k] = V{};
      else
        load(d[k], move.dv + j + k * lanes<V>);
    }
    int r = dy ? 0 : rows;
    for (; r + 1 < rows; r += 2) {
      const V y0 = V{} + dy[r], y1 = V{} + dy[r + 1];
      for (int k = 0; k < n; ++k) {
        load(p, b + panel_width * r + k * lanes<V>);
        load(q, b + panel_width * (r + 1) + k * lanes<V>);
        d[k] += p * y0;
        e[k] += q * y1;
      }
    }
    for (int k = 0; k < n; ++k) {
      if (r < rows) {
        load(p, b + panel_width * r + k * lanes<V>);
        d[k] += p * dy[r];
      }
      d[k] += e[k];
      store(move.dv + j + k * lanes<V>, d[k]);
      load(q, move.v + j + k * lanes<V>);
      q += d[k] * step;
      store(move.moved + j + k * lanes<V>, q);
    }
    settle(move, j);
    V x[n];
    for (int k = 0; k < n; ++k) load(x[k], move.x + j + k * lanes<V>);
    for (r = 0; r < rows; ++r)
      for (int k = 0; k < n; ++k) {
        load(p, b + panel_width * r + k * lanes<V>);
        load(q, sums + panel_width * r + k * lanes<V>);
        q += p * x[k];
        store(sums + panel_width * r + k * lanes<V>, q);
      }
  }
  for (int r = 0; r < rows; ++r) {
    V total{}, p;
    for (int k = 0; k < n; ++k) {
      load(p, sums + panel_width * r + k * lanes<V>);
      total += p;
    }
    out[r] = sum(total);
  }
}

/// One block of up to 4 x 4 entries.
template <typename V, int N, int M>
MIEN_INLINE void multiply_block(const double* a, const double* b, int row_stride, double* lower, int stride) {
  V sums[N][M];
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < M; ++j) sums[i][j] = V{};
  for (int c = 0; c < row_stride; c += lanes<V>) {
    V left[N], right[M];
    for (int i = 0; i < N; ++i) load(left[i], a + static_cast<std::size_t>(i) * row_stride + c);
    for (int j = 0; j < M; ++j) load(right[j], b + static_cast<std::size_t>(j) * row_stride + c);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < M; ++j) sums[i][j] += left[i] * right[j];
  }
  for (int j = 0; j < M; ++j)
    for (int i = 0; i < N; ++i) lower[static_cast<std::size_t>(j) * stride + i] = sum(sums[i][j]);
}

template <typename V>
MIEN_INLINE void multiply_by_transpose_body(const double* a, int rows, int row_stride, double* lower,
                                            int stride) {
  const auto row = [&](int r) { return a + static_cast<std::size_t>(r) * row_stride; };
  const auto entry = [&](int r, int c) { return lower + static_cast<std::size_t>(c) * stride + r; };
  const int whole = rows / 4 * 4;
  for (int c = 0; c < whole; c += 4) {
    int r = c;
    for (; r < whole; r += 4) multiply_block<V, 4, 4>(row(r), row(c), row_stride, entry(r, c), stride);
    for (; r < rows; ++r) multiply_block<V, 1, 4>(row(r), row(c), row_stride, entry(r, c), stride);
  }
  for (int c = whole; c < rows; ++c)
    for (int r = c; r < rows; ++r) multiply_block<V, 1, 1>(row(r), row(c), row_stride, entry(r, c), stride);
}

template <typename V>
MIEN_INLINE void add_scaled_body(double* y, const double* x, double factor, int count) {
  int i = 0;
  for (; i + lanes<V> <= count; i += lanes<V>) {
    V p, q;
    load(p, y + i);
    load(q, x + i);
    p += q * factor;
    store(y + i, p);
  }
  for (; i < count; ++i) y[i] += factor * x[i];
}

template <typename V>
MIEN_INLINE void subtract_four_body(double* y, const double* x, int stride, const double* factors,
                                    int count) {
  const double *x1 = x + stride, *x2 = x1 + stride, *x3 = x2 + stride;
  int i = 0;
  for (; i + lanes<V> <= count; i += lanes<V>) {
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

template <typename V>
MIEN_INLINE double dot_body(const double* x, const double* y, int count) {
  V s{}, t{};
  int i = 0;
  for (; i + 2 * lanes<V> <= count; i += 2 * lanes<V>) {
    V a, b, c, d;
    load(a, x + i);
    load(b, y + i);
    load(c, x + i + lanes<V>);
    load(d, y + i + lanes<V>);
    s += a * b;
    t += c * d;
  }
  double rest = 0;
  for (; i < count; ++i) rest += x[i] * y[i];
  s += t;
  return sum(s) + rest;
}

template <typename V>
MIEN_INLINE void rotate_body(double* l, double* x, double c, double s, double sign, int count) {
  const double inverse = 1 / c, signed_s = sign * s;
  int i = 0;
  for (; i + lanes<V> <= count; i += lanes<V>) {
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
#define MIEN_KERNELS(NAME, V, TARGET)                                                                \
  TARGET void move_sliders_##NAME(const double* panels, int rows, int sliders, const double* dy,     \
                                  double step, const SliderMove& move, double* sums, double* out) {  \
    move_sliders_body<V>(panels, rows, sliders, dy, step, move, sums, out);                          \
  }                                                                                                  \
  TARGET void multiply_by_transpose_##NAME(const double* a, int rows, int row_stride, double* lower, \
                                           int stride) {                                             \
    multiply_by_transpose_body<V>(a, rows, row_stride, lower, stride);                               \
  }                                                                                                  \
  TARGET void add_scaled_##NAME(double* y, const double* x, double factor, int count) {              \
    add_scaled_body<V>(y, x, factor, count);                                                         \
  }                                                                                                  \
  TARGET void subtract_four_##NAME(double* y, const double* x, int stride, const double* factors,    \
                                   int count) {                                                      \
    subtract_four_body<V>(y, x, stride, factors, count);                                             \
  }                                                                                                  \
  TARGET double dot_##NAME(const double* x, const double* y, int count) {                            \
    return dot_body<V>(x, y, count);                                                                 \
  }                                                                                                  \
  TARGET void rotate_##NAME(double* l, double* x, double c, double s, double sign, int count) {      \
    rotate_body<V>(l, x, c, s, sign, count);                                                         \
  }                                                                                                  \
  const DenseKernels kernels_##NAME = {move_sliders_##NAME, multiply_by_transpose_##NAME,            \
                                       add_scaled_##NAME,   subtract_four_##NAME,                    \
                                       dot_##NAME,          rotate_##NAME};

#if defined(__x86_64__)
MIEN_KERNELS(avx512, Eight, __attribute__((target("avx512f,avx512dq,avx512vl,fma"))))
MIEN_KERNELS(avx2, Four, __attribute__((target("avx2,fma"))))
#endif
MIEN_KERNELS(any, Two, )

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
