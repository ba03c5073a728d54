#pragma once
/// Indices into lists: vertices, joints and shapes are counted in int, lists of the standard library in std::size_t.

#include <cstddef>

namespace mien::detail {

inline std::size_t at(std::ptrdiff_t index) {
  return static_cast<std::size_t>(index);
}

}  // namespace mien::detail
