#pragma once
/// A character compiled for speed: pose in, all vertices out, into memory of the caller's, without allocation or lock.
///
/// The editable Character and `evaluate` say what is right; the Evaluator says the same in single precision, tens of times
/// faster (docs/evaluate.md has the table). It does not follow the character's changes.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien {
namespace detail {
class Frame;
}

/// How deltas are stored: as floats, or as 16-bit multiples of a step of their shape's own (half the memory, and speed is
/// memory). `Evaluator::compact_error` bounds what the steps cost.
enum class DeltaPrecision { exact, compact };

/// AVX-512 and AVX2 give the same bytes; plain code differs by the rounding of a fused multiply-add, within
/// `evaluator_tolerance`.
enum class InstructionSet { best, plain, avx2, avx512 };

/// Whether this machine runs it.
bool is_supported(InstructionSet set);
const char* name_of(InstructionSet set);

/// Evaluator against `evaluate`, of the largest coordinate involved (neutral, posed, joint), for exact deltas.
inline constexpr double evaluator_tolerance = 4e-6;

struct EvaluatorOptions {
  DeltaPrecision precision = DeltaPrecision::exact;
  InstructionSet instructions = InstructionSet::best;
  /// Per part, the vertices wanted, each once, in the order wanted; empty: all of all parts. What a solver or a pin needs.
  std::vector<std::vector<int>> vertices;
};

/// One thread at a time uses an evaluator; copies share what was compiled, so that each thread takes a copy.
class Evaluator {
 public:
  ///   throws  invalid_input: what `validate` finds; a vertex that does not exist or is asked for twice; more than 65,535
  ///           shapes or joints; an instruction set that this machine does not run
  ///   cost    linear in all deltas, and a sort of the vertices
  explicit Evaluator(const Character& character, const EvaluatorOptions& options = {});
  ~Evaluator();
  Evaluator(const Evaluator&);
  Evaluator& operator=(const Evaluator&);
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;

  /// Vertices of all parts, one part after the other in file order (or as the options chose).
  std::size_t vertex_count() const;
  /// First row of part `part`; of the number of parts: vertex_count().
  std::size_t first_row(std::size_t part) const;
  InstructionSet instructions() const;

  /// All positions, model space.
  ///   positions  3 x vertex_count(), row after row in the order of the file
  ///   throws     invalid_input: as `evaluate`; a span of another size
  void evaluate(const Pose& pose, std::span<float> positions);

  /// The same, of the vertices that a change since the last pose can have moved; others keep what `positions` holds, which
  /// the call before has written. The first call writes all.
  ///   returns  how many blocks of 16 vertices were computed
  std::size_t update(const Pose& pose, std::span<float> positions);

  /// The evaluator's own order, fastest to write: blocks of 16 vertices, each 16 x, 16 y, 16 z.
  std::size_t block_count() const;
  /// Row of each lane in the order of the file, 16 a block; -1: padding.
  std::span<const std::int32_t> lane_rows() const;
  ///   blocks  48 x block_count()
  void evaluate_blocks(const Pose& pose, std::span<float> blocks);
  std::size_t update_blocks(const Pose& pose, std::span<float> blocks);

  /// All poses on all cores, several through each block at once: what one `evaluate` after the other gives, byte for byte.
  ///   frames   poses.size() x 3 x vertex_count()
  ///   throws   as `evaluate`
  void bake(std::span<const Pose> poses, std::span<float> frames) const;

  /// The same in the evaluator's own order: poses.size() x 48 x block_count(). Half the time of `bake`, when `frames` begins
  /// on a cache line of 64 bytes.
  void bake_blocks(std::span<const Pose> poses, std::span<float> frames) const;

  /// No coordinate departs from the exact deltas' by more than this before skinning: half a step of every shape of a
  /// vertex times its weight, of the vertex for which that is most. 0 for exact deltas.
  double compact_error(const ShapeWeights& weights) const;

  /// Bytes that one evaluation of everything reads.
  std::size_t bytes() const;

 private:
  struct Compiled;
  struct State;
  class PartRun;
  static void run_twisted(const Compiled& compiled, State& state, detail::Frame& frame, float* blocks,
                          float* rows);
  void bake_groups(std::span<const Pose> poses, float* frames, bool as_rows) const;
  std::size_t run(const Pose& pose, float* blocks, float* rows, bool only_changes);
  std::shared_ptr<const Compiled> compiled_;
  std::unique_ptr<State> state_;
};

}  // namespace mien
