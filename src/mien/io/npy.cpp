#include "mien/io/npy.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "mien/core/error.h"
#include "mien/io/file.h"

namespace mien {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

void write_npy(std::span<const float> values, const std::vector<std::size_t>& shape,
               const std::filesystem::path& path) {
  std::string sizes;
  std::size_t product = 1;
  for (const std::size_t size : shape) {
    product *= size;
    sizes += fmt::format("{}, ", size);
  }
  if (product != values.size())
    throw invalid_input("array", fmt::format("has {} numbers", values.size()),
                        fmt::format("{} for its shape", product));
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}), }}", sizes);
  constexpr std::size_t before = 10, line = 64;  // magic, version, length; the data begin on a multiple of 64
  header.append(line - 1 - (before + header.size()) % line, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::vector<std::uint8_t> bytes{0x93,
                                  'N',
                                  'U',
                                  'M',
                                  'P',
                                  'Y',
                                  1,
                                  0,
                                  static_cast<std::uint8_t>(length & 255),
                                  static_cast<std::uint8_t>(length >> 8)};
  bytes.insert(bytes.end(), header.begin(), header.end());
  const std::size_t at = bytes.size();
  bytes.resize(at + values.size_bytes());
  if (!values.empty()) std::memcpy(bytes.data() + at, values.data(), values.size_bytes());
  write_file_atomically(path, bytes);
}

}  // namespace mien
