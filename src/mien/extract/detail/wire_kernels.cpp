// The products of two wires' rows fill 15 x 15 numbers a vertex. Summed in registers, three rows at a time over a few dozen vertices that stay in
// the first cache (all fifteen at once with AVX-512), they take a fraction of the time of adding them to a large matrix vertex by vertex.
#include "mien/extract/detail/wire_kernels.h"

#include <algorithm>

namespace mien::detail {
namespace {

using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
using FourFloats = float __attribute__((vector_size(16), aligned(4), may_alias));
using Eight = double __attribute__((vector_size(64), aligned(8), may_alias));

#define MIEN_INLINE inline __attribute__((always_inline))

constexpr std::size_t chunk = 64;  ///< pairs whose rows stay in the first cache

template <typename Vector>
MIEN_INLINE const Vector& at(const double* numbers) {
  return *reinterpret_cast<const Vector*>(numbers);
}
template <typename Vector>
MIEN_INLINE Vector& at(double* numbers) {
  return *reinterpret_cast<Vector*>(numbers);
}

/// `Count` rows of the coupled block: as many as fit the registers.
template <typename Vector, int Count>
MIEN_INLINE void add_coupled(const WireRow* rows, std::span<const WirePair> pairs, int row, double* block) {
  constexpr int width = sizeof(Vector) / sizeof(double), columns = 16 / width;
  Vector sums[Count][columns];
  for (int i = 0; i < Count; ++i)
    for (int j = 0; j < columns; ++j) sums[i][j] = at<Vector>(block + 16 * (row + i) + width * j);
  for (const WirePair& pair : pairs) {
    const double* const a = rows[pair.first].coupled + row;
    const double* const b = rows[pair.second].coupled;
    for (int i = 0; i < Count; ++i)
      for (int j = 0; j < columns; ++j) sums[i][j] += a[i] * at<Vector>(b + width * j);
  }
  for (int i = 0; i < Count; ++i)
    for (int j = 0; j < columns; ++j) at<Vector>(block + 16 * (row + i) + width * j) = sums[i][j];
}

template <typename Vector>
MIEN_INLINE void add_basis(const double* basis, const double* coupled, double* block) {
  constexpr int width = sizeof(Vector) / sizeof(double);
  for (int a = 0; a < 4; ++a)
    for (int j = 0; j < 16; j += width) at<Vector>(block + 16 * a + j) += basis[a] * at<Vector>(coupled + j);
}

template <typename Vector, int Count>
MIEN_INLINE void add_products_body(const WireRow* rows, const short* firsts, std::span<const WirePair> pairs,
                                   const WireBlock& block) {
  for (std::size_t begin = 0; begin < pairs.size(); begin += chunk) {
    const std::span<const WirePair> some = pairs.subspan(begin, std::min(chunk, pairs.size() - begin));
    for (int row = 0; row < 15; row += Count) add_coupled<Vector, Count>(rows, some, row, block.coupled);
    for (const WirePair& pair : some) {
      const WireRow &a = rows[pair.first], &b = rows[pair.second];
      const int first = firsts[pair.first], second = firsts[pair.second];
      add_basis<Vector>(a.basis, b.coupled, block.controls_first + 16L * first);
      add_basis<Vector>(b.basis, a.coupled, block.controls_second + 16L * second);
      double* const controls = block.controls + first * block.stride + second;
      for (int i = 0; i < 4; ++i) at<Four>(controls + i * block.stride) += a.basis[i] * at<Four>(b.basis);
    }
  }
}

MIEN_INLINE Four widened(const float* numbers) {
  return __builtin_convertvector(*reinterpret_cast<const FourFloats*>(numbers), Four);
}

MIEN_INLINE void add_to_span(const Four& basis, double x, double y, double z, WireSpan& span) {
  at<Four>(span.x) += basis * x;
  at<Four>(span.y) += basis * y;
  at<Four>(span.z) += basis * z;
}

MIEN_INLINE void add_right_body(std::span<const WireField::Entry> entries, const WireSlots* slots,
                                const double* displacement, const WireSums& sums) {
  const double x = displacement[0], y = displacement[1], z = displacement[2];
  for (const WireField::Entry& entry : entries) {
    const WireSlots& slot = slots[entry.wire];
    add_to_span(widened(entry.basis), x, y, z, sums.spans[slot.controls + entry.first]);
    const double r0 = entry.offset[0], r1 = entry.offset[1], r2 = entry.offset[2];
    sums.sigmas[entry.wire] += r0 * x + r1 * y + r2 * z;
    if (slot.turns >= 0)
      add_to_span(widened(entry.turn_basis), r1 * z - r2 * y, r2 * x - r0 * z, r0 * y - r1 * x,
                  sums.spans[slot.turns + entry.turn_first]);
  }
}

void add_products(const WireRow* rows, const short* firsts, std::span<const WirePair> pairs,
                  const WireBlock& block) {
  add_products_body<Four, 3>(rows, firsts, pairs, block);
}
void add_right(std::span<const WireField::Entry> entries, const WireSlots* slots, const double* displacement,
               const WireSums& sums) {
  add_right_body(entries, slots, displacement, sums);
}

#ifdef __x86_64__
#define MIEN_AVX2 __attribute__((target("avx2,fma")))
MIEN_AVX2 void add_products_avx2(const WireRow* rows, const short* firsts, std::span<const WirePair> pairs,
                                 const WireBlock& block) {
  add_products_body<Four, 3>(rows, firsts, pairs, block);
}
__attribute__((target("avx512f,avx512dq,avx512vl,fma"))) void add_products_avx512(
    const WireRow* rows, const short* firsts, std::span<const WirePair> pairs, const WireBlock& block) {
  add_products_body<Eight, 15>(rows, firsts, pairs, block);
}
MIEN_AVX2 void add_right_avx2(std::span<const WireField::Entry> entries, const WireSlots* slots,
                              const double* displacement, const WireSums& sums) {
  add_right_body(entries, slots, displacement, sums);
}
#endif

WireKernels best_kernels() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
    return {wide ? add_products_avx512 : add_products_avx2, add_right_avx2};
  }
#endif
  return {add_products, add_right};
}

}  // namespace

const WireKernels& wire_kernels() {
  static const WireKernels kernels = best_kernels();
  return kernels;
}

}  // namespace mien::detail
