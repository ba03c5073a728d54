#pragma once
/// The inner loops of the normal equations, compiled for AVX-512, for AVX2 and for any processor; the best ones that run here
/// are chosen once.

#include <cstddef>
#include <span>
#include <utility>

#include "mien/deform/wires.h"

namespace mien::detail {

/// One entry of a field as a row of the system: four control points' basis, then (r, C_0 r, C_1 r, C_2 r, C_3 r) and a zero, all times the
/// root of the vertex weight.
struct WireRow {
  double basis[4];
  double coupled[16];
};

/// Sums of products of the rows of two wires (or of one with itself), over the vertices that both reach.
struct WireBlock {
  double* coupled;  ///< 16 x 16: coupled of the first by coupled of the second
  double *controls_first,
      *controls_second;  ///< #control points x 16: basis of the one by coupled of the other
  double* controls;      ///< #control points of the first x `stride`: basis by basis
  std::ptrdiff_t stride;
};

/// Which rows belong together.
struct WirePair {
  int first = 0, second = 0;
};

/// Where a right-hand side gathers: x of four control points, or turns, that meet at a vertex, then y, then z.
struct alignas(32) WireSpan {
  double x[4] = {}, y[4] = {}, z[4] = {};
};
/// Which spans are a wire's.
struct WireSlots {
  int controls = 0;  ///< the span of its first four control points; the next one begins a control point later
  int turns = -1;    ///< the same of its turns; -1: it does not turn
};
struct WireSums {
  WireSpan* spans;
  double* sigmas;  ///< one a wire
};

struct WireKernels {
  /// Adds the products of the pairs to the block; `firsts`: first control point of each row.
  void (*add_products)(const WireRow* rows, const short* firsts, std::span<const WirePair> pairs,
                       const WireBlock& block);
  /// For each entry of one vertex: B d to the span of its control points, r . d to its wire's sigma, C (r x d) to the span of its turns.
  void (*add_right)(std::span<const WireField::Entry> entries, const WireSlots* slots,
                    const double* displacement, const WireSums& sums);
};

const WireKernels& wire_kernels();

}  // namespace mien::detail
