#pragma once
/// An order of vertices in which neighbours are moved by nearly the same shapes and joints.

#include <cstdint>
#include <vector>

namespace mien::detail {

/// One set of bits a vertex, `words` words each.
struct BitSets {
  std::size_t words = 0;
  std::vector<std::uint64_t> bits;
  BitSets(std::size_t count, std::size_t bit_count) : words(bit_count / 64 + 1), bits(count * words, 0) {}
  void set(std::size_t row, std::size_t bit) {
    bits[row * words + bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  std::size_t count() const { return bits.size() / words; }
};

/// The rows of `sets` sorted along a Gray code, so that sets of consecutive rows differ in few bits; equal sets keep
/// their order. Of several choices of which bits lead, the one whose runs of `run` rows have the smallest unions is taken.
///   cost  one hash a row, and a sort of the distinct sets
std::vector<int> gray_order(const BitSets& sets, std::size_t bit_count, std::size_t run);

}  // namespace mien::detail
