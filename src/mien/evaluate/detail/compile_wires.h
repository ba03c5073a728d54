#pragma once
/// A character's wires packed into the blocks that the kernels run through.

#include <array>
#include <span>
#include <vector>

#include "mien/evaluate/detail/kernel.h"
#include "mien/evaluate/detail/lines.h"
#include "mien/evaluate/detail/wire_motion.h"

namespace mien::detail {

struct WireBlocks {
  std::vector<std::uint32_t> begin{0};        // blocks + 1
  std::vector<WireEntry> entries;             // of a block ascending by wire
  std::vector<std::uint32_t> rows;            // by weight entry: of WireRows
  Lines<float> weights;                       // 16 a weight entry
  Lines<float> arms;                          // block_floats an entry
  std::vector<std::array<float, 9>> to_part;  // by part: model space vectors to its own space, by rows
  std::vector<char> is_in_model_space;        // by part: to_part is the identity
  WireData view() const;
};

/// Takes blocks one after the other.
class WirePacker {
 public:
  ///   throws  invalid_input: as WireField
  WirePacker(const Character& character, const WireRows& layout);

  const WireRows& layout() const { return layout_; }
  /// What the wires do to one vertex; nothing mostly.
  std::span<const WireField::Entry> entries_of(std::size_t part, int vertex) const;
  void add_block(std::size_t part, std::span<const int> vertices);
  WireBlocks take() { return std::move(blocks_); }

 private:
  void add_wire(int wire, std::span<const std::span<const WireField::Entry>> lanes);
  void add_rows(int wire, bool is_turn, std::span<const std::span<const WireField::Entry>> lanes);

  const WireRows& layout_;
  WireField field_;
  std::vector<std::vector<int>> row_of_vertex_;  // by part, of parts that wires reach; -1: none
  WireBlocks blocks_;
};

}  // namespace mien::detail
