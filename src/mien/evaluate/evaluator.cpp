// What an evaluation costs is reading: deltas stream through once, so they lie in the order in which they are needed, 16
// vertices at a time, and a block lists only the shapes that move it. Skinning happens while the block is in registers.
// Roads tried are in docs/evaluate.md with their times.
#include "mien/evaluate/evaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/evaluate/detail/check_pose.h"
#include "mien/evaluate/detail/compile_blocks.h"
#include "mien/evaluate/detail/frame.h"

namespace mien {

using detail::bake_width;
using detail::block_floats;
using detail::BlockRun;
using detail::BlockSkin;
using detail::Frame;
using detail::lane_count;
using detail::PartBlocks;

struct Evaluator::Compiled : detail::CompiledCharacter {
  Compiled(const Character& character, const EvaluatorOptions& options)
      : CompiledCharacter(character, options.vertices, options.precision == DeltaPrecision::compact) {}
  InstructionSet instructions = InstructionSet::plain;
  const detail::Kernel* kernel = nullptr;
};

namespace {

std::size_t most_joints(const detail::Blocks& blocks) {
  std::size_t most = 0;
  for (std::size_t b = 0; b < blocks.count(); ++b)
    most = std::max<std::size_t>(most, blocks.joint_begin[b + 1] - blocks.joint_begin[b]);
  return most;
}

}  // namespace

struct Evaluator::State {
  explicit State(const Compiled& compiled)
      : now(compiled),
        before(now),
        moved(now.carrier_count()),
        moved_wires(static_cast<std::size_t>(compiled.wire_rows.wire_count())),
        moved_objects(static_cast<std::size_t>(compiled.object_rows.object_count())) {
    turned_weights.reserve(lane_count * most_joints(compiled.blocks));
    changed.reserve(compiled.blocks.words);
  }
  Frame now, before;
  bool has_before = false;
  std::vector<float> turned_weights;     // of one block
  std::vector<std::uint64_t> changed;    // bits of the shapes that changed on one part
  std::vector<char> moved, moved_wires;  // by carrier, by wire
  std::vector<char> moved_objects;       // of one part
};

namespace {

const detail::Kernel* kernel_of(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512) return &detail::avx512_kernel;
  if (set == InstructionSet::avx2) return &detail::avx2_kernel;
#endif
  return set == InstructionSet::plain ? &detail::plain_kernel : nullptr;
}

InstructionSet best_supported() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (is_supported(set)) return set;
  return InstructionSet::plain;
}

/// The blocks of one part.
BlockRun run_of(const detail::Blocks& blocks, std::size_t part) {
  BlockRun run;
  run.begin = blocks.parts[part].begin;
  run.end = blocks.parts[part].end;
  run.skin = blocks.parts[part].skin;
  run.to_part = blocks.wires.is_in_model_space[part] ? nullptr : blocks.wires.to_part[part].data();
  if (!blocks.objects.is_in_model_space[part]) {
    run.object_to_model = blocks.objects.to_model[part].data();
    run.object_to_part = blocks.objects.to_part[part].data();
  }
  run.row = blocks.row.data();
  run.in_a_row = blocks.in_a_row.data();
  return run;
}

void check_size(std::size_t got, std::size_t wanted) {
  if (got != wanted)
    throw invalid_input("output", "holds " + std::to_string(got) + " numbers", std::to_string(wanted));
}

}  // namespace

bool is_supported(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (set == InstructionSet::avx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("popcnt") && __builtin_cpu_supports("bmi");
#endif
  return set == InstructionSet::plain || set == InstructionSet::best;
}

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::best:
      return "best";
    case InstructionSet::plain:
      return "plain";
    case InstructionSet::avx2:
      return "AVX2";
    case InstructionSet::avx512:
      return "AVX-512";
  }
  return "";
}

Evaluator::Evaluator(const Character& character, const EvaluatorOptions& options) {
  require_valid(character);
  if (!is_supported(options.instructions))
    throw invalid_input("instruction set",
                        std::string(name_of(options.instructions)) + " does not run on this machine", "best");
  auto compiled = std::make_shared<Compiled>(character, options);
  compiled->instructions =
      options.instructions == InstructionSet::best ? best_supported() : options.instructions;
  compiled->kernel = kernel_of(compiled->instructions);
  compiled_ = compiled;
  state_ = std::make_unique<State>(*compiled);
}

Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;
Evaluator::Evaluator(const Evaluator& other)
    : compiled_(other.compiled_), state_(std::make_unique<State>(*other.state_)) {}
Evaluator& Evaluator::operator=(const Evaluator& other) {
  return *this = Evaluator(other);
}

std::size_t Evaluator::vertex_count() const {
  return compiled_->blocks.vertex_count;
}

std::size_t Evaluator::first_row(std::size_t part) const {
  return compiled_->blocks.first_row.at(part);
}

InstructionSet Evaluator::instructions() const {
  return compiled_->instructions;
}

std::size_t Evaluator::block_count() const {
  return compiled_->blocks.count();
}

std::span<const std::int32_t> Evaluator::lane_rows() const {
  return compiled_->blocks.row;
}

void Evaluator::evaluate(const Pose& pose, std::span<float> positions) {
  check_size(positions.size(), 3 * vertex_count());
  run(pose, nullptr, positions.data(), false);
}

std::size_t Evaluator::update(const Pose& pose, std::span<float> positions) {
  check_size(positions.size(), 3 * vertex_count());
  return run(pose, nullptr, positions.data(), true);
}

void Evaluator::evaluate_blocks(const Pose& pose, std::span<float> blocks) {
  check_size(blocks.size(), block_floats * block_count());
  run(pose, blocks.data(), nullptr, false);
}

std::size_t Evaluator::update_blocks(const Pose& pose, std::span<float> blocks) {
  check_size(blocks.size(), block_floats * block_count());
  return run(pose, blocks.data(), nullptr, true);
}

/// Runs the blocks of one part: all, or those that a change can move; those with opposite quaternions one by one.
class Evaluator::PartRun {
 public:
  PartRun(const Compiled& compiled, State& state, std::size_t part, float* blocks, float* rows)
      : blocks_(compiled.blocks),
        kernel_(*compiled.kernel),
        state_(state),
        out_(run_of(compiled.blocks, part)),
        data_(blocks_.view()),
        frame_(state.now.data(part)),
        part_(blocks_.parts[part]) {
    out_.blocks = blocks;
    out_.rows = rows;
  }

  std::size_t all() {
    if (part_.skin != BlockSkin::dual_quaternion || !state_.now.has_twist())
      return run(part_.begin, part_.end);
    return where([](std::size_t) { return true; });
  }

  void twisted() {
    for (std::size_t b = part_.begin; b < part_.end; ++b)
      if (state_.now.is_twisted(blocks_, b)) run_twisted(b);
  }

  std::size_t changed(const Compiled& compiled, std::size_t part) {
    state_.now.changed_shapes(state_.before, part, state_.changed);
    for (std::size_t o = 0; o < state_.moved_objects.size(); ++o)
      state_.moved_objects[o] = state_.now.has_object_moved(state_.before, compiled.object_rows, part, o);
    return where([this](std::size_t b) { return is_changed(b); });
  }

 private:
  bool is_changed(std::size_t b) const {
    for (std::size_t w = 0; w < blocks_.words; ++w)
      if (blocks_.shape_bits[blocks_.words * b + w] & state_.changed[w]) return true;
    for (std::size_t e = blocks_.joint_begin[b]; e < blocks_.joint_begin[b + 1]; ++e)
      if (state_.moved[blocks_.joints[e]]) return true;
    for (std::size_t e = blocks_.wires.begin[b]; e < blocks_.wires.begin[b + 1]; ++e)
      if (state_.moved_wires[blocks_.wires.entries[e].wire]) return true;
    for (std::size_t e = blocks_.objects.begin[b]; e < blocks_.objects.begin[b + 1]; ++e)
      if (state_.moved_objects[blocks_.objects.entries[e].object]) return true;
    return false;
  }

  /// The chosen blocks, in runs as long as may be.
  template <class Choose>
  std::size_t where(const Choose& is_chosen) {
    std::size_t count = 0, begin = part_.begin;
    for (std::size_t b = part_.begin; b < part_.end; ++b) {
      const bool is_twisted = part_.skin == BlockSkin::dual_quaternion && state_.now.is_twisted(blocks_, b);
      if (is_chosen(b) && !is_twisted) continue;
      count += run(begin, b);
      begin = b + 1;
      if (is_twisted && is_chosen(b)) count += run_twisted(b);
    }
    return count + run(begin, part_.end);
  }

  std::size_t run(std::size_t begin, std::size_t end) {
    out_.begin = begin;
    out_.end = end;
    if (begin < end) kernel_.evaluate(data_, frame_, out_);
    return end - begin;
  }

  std::size_t run_twisted(std::size_t b) {
    state_.now.turn_weights(blocks_, b, state_.turned_weights);
    frame_.turned_weights = state_.turned_weights.data();
    const std::size_t count = run(b, b + 1);
    frame_.turned_weights = nullptr;
    return count;
  }

  const detail::Blocks& blocks_;
  const detail::Kernel& kernel_;
  State& state_;
  BlockRun out_;
  detail::BlockData data_;
  detail::FrameData frame_;
  PartBlocks part_;
};

///   returns  how many blocks were computed
std::size_t Evaluator::run(const Pose& pose, float* blocks, float* rows, bool only_changes) {
  const Compiled& compiled = *compiled_;
  State& state = *state_;
  const bool can_keep = only_changes && state.has_before;
  if (can_keep) std::swap(state.now, state.before);
  state.has_before = false;  // should the pose be refused
  state.now.set(compiled, pose);
  if (can_keep) {
    for (std::size_t c = 0; c < state.moved.size(); ++c)
      state.moved[c] = state.now.has_moved(state.before, c);
    for (std::size_t w = 0; w < state.moved_wires.size(); ++w)
      state.moved_wires[w] = state.now.has_wire_moved(state.before, compiled.wire_rows, w);
  }
  std::size_t count = 0;
  for (std::size_t p = 0; p < compiled.blocks.parts.size(); ++p) {
    PartRun part(compiled, state, p, blocks, rows);
    count += can_keep ? part.changed(compiled, p) : part.all();
  }
  state.has_before = true;
  return count;
}

namespace {

/// The frames of one group, side by side.
struct Group {
  std::vector<Frame> frames;
  std::vector<float> coefficients;  // bake_width a shape
  std::vector<std::uint64_t> active;
  std::array<detail::FrameData, bake_width> data;
  std::size_t frame_floats;
  std::unique_ptr<float[]> memory;  // positions of all lanes, frame after frame, and one float more
  std::array<float*, bake_width> lanes{};

  Group(const detail::Blocks& blocks, const Frame& frame, bool has_memory)
      : frames(bake_width, frame),
        coefficients(bake_width * frame.shape_count()),
        active(blocks.words),
        frame_floats(block_floats * blocks.count()),
        memory(has_memory ? std::make_unique_for_overwrite<float[]>(bake_width * frame_floats + 1)
                          : nullptr) {}

  /// Where frame `f` is written: to the group's memory when it has any.
  void place(std::size_t f, bool is_wanted, float* frame) {
    lanes[f] = !is_wanted ? nullptr : memory ? memory.get() + f * frame_floats : frame;
  }

  /// Lays part `part`'s coefficients side by side, of the first `count` frames.
  void lay_out(std::size_t part, std::size_t count) {
    std::fill(coefficients.begin(), coefficients.end(), 0.f);
    std::fill(active.begin(), active.end(), 0);
    for (std::size_t f = 0; f < bake_width; ++f) {
      data[f] = frames[std::min(f, count - 1)].data(part);
      for (std::size_t s = 0; s < coefficients.size() / bake_width; ++s)
        if (const float c = data[f].coefficients[s]; c != 0) {
          coefficients[bake_width * s + f] = c;
          active[s / 64] |= std::uint64_t{1} << (s % 64);
        }
    }
  }

  detail::BakeFrames view() const {
    const bool on_lines = reinterpret_cast<std::uintptr_t>(lanes[0]) % 64 == 0;
    return {coefficients.data(), active.data(),       data.data(),
            lanes.data(),        !memory && on_lines, memory != nullptr};
  }
};

}  // namespace

/// The blocks of `frame` whose quaternions need signs, once more.
void Evaluator::run_twisted(const Compiled& compiled, State& state, Frame& frame, float* blocks,
                            float* rows) {
  std::swap(state.now, frame);
  for (std::size_t p = 0; p < compiled.blocks.parts.size(); ++p)
    if (compiled.blocks.parts[p].skin == BlockSkin::dual_quaternion)
      PartRun(compiled, state, p, blocks, rows).twisted();
  std::swap(state.now, frame);
}

// Eight frames go through a block together: its deltas are read and converted once for all of them, and their 24
// accumulators fill the registers of AVX-512. Frames in the order of the file are written block by block to memory that
// stays in the caches and copied from there row by row: scattered straight into frames that do not fit the caches, every
// line was fetched and written several times (twice the time). Blocks whose quaternions need signs are done again.
void Evaluator::bake_groups(std::span<const Pose> poses, float* frames, bool as_rows) const {
  const Compiled& compiled = *compiled_;
  const std::size_t size = as_rows ? 3 * vertex_count() : block_floats * block_count();
  const std::size_t groups = (poses.size() + bake_width - 1) / bake_width;
  // Few long ranges: each has memory of its own, which has to be found and touched first.
  const std::size_t grain = std::max<std::size_t>(1, groups / (4 * static_cast<std::size_t>(thread_count())));
  parallel_for(groups, grain, [&](std::size_t begin, std::size_t end) {
    State state(compiled);
    Group group(compiled.blocks, state.now, as_rows);
    for (std::size_t first = bake_width * begin; first < std::min(bake_width * end, poses.size());
         first += bake_width) {
      const std::size_t count = std::min(bake_width, poses.size() - first);
      for (std::size_t f = 0; f < bake_width; ++f) {
        if (f < count) group.frames[f].set(compiled, poses[first + f]);
        group.place(f, f < count, frames + (first + f) * size);
      }
      for (std::size_t p = 0; p < compiled.blocks.parts.size(); ++p) {
        group.lay_out(p, count);
        compiled.kernel->bake(compiled.blocks.view(), group.view(), run_of(compiled.blocks, p));
      }
      for (std::size_t f = 0; f < count; ++f) {
        float* frame = frames + (first + f) * size;
        if (as_rows)
          compiled.kernel->copy_rows(group.lanes[f], compiled.blocks.lane_of_row.data(), vertex_count(),
                                     frame);
        if (group.frames[f].has_twist())
          run_twisted(compiled, state, group.frames[f], as_rows ? nullptr : frame, as_rows ? frame : nullptr);
      }
    }
  });
}

void Evaluator::bake(std::span<const Pose> poses, std::span<float> frames) const {
  check_size(frames.size(), poses.size() * 3 * vertex_count());
  if (vertex_count() > 0) bake_groups(poses, frames.data(), true);
}

void Evaluator::bake_blocks(std::span<const Pose> poses, std::span<float> frames) const {
  check_size(frames.size(), poses.size() * block_floats * block_count());
  bake_groups(poses, frames.data(), false);
}

double Evaluator::compact_error(const ShapeWeights& weights) const {
  const detail::Blocks& blocks = compiled_->blocks;
  if (weights.values.size() != static_cast<Eigen::Index>(compiled_->outline.shapes.size()))
    throw invalid_input("shape weights", "number " + std::to_string(weights.values.size()),
                        std::to_string(compiled_->outline.shapes.size()) + ", one a shape");
  double most = 0;
  for (std::size_t b = 0; b < blocks.count() && !blocks.scales.empty(); ++b) {
    double sum = 0;
    for (std::size_t e = blocks.shape_begin[b]; e < blocks.shape_begin[b + 1]; ++e)
      sum += std::abs(weights.values[blocks.shapes[e]]) * blocks.scales[blocks.shapes[e]] / 2;
    most = std::max(most, sum);
  }
  return most;
}

std::size_t Evaluator::bytes() const {
  const detail::Blocks& b = compiled_->blocks;
  const std::size_t floats = b.neutral.size() + b.deltas.size() + b.joint_weights.size() +
                             b.wires.weights.size() + b.wires.arms.size() + b.objects.weights.size();
  const std::size_t indices = b.shape_begin.size() + b.joint_begin.size() + b.wires.begin.size() +
                              b.wires.rows.size() + b.objects.begin.size() + b.objects.rows.size();
  return 4 * (floats + indices) + 2 * (b.compact.size() + b.shapes.size() + b.joints.size()) +
         8 * b.shape_bits.size() + sizeof(detail::WireEntry) * b.wires.entries.size() +
         sizeof(detail::ObjectEntry) * b.objects.entries.size();
}

}  // namespace mien
