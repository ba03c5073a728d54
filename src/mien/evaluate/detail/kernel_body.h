// The body of every kernel, written on `Lanes`: 16 floats. Each kernel_*.cpp defines MIEN_TARGET (the instruction set of
// its functions), Lanes and its operations, and then includes this file inside an anonymous namespace. The order of
// operations on a lane is the same in all of them and in single frames and bakes: where the instruction sets have fused
// multiply-adds, results are equal bit for bit.

#define MIEN_INLINE static inline __attribute__((always_inline)) MIEN_TARGET

struct Lanes3 {
  Lanes x, y, z;
};

MIEN_INLINE void add_entry(const float* deltas, Lanes c, Lanes3& p) {
  p.x = multiply_add(load(deltas), c, p.x);
  p.y = multiply_add(load(deltas + 16), c, p.y);
  p.z = multiply_add(load(deltas + 32), c, p.z);
}

MIEN_INLINE void add_entry(const std::int16_t* deltas, Lanes c, Lanes3& p) {
  p.x = multiply_add(load(deltas), c, p.x);
  p.y = multiply_add(load(deltas + 16), c, p.y);
  p.z = multiply_add(load(deltas + 32), c, p.z);
}

template <class Delta>
MIEN_INLINE void add_all(const BlockData& data, const Delta* deltas, const float* coefficients,
                         std::size_t block, Lanes3& p) {
  const std::uint32_t end = data.shape_begin[block + 1];
  for (std::uint32_t e = data.shape_begin[block]; e < end; ++e)
    add_entry(deltas + std::size_t{block_floats} * e, all(coefficients[data.shapes[e]]), p);
}

template <class Delta>
MIEN_INLINE void add_active(const BlockData& data, const Delta* deltas, const FrameData& frame,
                            std::size_t block, Lanes3& p) {
  const std::uint64_t* bits = data.shape_bits + data.words * block;
  std::uint32_t base = data.shape_begin[block];
  for (std::size_t w = 0; w < data.words; ++w) {
    for (std::uint64_t left = bits[w] & frame.active[w]; left; left &= left - 1) {
      const std::uint64_t below = (left & -left) - 1;
      const std::uint32_t e = base + static_cast<std::uint32_t>(__builtin_popcountll(bits[w] & below));
      add_entry(deltas + std::size_t{block_floats} * e, all(frame.coefficients[data.shapes[e]]), p);
    }
    base += static_cast<std::uint32_t>(__builtin_popcountll(bits[w]));
  }
}

MIEN_INLINE Lanes3 neutral_of(const BlockData& data, std::size_t block) {
  const float* neutral = data.neutral + block_floats * block;
  return {load(neutral), load(neutral + 16), load(neutral + 32)};
}

MIEN_INLINE Lanes3 shaped(const BlockData& data, const FrameData& frame, std::size_t block) {
  Lanes3 p = neutral_of(data, block);
  if (data.compact)
    frame.active ? add_active(data, data.compact, frame, block, p)
                 : add_all(data, data.compact, frame.coefficients, block, p);
  else
    frame.active ? add_active(data, data.deltas, frame, block, p)
                 : add_all(data, data.deltas, frame.coefficients, block, p);
  return p;
}

MIEN_INLINE void add_row(const float* row, Lanes w, Lanes3& sum) {
  sum.x = multiply_add(w, all(row[0]), sum.x);
  sum.y = multiply_add(w, all(row[1]), sum.y);
  sum.z = multiply_add(w, all(row[2]), sum.z);
}

MIEN_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {multiply_subtract(a.y, b.z, multiply(a.z, b.y)), multiply_subtract(a.z, b.x, multiply(a.x, b.z)),
          multiply_subtract(a.x, b.y, multiply(a.y, b.x))};
}

MIEN_INLINE Lanes3 multiplied(const float* matrix, const Lanes3& p) {
  const auto row = [&](const float* m) MIEN_TARGET {
    return multiply_add(all(m[0]), p.x, multiply_add(all(m[1]), p.y, multiply(all(m[2]), p.z)));
  };
  return {row(matrix), row(matrix + 3), row(matrix + 6)};
}

MIEN_INLINE void add_wire(const WireData& wires, const FrameData& frame, std::uint32_t e, Lanes3& sum) {
  const WireEntry& entry = wires.entries[e];
  const float* weights = wires.weights + std::size_t{lane_count} * entry.begin;
  std::uint32_t k = entry.begin;
  for (; k < entry.turns; ++k, weights += lane_count)
    add_row(frame.wire_rows + 3 * wires.rows[k], load(weights), sum);
  const float* at = wires.arms + std::size_t{block_floats} * e;
  const Lanes3 arm{load(at), load(at + 16), load(at + 32)};
  Lanes3 turn{all(0), all(0), all(0)};
  for (; k < entry.end; ++k, weights += lane_count)
    add_row(frame.wire_rows + 3 * wires.rows[k], load(weights), turn);
  const Lanes3 turned = cross(turn, arm);
  const Lanes scale = all(frame.wire_scales[entry.wire]);
  sum = {add(sum.x, multiply_add(scale, arm.x, turned.x)), add(sum.y, multiply_add(scale, arm.y, turned.y)),
         add(sum.z, multiply_add(scale, arm.z, turned.z))};
}

/// What the moving wires add to a block's shaped vertices.
MIEN_INLINE void add_wires(const BlockData& data, const FrameData& frame, const float* to_part,
                           std::size_t block, Lanes3& p) {
  Lanes3 sum{all(0), all(0), all(0)};
  bool is_moved = false;
  for (std::uint32_t e = data.wires.begin[block]; e < data.wires.begin[block + 1]; ++e) {
    if (!frame.is_moving[data.wires.entries[e].wire]) continue;
    add_wire(data.wires, frame, e, sum);
    is_moved = true;
  }
  if (!is_moved) return;
  if (to_part) sum = multiplied(to_part, sum);
  p = {add(p.x, sum.x), add(p.y, sum.y), add(p.z, sum.z)};
}

MIEN_INLINE Lanes row_times(const float* row, const Lanes3& p) {
  return multiply_add(all(row[0]), p.x,
                      multiply_add(all(row[1]), p.y, multiply_add(all(row[2]), p.z, all(row[3]))));
}

MIEN_INLINE void add_weighted(Lanes w, const float* matrix, const Lanes3& p, Lanes3& sum) {
  sum.x = multiply_add(w, row_times(matrix, p), sum.x);
  sum.y = multiply_add(w, row_times(matrix + 4, p), sum.y);
  sum.z = multiply_add(w, row_times(matrix + 8, p), sum.z);
}

MIEN_INLINE void add_object(const ObjectData& objects, const FrameData& frame, const ObjectEntry& entry,
                            const Lanes3& x, Lanes3& sum) {
  const float* weights = objects.weights + std::size_t{lane_count} * entry.begin;
  if (entry.is_frame) return add_weighted(load(weights), frame.object_frames + 12 * entry.object, x, sum);
  for (std::uint32_t k = entry.begin; k < entry.end; ++k, weights += lane_count)
    add_row(frame.object_rows + 3 * objects.rows[k], load(weights), sum);
}

/// What the moving influence objects add to a block's vertices, all of them to where shapes and wires put these.
MIEN_INLINE void add_objects(const BlockData& data, const FrameData& frame, const BlockRun& run,
                             std::size_t block, Lanes3& p) {
  const float* to_model = run.object_to_model;
  const Lanes3 x =
      to_model ? Lanes3{row_times(to_model, p), row_times(to_model + 4, p), row_times(to_model + 8, p)} : p;
  Lanes3 sum{all(0), all(0), all(0)};
  bool is_moved = false;
  for (std::uint32_t e = data.objects.begin[block]; e < data.objects.begin[block + 1]; ++e) {
    const ObjectEntry& entry = data.objects.entries[e];
    if (!frame.object_moves[entry.object]) continue;
    add_object(data.objects, frame, entry, x, sum);
    is_moved = true;
  }
  if (!is_moved) return;
  if (to_model) sum = multiplied(run.object_to_part, sum);
  p = {add(p.x, sum.x), add(p.y, sum.y), add(p.z, sum.z)};
}

/// A block's joints, and the skin weights of all but the first.
struct BlockJoints {
  const std::uint16_t *first, *end;
  const float* weights;
};

MIEN_INLINE BlockJoints joints_of(const BlockData& data, std::size_t block) {
  const std::uint32_t begin = data.joint_begin[block];
  return {data.joints + begin, data.joints + data.joint_begin[block + 1],
          data.joint_weights + lane_count * (begin - block)};
}

/// The skin weights of the first joint.
MIEN_INLINE Lanes first_weights(const BlockJoints& joints) {
  const float* weights = joints.weights;
  Lanes left = all(1);
  for (const std::uint16_t* joint = joints.first + 1; joint < joints.end; ++joint, weights += lane_count)
    left = subtract(left, load(weights));
  return left;
}

/// Blends what the joints make of p: as many multiplications as to blend their matrices, in half the registers, so that
/// one pass over the weights makes all three coordinates.
MIEN_INLINE Lanes3 skinned_linear(const BlockData& data, const FrameData& frame, std::size_t block,
                                  const Lanes3& p) {
  const BlockJoints joints = joints_of(data, block);
  const float* weights = joints.weights;
  Lanes3 sum{all(0), all(0), all(0)};
  Lanes first = all(1);
  for (const std::uint16_t* joint = joints.first + 1; joint < joints.end; ++joint, weights += lane_count) {
    const Lanes w = load(weights);
    first = subtract(first, w);
    add_weighted(w, frame.matrices + 12 * *joint, p, sum);
  }
  add_weighted(first, frame.matrices + 12 * *joints.first, p, sum);
  return sum;
}

MIEN_INLINE void add_stretch(const float* matrix, Lanes w, const Lanes3& p, Lanes3& sum) {
  const Lanes3 q = multiplied(matrix, p);
  sum = {multiply_add(w, q.x, sum.x), multiply_add(w, q.y, sum.y), multiply_add(w, q.z, sum.z)};
}

MIEN_INLINE Lanes3 stretched(const BlockData& data, const FrameData& frame, std::size_t block,
                             const Lanes3& p) {
  const BlockJoints joints = joints_of(data, block);
  const float* weights = joints.weights;
  Lanes3 sum{all(0), all(0), all(0)};
  add_stretch(frame.stretches + 9 * *joints.first, first_weights(joints), p, sum);
  for (const std::uint16_t* joint = joints.first + 1; joint < joints.end; ++joint, weights += lane_count)
    add_stretch(frame.stretches + 9 * *joint, load(weights), p, sum);
  return sum;
}

/// With r and d the blended parts, v the vector part of r: p + 2 (v x (v x p + w p) + w dv - dw v + v x dv) / |r|^2.
MIEN_INLINE Lanes3 moved_rigidly(const Lanes* r, const Lanes* d, const Lanes3& p) {
  const Lanes3 v{r[0], r[1], r[2]}, dv{d[0], d[1], d[2]};
  const Lanes square =
      multiply_add(r[0], r[0], multiply_add(r[1], r[1], multiply_add(r[2], r[2], multiply(r[3], r[3]))));
  const Lanes twice = divide(all(2), square);
  const Lanes3 vp = cross(v, p);
  const Lanes3 inner{multiply_add(r[3], p.x, vp.x), multiply_add(r[3], p.y, vp.y),
                     multiply_add(r[3], p.z, vp.z)};
  const Lanes3 turn = cross(v, inner), shift = cross(v, dv);
  const Lanes x = multiply_add(r[3], dv.x, multiply_subtract_from(d[3], v.x, add(turn.x, shift.x)));
  const Lanes y = multiply_add(r[3], dv.y, multiply_subtract_from(d[3], v.y, add(turn.y, shift.y)));
  const Lanes z = multiply_add(r[3], dv.z, multiply_subtract_from(d[3], v.z, add(turn.z, shift.z)));
  return {multiply_add(twice, x, p.x), multiply_add(twice, y, p.y), multiply_add(twice, z, p.z)};
}

MIEN_INLINE void add_weighted(Lanes w, const float* quaternion, Lanes* sum) {
  for (int k = 0; k < 8; ++k) sum[k] = multiply_add(w, all(quaternion[k]), sum[k]);
}

MIEN_INLINE Lanes3 skinned_dual_quaternion(const BlockData& data, const FrameData& frame, std::size_t block,
                                           const Lanes3& p) {
  const BlockJoints joints = joints_of(data, block);
  const float *turned = frame.turned_weights, *weights = turned ? turned + lane_count : joints.weights;
  const Lanes3 q = frame.stretches ? stretched(data, frame, block, p) : p;
  Lanes sum[8];
  for (Lanes& part : sum) part = all(0);
  Lanes first = all(1);
  for (const std::uint16_t* joint = joints.first + 1; joint < joints.end; ++joint, weights += lane_count) {
    const Lanes w = load(weights);
    first = subtract(first, w);
    add_weighted(w, frame.rigid + 8 * *joint, sum);
  }
  add_weighted(turned ? load(turned) : first, frame.rigid + 8 * *joints.first, sum);
  return moved_rigidly(sum, sum + 4, q);
}

MIEN_INLINE Lanes3 skinned(const BlockData& data, const FrameData& frame, BlockSkin skin, std::size_t block,
                           const Lanes3& p) {
  if (skin == BlockSkin::linear) return skinned_linear(data, frame, block, p);
  if (skin == BlockSkin::dual_quaternion) return skinned_dual_quaternion(data, frame, block, p);
  return p;
}

MIEN_INLINE void store_rows(const BlockRun& run, float* rows, std::size_t block, const Lanes3& p) {
  const std::int32_t* row = run.row + lane_count * block;
  if (run.in_a_row[block]) {
    store_interleaved(rows + std::size_t{3} * static_cast<std::size_t>(row[0]), p.x, p.y, p.z);
    return;
  }
  alignas(64) float lanes[block_floats];
  store_interleaved(lanes, p.x, p.y, p.z);
  for (std::size_t l = 0; l < lane_count; ++l)
    if (row[l] >= 0)
      __builtin_memcpy(rows + 3 * static_cast<std::size_t>(row[l]), lanes + 3 * l, 3 * sizeof(float));
}

MIEN_INLINE void store_block(float* to, const Lanes3& p) {
  store(to, p.x);
  store(to + 16, p.y);
  store(to + 32, p.z);
}

MIEN_INLINE void stream_block(float* to, const Lanes3& p) {
  stream(to, p.x);
  stream(to + 16, p.y);
  stream(to + 32, p.z);
}

MIEN_TARGET void evaluate(const BlockData& data, const FrameData& frame, const BlockRun& run) {
  for (std::size_t b = run.begin; b < run.end; ++b) {
    Lanes3 p = shaped(data, frame, b);
    if (frame.wire_rows) add_wires(data, frame, run.to_part, b, p);
    if (frame.object_moves) add_objects(data, frame, run, b, p);
    p = skinned(data, frame, run.skin, b, p);
    if (run.blocks)
      store_block(run.blocks + block_floats * b, p);
    else
      store_rows(run, run.rows, b, p);
  }
}

template <class Delta>
MIEN_INLINE void bake_entry(const Delta* deltas, const float* coefficients, Lanes3* p, std::size_t begin,
                            std::size_t end) {
  const Lanes x = load(deltas), y = load(deltas + 16), z = load(deltas + 32);
#pragma GCC unroll 8
  for (std::size_t f = begin; f < end; ++f) {
    const Lanes c = all(coefficients[f]);
    p[f].x = multiply_add(x, c, p[f].x);
    p[f].y = multiply_add(y, c, p[f].y);
    p[f].z = multiply_add(z, c, p[f].z);
  }
}

/// Adds the shapes of one block in the frames [begin, end), as many as the registers hold.
template <class Delta, std::size_t begin, std::size_t end>
MIEN_INLINE void bake_shapes(const BlockData& data, const Delta* deltas, const BakeFrames& bake,
                             std::size_t block, Lanes3* out) {
  Lanes3 p[bake_width];
  const Lanes3 neutral = neutral_of(data, block);
  for (std::size_t f = begin; f < end; ++f) p[f] = neutral;
  const std::uint64_t* bits = data.shape_bits + data.words * block;
  std::uint32_t e = data.shape_begin[block];
  for (std::size_t w = 0; w < data.words; ++w)
    for (std::uint64_t own = bits[w]; own; own &= own - 1, ++e)
      if (bake.active[w] & own & -own)
        bake_entry(deltas + std::size_t{block_floats} * e, bake.coefficients + bake_width * data.shapes[e], p,
                   begin, end);
  for (std::size_t f = begin; f < end; ++f) out[f] = p[f];
}

template <class Delta>
MIEN_INLINE void bake_block(const BlockData& data, const Delta* deltas, const BakeFrames& bake,
                            std::size_t block, Lanes3* out) {
  if constexpr (has_many_registers) {
    bake_shapes<Delta, 0, 8>(data, deltas, bake, block, out);
  } else {
    bake_shapes<Delta, 0, 2>(data, deltas, bake, block, out);
    bake_shapes<Delta, 2, 4>(data, deltas, bake, block, out);
    bake_shapes<Delta, 4, 6>(data, deltas, bake, block, out);
    bake_shapes<Delta, 6, 8>(data, deltas, bake, block, out);
  }
}

MIEN_TARGET void bake(const BlockData& data, const BakeFrames& bake, const BlockRun& run) {
  Lanes3 p[bake_width];
  for (std::size_t b = run.begin; b < run.end; ++b) {
    if (data.compact)
      bake_block(data, data.compact, bake, b, p);
    else
      bake_block(data, data.deltas, bake, b, p);
    for (std::size_t f = 0; f < bake_width; ++f) {
      if (!bake.lanes[f]) continue;
      if (bake.frames[f].wire_rows) add_wires(data, bake.frames[f], run.to_part, b, p[f]);
      if (bake.frames[f].object_moves) add_objects(data, bake.frames[f], run, b, p[f]);
      const Lanes3 q = skinned(data, bake.frames[f], run.skin, b, p[f]);
      float* to = bake.lanes[f] + block_floats * b;
      if (bake.interleave)
        store_interleaved(to, q.x, q.y, q.z);
      else if (bake.stream)
        stream_block(to, q);
      else
        store_block(to, q);
    }
  }
  if (bake.stream) stream_end();
}

/// Copies rows [begin, end) to `to`, which has room for one float more.
MIEN_INLINE void gather_rows(const float* lanes, const std::uint32_t* lane_of_row, std::size_t begin,
                             std::size_t end, float* to) {
  for (std::size_t r = begin; r < end; ++r, to += 3)
    __builtin_memcpy(to, lanes + std::size_t{3} * lane_of_row[r], 4 * sizeof(float));
}

MIEN_INLINE void copy_row(const float* lanes, const std::uint32_t* lane_of_row, std::size_t row,
                          float* rows) {
  __builtin_memcpy(rows + 3 * row, lanes + std::size_t{3} * lane_of_row[row], 3 * sizeof(float));
}

/// Whole cache lines are written past the caches: nobody reads a baked frame soon, and a line written in full need not be
/// fetched first. Within sixteen rows one begins on a line. Rows are gathered many at a time, so that what is loaded as
/// lines has long left the store buffer.
MIEN_TARGET void copy_rows(const float* lanes, const std::uint32_t* lane_of_row, std::size_t count,
                           float* rows) {
  constexpr std::size_t batch = 16 * lane_count;
  alignas(64) float some[3 * batch + 1];
  std::size_t r = 0;
  while (r < count && reinterpret_cast<std::uintptr_t>(rows + 3 * r) % 64)
    copy_row(lanes, lane_of_row, r++, rows);
  for (; r + lane_count <= count;) {
    const std::size_t taken = count - r < batch ? (count - r) / lane_count * lane_count : batch;
    gather_rows(lanes, lane_of_row, r, r + taken, some);
    for (std::size_t k = 0; k < 3 * taken; k += lane_count) stream(rows + 3 * r + k, load(some + k));
    r += taken;
  }
  while (r < count) copy_row(lanes, lane_of_row, r++, rows);
  stream_end();
}

#undef MIEN_INLINE
