#pragma once
/// A character's vertices, shapes and skin weights packed into the blocks that the kernels run through.

#include <cstdint>
#include <vector>

#include "mien/character/character.h"
#include "mien/evaluate/detail/compile_objects.h"
#include "mien/evaluate/detail/compile_wires.h"
#include "mien/evaluate/detail/joint_chain.h"
#include "mien/evaluate/detail/kernel.h"
#include "mien/evaluate/detail/lines.h"

namespace mien::detail {

/// The blocks of one part.
struct PartBlocks {
  std::size_t begin = 0, end = 0;
  BlockSkin skin = BlockSkin::none;
};

struct Blocks {
  std::vector<PartBlocks> parts;
  std::size_t vertex_count = 0;
  std::vector<std::size_t> first_row;  // parts + 1
  Lines<float> neutral;
  std::vector<std::uint32_t> shape_begin{0};
  std::vector<std::uint16_t> shapes;
  Lines<float> deltas;
  Lines<std::int16_t> compact;
  std::vector<float> scales;  // by shape: what a compact delta of 1 means; empty: exact
  std::vector<std::uint64_t> shape_bits;
  std::size_t words = 0;  // of shape_bits a block
  std::vector<std::uint32_t> joint_begin{0};
  std::vector<std::uint16_t> joints;
  Lines<float> joint_weights;  // 16 a joint entry but a block's first
  std::vector<std::uint16_t>
      pivots;  // 16 a block of a dual quaternion skin: the carrier of the largest weight
  WireBlocks wires;
  ObjectBlocks objects;
  std::vector<std::int32_t> row;           // 16 a block
  std::vector<std::uint32_t> lane_of_row;  // 16 block + lane
  std::vector<std::uint8_t> in_a_row;
  std::size_t count() const { return in_a_row.size(); }
  BlockData view() const;
};

/// `vertices` as EvaluatorOptions has them. `chain` receives the carriers; one past its last means the identity.
///   throws  invalid_input: vertices that do not exist or come twice, more shapes or carriers than 65,535
Blocks compile_blocks(const Character& character, const std::vector<std::vector<int>>& vertices,
                      bool is_compact, const WireRows& wire_rows, const ObjectRows& object_rows,
                      JointChain& chain);

}  // namespace mien::detail
