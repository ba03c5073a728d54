#include "evaluate.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstring>

namespace mien::bench {

using Vector = Eigen::Map<Eigen::VectorXf>;
using ConstVector = Eigen::Map<const Eigen::VectorXf>;
using Matrix34 = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

void eigen_shapes(const float* neutral, const float* deltas, const float* weights, int coordinates,
                  int shapes, float* positions) {
  const Eigen::Map<const Eigen::MatrixXf> all(deltas, coordinates, shapes);
  Vector(positions, coordinates) = ConstVector(neutral, coordinates);
  Vector(positions, coordinates).noalias() += all * ConstVector(weights, shapes);
}

void scatter_shapes(const float* neutral, const SparseShapes& sparse, const float* weights, int vertices,
                    float* positions) {
  std::memcpy(positions, neutral, sizeof(float) * 3 * static_cast<std::size_t>(vertices));
  for (int s = 0; s < sparse.shapes; ++s) {
    const float weight = weights[s];
    if (weight == 0) continue;
    for (int i = sparse.begin[s]; i < sparse.begin[s + 1]; ++i) {
      float* to = positions + 3 * sparse.vertices[i];
      const float* delta = sparse.deltas + 3 * i;
      to[0] += weight * delta[0];
      to[1] += weight * delta[1];
      to[2] += weight * delta[2];
    }
  }
}

void eigen_linear_skin(const float* points, const Influences& influences, const float* matrices, int vertices,
                       float* positions) {
  for (int v = 0; v < vertices; ++v) {
    Matrix34 sum = Matrix34::Zero();
    for (int i = v * influences.count; i < (v + 1) * influences.count; ++i)
      sum += influences.weights[i] * Eigen::Map<const Matrix34>(matrices + 12 * influences.joints[i]);
    const Eigen::Vector3f point = Eigen::Map<const Eigen::Vector3f>(points + 3 * v);
    Eigen::Map<Eigen::Vector3f>(positions + 3 * v) = sum * point.homogeneous();
  }
}

void eigen_dual_quaternion_skin(const float* points, const Influences& influences, const float* quaternions,
                                int vertices, float* positions) {
  using Quaternion = Eigen::Map<const Eigen::Vector4f>;
  for (int v = 0; v < vertices; ++v) {
    Eigen::Vector4f real = Eigen::Vector4f::Zero(), dual = Eigen::Vector4f::Zero();
    const Quaternion pivot(quaternions + 8 * influences.joints[v * influences.count]);
    for (int i = v * influences.count; i < (v + 1) * influences.count; ++i) {
      const float* q = quaternions + 8 * influences.joints[i];
      const float weight = pivot.dot(Quaternion(q)) < 0 ? -influences.weights[i] : influences.weights[i];
      real += weight * Quaternion(q);
      dual += weight * Quaternion(q + 4);
    }
    const float length = real.norm();
    const Eigen::Quaternionf rotation(Eigen::Vector4f(real / length)), shift(Eigen::Vector4f(dual / length));
    const Eigen::Vector3f point = Eigen::Map<const Eigen::Vector3f>(points + 3 * v);
    Eigen::Map<Eigen::Vector3f>(positions + 3 * v) =
        rotation * point + 2 * (shift * rotation.conjugate()).vec();
  }
}

#if defined(__AVX512F__)
typedef float Register __attribute__((vector_size(64), aligned(4)));
#else
typedef float Register __attribute__((vector_size(32), aligned(4)));
#endif

int lanes() {
  return sizeof(Register) / sizeof(float);
}

float read_all(const float* memory, std::int64_t bytes) {
  Register sum[8] = {};
  const char* at = reinterpret_cast<const char*>(memory);
  for (const char* end = at + bytes; at < end; at += sizeof sum)
    for (int k = 0; k < 8; ++k) sum[k] += *reinterpret_cast<const Register*>(at + sizeof(Register) * k);
  for (int k = 1; k < 8; ++k) sum[0] += sum[k];
  return sum[0][0];
}

float multiply_adds(std::int64_t count) {
  Register a{}, b{}, c{}, d{}, e{}, f{}, g{}, h{}, factor{};
  factor += 0.999f;
  for (std::int64_t i = 0; i < count; i += 8) {
    a = a * factor + factor;
    b = b * factor + factor;
    c = c * factor + factor;
    d = d * factor + factor;
    e = e * factor + factor;
    f = f * factor + factor;
    g = g * factor + factor;
    h = h * factor + factor;
    asm volatile("" : "+v"(a), "+v"(b), "+v"(c), "+v"(d), "+v"(e), "+v"(f), "+v"(g), "+v"(h));
  }
  return (a + b + c + d + e + f + g + h)[0];
}

}  // namespace mien::bench
