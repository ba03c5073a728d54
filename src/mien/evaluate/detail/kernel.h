#pragma once
/// The inner loops of the Evaluator: plain data in, blocks of 16 vertices out, one build for each instruction set.
///
/// A block holds its vertices as 16 x, 16 y, 16 z. Its shapes and its joints are lists of its own: an entry of a shape is
/// 48 deltas, an entry of a joint 16 skin weights, in the same lanes as the vertices. Weights sum to one: those of a block's
/// first joint are what the others leave and are not stored.

#include <cstddef>
#include <cstdint>

namespace mien::detail {

inline constexpr std::size_t lane_count = 16;
inline constexpr std::size_t block_floats = 3 * lane_count;
inline constexpr std::size_t bake_width = 8;  ///< frames that a bake takes through one block together

enum class BlockSkin : std::uint8_t { none, linear, dual_quaternion };

/// One wire in one block. It moves each lane by
///   sum of weight x row over its control points + (scale + (sum of weight x row over its turns) x) arm
struct WireEntry {
  std::uint32_t wire = 0;
  std::uint32_t begin = 0, turns = 0, end = 0;  // weight entries: of control points, then of turns
};

/// Views of what `compile_wires` packed.
struct WireData {
  const std::uint32_t* begin = nullptr;  // blocks + 1
  const WireEntry* entries = nullptr;    // of a block ascending by wire
  const std::uint32_t* rows = nullptr;   // by weight entry: which row of FrameData::wire_rows
  const float* weights = nullptr;        // 16 a weight entry
  const float* arms = nullptr;           // block_floats an entry
};

/// One influence object in one block. It moves each lane by
///   sum of weight x row over its control points, or, a cluster or locator, by weight x (F x - x)
struct ObjectEntry {
  std::uint32_t object = 0;
  std::uint32_t begin = 0, end = 0;  // weight entries; of a frame one
  bool is_frame = false;
};

/// Views of what `compile_objects` packed.
struct ObjectData {
  const std::uint32_t* begin = nullptr;  // blocks + 1
  const ObjectEntry* entries = nullptr;  // of a block ascending by object
  const std::uint32_t* rows = nullptr;   // by weight entry: which row of FrameData::object_rows
  const float* weights = nullptr;        // 16 a weight entry
};

/// Views of what `compile_blocks` packed. Entries of block b are [begin[b], begin[b + 1]).
struct BlockData {
  const float* neutral = nullptr;              // block_floats a block
  const std::uint32_t* shape_begin = nullptr;  // blocks + 1
  const std::uint16_t* shapes = nullptr;       // by shape entry, ascending in a block
  const float* deltas = nullptr;               // block_floats a shape entry, or
  const std::int16_t* compact = nullptr;       // the same as multiples of the shape's scale
  const std::uint64_t* shape_bits = nullptr;   // `words` a block: which shapes it lists
  std::size_t words = 0;
  const std::uint32_t* joint_begin = nullptr;  // blocks + 1; every block has an entry
  const std::uint16_t* joints = nullptr;       // carrier by joint entry
  const float* joint_weights = nullptr;        // 16 a joint entry but a block's first
  WireData wires;
  ObjectData objects;
};

/// One pose as the kernels want it.
struct FrameData {
  const float* coefficients = nullptr;    // by shape: shape weight, times the scale of compact deltas
  const std::uint64_t* active = nullptr;  // bits of the shapes that count; null: all
  const float* matrices = nullptr;        // 12 a carrier: rows of 4
  const float* rigid = nullptr;           // 8 a carrier: real x, y, z, w, dual x, y, z, w
  const float* stretches = nullptr;       // 9 a carrier by rows; null: none stretches
  const float* wire_rows = nullptr;       // 3 a row; null: no wire moves
  const float* wire_scales = nullptr;     // by wire
  const char* is_moving = nullptr;        // by wire
  const char* object_moves = nullptr;     // by object; null: none moves
  const float* object_rows = nullptr;     // 3 a row
  const float* object_frames = nullptr;   // 12 an object: rows of 4 of F - 1
  /// Of the one block asked for, 16 a joint entry: skin weights, those with a minus that count the other quaternion of the
  /// two that are one rotation; null: BlockData's.
  const float* turned_weights = nullptr;
};

/// A run of blocks with one kind of skin, and where their vertices go.
struct BlockRun {
  std::size_t begin = 0, end = 0;
  BlockSkin skin = BlockSkin::none;
  const float* to_part = nullptr;  // 9 by rows: what wires add, to the part's space; null: the same
  const float* object_to_model =
      nullptr;  // 12, rows of 4: the part's space to that of objects; null: the same
  const float* object_to_part = nullptr;   // 9 by rows: what objects add, to the part's space
  float* blocks = nullptr;                 // block b goes to blocks + block_floats b; or, when null,
  float* rows = nullptr;                   // lane l of block b goes to rows + 3 row[16 b + l],
  const std::int32_t* row = nullptr;       // -1: nowhere
  const std::uint8_t* in_a_row = nullptr;  // by block: its 16 rows follow one another
};

/// `bake_width` frames at once: coefficients are bake_width a shape, the union of active shapes is taken.
struct BakeFrames {
  const float* coefficients = nullptr;  // bake_width a shape
  const std::uint64_t* active = nullptr;
  const FrameData* frames = nullptr;  // bake_width
  float* const* lanes = nullptr;      // bake_width: where a frame's blocks go; null: it is not wanted
  bool stream = false;                // past the caches: `lanes` begin on cache lines
  bool interleave = false;            // a block as 16 x y z instead of 16 x, 16 y, 16 z
};

struct Kernel {
  void (*evaluate)(const BlockData&, const FrameData&, const BlockRun&);
  void (*bake)(const BlockData&, const BakeFrames&, const BlockRun&);
  /// Row r of `rows` is lane lane_of_row[r] of `lanes` (3 floats each; one float past the last is read), past the caches.
  void (*copy_rows)(const float* lanes, const std::uint32_t* lane_of_row, std::size_t count, float* rows);
};

extern const Kernel plain_kernel;
#if defined(__x86_64__)
extern const Kernel avx2_kernel;    // AVX2 and FMA
extern const Kernel avx512_kernel;  // AVX-512 F, BW, DQ, VL
#endif

}  // namespace mien::detail
