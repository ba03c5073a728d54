#pragma once
/// NumPy's file of one array.

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace mien {

/// Writes float32 numbers in C order, little-endian, version 1.0 of the format.
///   shape   its product is the number of values
///   throws  invalid_input: it is not; io: cannot be written
void write_npy(std::span<const float> values, const std::vector<std::size_t>& shape,
               const std::filesystem::path& path);

}  // namespace mien
