// Two registers are one Lanes: 12 of the 16 hold two frames of a bake.
#include "mien/evaluate/detail/kernel.h"

#if defined(__x86_64__)
#include <immintrin.h>

#define MIEN_TARGET __attribute__((target("avx2,fma,popcnt,bmi")))
#define MIEN_OPERATION static inline __attribute__((always_inline)) MIEN_TARGET

namespace mien::detail {
namespace {

struct Lanes {
  __m256 a, b;
};

constexpr bool has_many_registers = false;

MIEN_OPERATION Lanes load(const float* from) {
  return {_mm256_loadu_ps(from), _mm256_loadu_ps(from + 8)};
}
MIEN_OPERATION __m256 load8(const std::int16_t* from) {
  return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
MIEN_OPERATION Lanes load(const std::int16_t* from) {
  return {load8(from), load8(from + 8)};
}
MIEN_OPERATION Lanes all(float value) {
  return {_mm256_set1_ps(value), _mm256_set1_ps(value)};
}
MIEN_OPERATION Lanes add(Lanes p, Lanes q) {
  return {_mm256_add_ps(p.a, q.a), _mm256_add_ps(p.b, q.b)};
}
MIEN_OPERATION Lanes subtract(Lanes p, Lanes q) {
  return {_mm256_sub_ps(p.a, q.a), _mm256_sub_ps(p.b, q.b)};
}
MIEN_OPERATION Lanes multiply(Lanes p, Lanes q) {
  return {_mm256_mul_ps(p.a, q.a), _mm256_mul_ps(p.b, q.b)};
}
MIEN_OPERATION Lanes divide(Lanes p, Lanes q) {
  return {_mm256_div_ps(p.a, q.a), _mm256_div_ps(p.b, q.b)};
}
MIEN_OPERATION Lanes multiply_add(Lanes p, Lanes q, Lanes r) {
  return {_mm256_fmadd_ps(p.a, q.a, r.a), _mm256_fmadd_ps(p.b, q.b, r.b)};
}
MIEN_OPERATION Lanes multiply_subtract(Lanes p, Lanes q, Lanes r) {
  return {_mm256_fmsub_ps(p.a, q.a, r.a), _mm256_fmsub_ps(p.b, q.b, r.b)};
}
MIEN_OPERATION Lanes multiply_subtract_from(Lanes p, Lanes q, Lanes r) {
  return {_mm256_fnmadd_ps(p.a, q.a, r.a), _mm256_fnmadd_ps(p.b, q.b, r.b)};
}
MIEN_OPERATION void store(float* to, Lanes p) {
  _mm256_storeu_ps(to, p.a);
  _mm256_storeu_ps(to + 8, p.b);
}
MIEN_OPERATION void stream(float* to, Lanes p) {
  _mm256_stream_ps(to, p.a);
  _mm256_stream_ps(to + 8, p.b);
}
MIEN_OPERATION void stream_end() {
  _mm_sfence();
}

/// Eight vertices: with each register in the order that the rotation of three wants, blends pick every third lane.
MIEN_OPERATION void store_interleaved8(float* to, __m256 x, __m256 y, __m256 z) {
  const __m256 xs = _mm256_permutevar8x32_ps(x, _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5));
  const __m256 ys = _mm256_permutevar8x32_ps(y, _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2));
  const __m256 zs = _mm256_permutevar8x32_ps(z, _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7));
  _mm256_storeu_ps(to, _mm256_blend_ps(_mm256_blend_ps(xs, ys, 0b10010010), zs, 0b00100100));
  _mm256_storeu_ps(to + 8, _mm256_blend_ps(_mm256_blend_ps(xs, ys, 0b00100100), zs, 0b01001001));
  _mm256_storeu_ps(to + 16, _mm256_blend_ps(_mm256_blend_ps(xs, ys, 0b01001001), zs, 0b10010010));
}
MIEN_OPERATION void store_interleaved(float* to, Lanes x, Lanes y, Lanes z) {
  store_interleaved8(to, x.a, y.a, z.a);
  store_interleaved8(to + 24, x.b, y.b, z.b);
}

#include "mien/evaluate/detail/kernel_body.h"

}  // namespace

const Kernel avx2_kernel{evaluate, bake, copy_rows};

}  // namespace mien::detail
#endif
