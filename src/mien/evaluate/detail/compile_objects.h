#pragma once
/// A character's influence objects packed into the blocks that the kernels run through.

#include <array>
#include <span>
#include <vector>

#include "mien/evaluate/detail/kernel.h"
#include "mien/evaluate/detail/lines.h"
#include "mien/evaluate/detail/object_motion.h"

namespace mien::detail {

struct ObjectBlocks {
  std::vector<std::uint32_t> begin{0};          // blocks + 1
  std::vector<ObjectEntry> entries;             // of a block ascending by object
  std::vector<std::uint32_t> rows;              // by weight entry: of ObjectRows
  Lines<float> weights;                         // 16 a weight entry
  std::vector<std::array<float, 9>> to_part;    // by part: model space vectors to its own space, by rows
  std::vector<std::array<float, 12>> to_model;  // by part: its space to model space, rows of 4
  std::vector<char> is_in_model_space;          // by part: both are the identity
  ObjectData view() const { return {begin.data(), entries.data(), rows.data(), weights.data()}; }
};

/// Takes blocks one after the other.
class ObjectPacker {
 public:
  ObjectPacker(const Character& character, const ObjectRows& layout);

  int object_count() const { return layout_.object_count(); }
  /// The objects that move one vertex, ascending.
  std::vector<int> objects_of(std::size_t part, int vertex) const;
  void add_block(std::size_t part, std::span<const int> vertices);
  ObjectBlocks take() { return std::move(blocks_); }

 private:
  struct Bound {
    int object = 0;
    const InfluenceBinding* binding = nullptr;
  };
  void add_object(const Bound& bound, std::span<const int> vertices);

  const ObjectRows& layout_;
  std::vector<std::vector<Bound>> bound_;  // by part, ascending by object
  ObjectBlocks blocks_;
};

}  // namespace mien::detail
