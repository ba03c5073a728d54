#pragma once
/// What else could evaluate a face: the plain ways, compiled for this machine alone (-march=native).

#include <cstdint>

namespace mien::bench {

/// positions = neutral + deltas weights. `deltas` is coordinates x shapes, one shape after the other.
void eigen_shapes(const float* neutral, const float* deltas, const float* weights, int coordinates,
                  int shapes, float* positions);

/// The same by the list of moved vertices of each shape whose weight is not zero: begin is shapes + 1.
struct SparseShapes {
  const int* begin;
  const int* vertices;
  const float* deltas;
  int shapes;
};
void scatter_shapes(const float* neutral, const SparseShapes& sparse, const float* weights, int vertices,
                    float* positions);

/// `influences` joints and weights a vertex; matrices are 12 floats a joint, rows of 4.
struct Influences {
  const int* joints;
  const float* weights;
  int count;
};
void eigen_linear_skin(const float* points, const Influences& influences, const float* matrices, int vertices,
                       float* positions);
/// Quaternions are 8 floats a joint: real x, y, z, w, dual x, y, z, w.
void eigen_dual_quaternion_skin(const float* points, const Influences& influences, const float* quaternions,
                                int vertices, float* positions);

/// The machine's own limits: bytes of `memory` read once (a multiple of 512), and this many fused multiply-adds of full
/// registers; `lanes` is a register's floats.
float read_all(const float* memory, std::int64_t bytes);
float multiply_adds(std::int64_t count);
int lanes();

}  // namespace mien::bench
