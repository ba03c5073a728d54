// One register is one Lanes: 24 of the 32 hold eight frames of a bake.
#include "mien/evaluate/detail/kernel.h"

#if defined(__x86_64__)
#include <immintrin.h>

// GCC 12 takes the undefined upper operands of its own intrinsics for a mistake.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#define MIEN_TARGET __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,fma,popcnt,bmi")))
#define MIEN_OPERATION static inline __attribute__((always_inline)) MIEN_TARGET

namespace mien::detail {
namespace {

using Lanes = __m512;

constexpr bool has_many_registers = true;

MIEN_OPERATION Lanes load(const float* from) {
  return _mm512_loadu_ps(from);
}
MIEN_OPERATION Lanes load(const std::int16_t* from) {
  return _mm512_cvtepi32_ps(
      _mm512_cvtepi16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))));
}
MIEN_OPERATION Lanes all(float value) {
  return _mm512_set1_ps(value);
}
MIEN_OPERATION Lanes add(Lanes a, Lanes b) {
  return _mm512_add_ps(a, b);
}
MIEN_OPERATION Lanes subtract(Lanes a, Lanes b) {
  return _mm512_sub_ps(a, b);
}
MIEN_OPERATION Lanes multiply(Lanes a, Lanes b) {
  return _mm512_mul_ps(a, b);
}
MIEN_OPERATION Lanes divide(Lanes a, Lanes b) {
  return _mm512_div_ps(a, b);
}
MIEN_OPERATION Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
  return _mm512_fmadd_ps(a, b, c);
}
MIEN_OPERATION Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) {
  return _mm512_fmsub_ps(a, b, c);
}
MIEN_OPERATION Lanes multiply_subtract_from(Lanes a, Lanes b, Lanes c) {
  return _mm512_fnmadd_ps(a, b, c);
}
MIEN_OPERATION void store(float* to, Lanes a) {
  _mm512_storeu_ps(to, a);
}
MIEN_OPERATION void stream(float* to, Lanes a) {
  _mm512_stream_ps(to, a);
}
MIEN_OPERATION void stream_end() {
  _mm_sfence();
}

/// Lane i of the k-th register of x0 y0 z0 x1 y1 z1 ... is coordinate (16 k + i) % 3 of vertex (16 k + i) / 3: indices
/// below 16 choose from the first of two registers, those from 16 on from the second.
MIEN_OPERATION void store_interleaved(float* to, Lanes x, Lanes y, Lanes z) {
  const __m512i xy0 = _mm512_setr_epi32(0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5);
  const __m512i z0 = _mm512_setr_epi32(0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
  const __m512i xy1 = _mm512_setr_epi32(21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26);
  const __m512i z1 = _mm512_setr_epi32(0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
  const __m512i xy2 = _mm512_setr_epi32(0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0);
  const __m512i z2 = _mm512_setr_epi32(26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
  store(to, _mm512_permutex2var_ps(_mm512_permutex2var_ps(x, xy0, y), z0, z));
  store(to + 16, _mm512_permutex2var_ps(_mm512_permutex2var_ps(x, xy1, y), z1, z));
  store(to + 32, _mm512_permutex2var_ps(_mm512_permutex2var_ps(x, xy2, y), z2, z));
}

#include "mien/evaluate/detail/kernel_body.h"

}  // namespace

const Kernel avx512_kernel{evaluate, bake, copy_rows};

}  // namespace mien::detail
#endif
