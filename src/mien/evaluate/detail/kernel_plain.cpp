// For any machine: loops over 16 floats, as the compiler vectorises them.
#include "mien/evaluate/detail/kernel.h"

#define MIEN_TARGET

namespace mien::detail {
namespace {

struct Lanes {
  float v[lane_count];
};

constexpr bool has_many_registers = false;

template <class Number>
inline Lanes load(const Number* from) {
  Lanes a;
  for (std::size_t l = 0; l < lane_count; ++l) a.v[l] = static_cast<float>(from[l]);
  return a;
}
inline Lanes all(float value) {
  Lanes a;
  for (float& lane : a.v) lane = value;
  return a;
}
inline Lanes add(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = a.v[l] + b.v[l];
  return r;
}
inline Lanes subtract(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = a.v[l] - b.v[l];
  return r;
}
inline Lanes multiply(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = a.v[l] * b.v[l];
  return r;
}
inline Lanes divide(const Lanes& a, const Lanes& b) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = a.v[l] / b.v[l];
  return r;
}
inline Lanes multiply_add(const Lanes& a, const Lanes& b, const Lanes& c) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = a.v[l] * b.v[l] + c.v[l];
  return r;
}
inline Lanes multiply_subtract(const Lanes& a, const Lanes& b, const Lanes& c) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = a.v[l] * b.v[l] - c.v[l];
  return r;
}
inline Lanes multiply_subtract_from(const Lanes& a, const Lanes& b, const Lanes& c) {
  Lanes r;
  for (std::size_t l = 0; l < lane_count; ++l) r.v[l] = c.v[l] - a.v[l] * b.v[l];
  return r;
}
inline void store(float* to, const Lanes& a) {
  for (std::size_t l = 0; l < lane_count; ++l) to[l] = a.v[l];
}
inline void stream(float* to, const Lanes& a) {
  store(to, a);
}
inline void stream_end() {}
inline void store_interleaved(float* to, const Lanes& x, const Lanes& y, const Lanes& z) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    to[3 * l] = x.v[l];
    to[3 * l + 1] = y.v[l];
    to[3 * l + 2] = z.v[l];
  }
}

#include "mien/evaluate/detail/kernel_body.h"

}  // namespace

const Kernel plain_kernel{evaluate, bake, copy_rows};

}  // namespace mien::detail
