#include "mien/evaluate/detail/frame.h"

#include <algorithm>
#include <set>

#include "mien/deform/dual_quaternion.h"
#include "mien/evaluate/detail/check_pose.h"

namespace mien::detail {
namespace {

/// Above this share of active shapes a block goes through its whole list: testing bits costs more than adding zeros.
constexpr double dense_share = 0.8;

/// A stretch closer to the identity than this is the rounding of a file's matrices.
constexpr double stretch_tolerance = 1e-6;

/// A first joint's weight below this is the rounding of the others' sum.
constexpr float least_weight = 3e-7f;

float dot4(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// Skin weights of all joints of a block, 16 a joint: the first joint's are what the others leave of one.
void all_weights(const Blocks& blocks, std::size_t b, std::vector<float>& weights) {
  const float* others = blocks.joint_weights.data() + lane_count * (blocks.joint_begin[b] - b);
  const std::size_t count = lane_count * (blocks.joint_begin[b + 1] - blocks.joint_begin[b] - 1);
  weights.assign(lane_count, 1.f);
  weights.insert(weights.end(), others, others + count);
  for (std::size_t i = 0; i < count; ++i) weights[i % lane_count] -= others[i];
}

}  // namespace

TwistTable::TwistTable(const Blocks& blocks) {
  std::set<std::pair<std::uint16_t, std::uint16_t>> pairs;
  std::vector<float> weights;
  for (const PartBlocks& part : blocks.parts)
    for (std::size_t b = part.begin; b < part.end && part.skin == BlockSkin::dual_quaternion; ++b) {
      all_weights(blocks, b, weights);
      // A block of one joint each has no pair, and yet needs its quaternions.
      if (pairs.empty()) pairs.insert({blocks.pivots[lane_count * b], blocks.pivots[lane_count * b]});
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const std::uint16_t pivot = blocks.pivots[lane_count * b + i % lane_count];
        const std::uint16_t carrier = blocks.joints[blocks.joint_begin[b] + i / lane_count];
        if (weights[i] > least_weight && pivot != carrier) pairs.insert({pivot, carrier});
      }
    }
  pairs_.assign(pairs.begin(), pairs.end());
}

CompiledCharacter::CompiledCharacter(const Character& character,
                                     const std::vector<std::vector<int>>& vertices, bool is_compact)
    : outline(detail::outline(character)),
      constraints(character),
      wire_rows(character),
      object_rows(character, constraints),
      blocks(compile_blocks(character, vertices, is_compact, wire_rows, object_rows, chain)),
      twists(blocks) {}

Frame::Frame(const CompiledCharacter& compiled)
    : shapes_(compiled.outline.shapes.size()),
      words_(compiled.blocks.words),
      carried_count_(compiled.chain.carriers().size() + 1),
      weights_(shapes_),
      table_of_part_(compiled.blocks.parts.size(), 0),
      coefficients_(shapes_ * (compiled.blocks.parts.size() + 1)),
      active_(words_ * (compiled.blocks.parts.size() + 1)),
      is_dense_(compiled.blocks.parts.size() + 1, 0),
      matrices_(12 * carried_count_, 0.f),
      rigid_(8 * carried_count_, 0.f),
      stretches_(9 * carried_count_, 0.f),
      is_twisted_(carried_count_, 0),
      wires_(compiled.wire_rows),
      wire_rows_(3 * static_cast<std::size_t>(compiled.wire_rows.row_count())),
      wire_scales_(static_cast<std::size_t>(compiled.wire_rows.wire_count())),
      has_objects_(is_dense_.size(), 0),
      object_moves_(is_dense_.size() * static_cast<std::size_t>(compiled.object_rows.object_count()), 0),
      object_rows_(3 * is_dense_.size() * static_cast<std::size_t>(compiled.object_rows.row_count())),
      object_frames_(12 * object_moves_.size()) {
  model_.reserve(compiled.chain.links().size());
  carried_.reserve(carried_count_);
  for (int i = 0; i < 3; ++i) matrices_[12 * (carried_count_ - 1) + static_cast<std::size_t>(5 * i)] = 1;
}

void Frame::set(const CompiledCharacter& compiled, const Pose& pose) {
  check_pose(compiled.outline, pose);
  set_wires(compiled.wire_rows, pose);
  set_matrices(compiled, pose);
  set_coefficients(compiled, pose);
  if (!compiled.twists.empty()) set_rigid(compiled.twists);
}

void Frame::set_wires(const WireRows& layout, const Pose& pose) {
  wires_.set(layout, pose.wires);
  if (wires_.is_still) return;
  std::copy(wires_.scales.begin(), wires_.scales.end(), wire_scales_.begin());
  for (std::size_t k = 0; k < wire_rows_.size(); ++k)
    wire_rows_[k] = static_cast<float>(wires_.rows(static_cast<Eigen::Index>(k) / 3, k % 3));
}

void Frame::set_coefficients(const CompiledCharacter& compiled, const Pose& pose) {
  weights_.values = pose.shape_weights.values;
  set_table(0, compiled, pose);
  std::fill(table_of_part_.begin(), table_of_part_.end(), 0);
  for (const PartShapeWeight& exception : pose.part_shape_weights) {
    const auto part = static_cast<std::size_t>(exception.part);
    if (part >= table_of_part_.size() || table_of_part_[part]) continue;
    weights_on_part(pose, exception.part, weights_.values);
    set_table(part + 1, compiled, pose);
    table_of_part_[part] = part + 1;
  }
}

void Frame::set_table(std::size_t table, const CompiledCharacter& compiled, const Pose& pose) {
  float* coefficients = coefficients_.data() + table * shapes_;
  std::uint64_t* active = active_.data() + table * words_;
  std::fill(active, active + words_, 0);
  std::size_t count = 0;
  for (std::size_t s = 0; s < shapes_; ++s) {
    const double scale = compiled.blocks.scales.empty() ? 1 : compiled.blocks.scales[s];
    coefficients[s] = static_cast<float>(weights_.values[static_cast<Eigen::Index>(s)] * scale);
    if (coefficients[s] == 0) continue;
    active[s / 64] |= std::uint64_t{1} << (s % 64);
    ++count;
  }
  is_dense_[table] = static_cast<double>(count) >= dense_share * static_cast<double>(shapes_);
  set_objects(table, compiled.object_rows, pose);
}

void Frame::set_objects(std::size_t table, const ObjectRows& layout, const Pose& pose) {
  has_objects_[table] = 0;
  if (layout.empty() && pose.objects.empty()) return;
  objects_.set(layout, weights_, pose.objects);
  const auto count = static_cast<std::size_t>(layout.object_count());
  for (std::size_t o = 0; o < count; ++o) {
    const ObjectPose& object = objects_.poses()[o];
    object_moves_[table * count + o] = object.moves;
    if (!object.moves) continue;
    has_objects_[table] = 1;
    const std::size_t first = table * static_cast<std::size_t>(layout.row_count()) +
                              static_cast<std::size_t>(layout.control_begin(static_cast<int>(o)));
    Eigen::Map<Points>(object_rows_.data() + 3 * first, object.displacements.rows(), 3) =
        object.displacements.cast<float>();
    float* frame = object_frames_.data() + 12 * (table * count + o);
    for (int k = 0; k < 12; ++k)
      frame[k] = static_cast<float>(object.frame(k / 4, k % 4) - (k % 5 == 0 ? 1 : 0));
  }
}

void Frame::set_matrices(const CompiledCharacter& compiled, const Pose& pose) {
  locals_ = pose.locals;
  compiled.constraints.apply(locals_);
  if (!compiled.object_rows.empty() || !pose.objects.empty())
    objects_.place_nodes(compiled.object_rows, locals_);
  compiled.chain.evaluate(compiled.outline.nodes, locals_, model_, carried_);
  for (std::size_t c = 0; c < carried_.size(); ++c)
    for (int i = 0; i < 3; ++i) {
      float* row = matrices_.data() + 12 * c + 4 * static_cast<std::size_t>(i);
      for (int k = 0; k < 3; ++k) row[k] = static_cast<float>(carried_[c].linear(i, k));
      row[3] = static_cast<float>(carried_[c].origin[i]);
    }
}

void Frame::set_rigid_of(std::size_t carrier) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  if (carrier < carried_.size()) matrix.topRows<3>() << carried_[carrier].linear, carried_[carrier].origin;
  const StretchedMotion motion = split_motion(matrix);
  const DualQuaternion q = dual_quaternion(motion.rotation, motion.translation);
  float* rigid = rigid_.data() + 8 * carrier;
  for (int k = 0; k < 4; ++k) {
    rigid[k] = static_cast<float>(q.real[k]);
    rigid[4 + k] = static_cast<float>(q.dual[k]);
  }
  if (dot4(rigid, rigid_.data()) < 0)
    for (int k = 0; k < 8; ++k) rigid[k] = -rigid[k];
  for (int k = 0; k < 9; ++k)
    stretches_[9 * carrier + static_cast<std::size_t>(k)] = static_cast<float>(motion.stretch(k / 3, k % 3));
  has_stretch_ = has_stretch_ ||
                 (motion.stretch - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > stretch_tolerance;
}

/// All quaternions are first turned to the side of the first: then few pairs, mostly none, lie on opposite sides, and
/// only blocks with such a pair pay for signs.
void Frame::set_rigid(const TwistTable& twists) {
  has_stretch_ = false;
  for (std::size_t c = 0; c < carried_count_; ++c) set_rigid_of(c);
  has_twist_ = false;
  std::fill(is_twisted_.begin(), is_twisted_.end(), 0);
  for (const auto& [pivot, joint] : twists.pairs())
    if (dot4(rigid_.data() + 8 * pivot, rigid_.data() + 8 * joint) < 0) {
      has_twist_ = true;
      is_twisted_[pivot] = is_twisted_[joint] = 1;
    }
}

FrameData Frame::data(std::size_t part) const {
  const std::size_t table = table_of_part_[part];
  FrameData data;
  data.coefficients = coefficients(part);
  data.active = is_dense_[table] ? nullptr : active_.data() + table * words_;
  data.matrices = matrices_.data();
  data.rigid = rigid_.data();
  data.stretches = has_stretch_ ? stretches_.data() : nullptr;
  if (!wires_.is_still) {
    data.wire_rows = wire_rows_.data();
    data.wire_scales = wire_scales_.data();
    data.is_moving = wires_.is_moving.data();
  }
  if (has_objects_[table]) {
    data.object_moves = object_moves_.data() + table * object_moves_.size() / has_objects_.size();
    data.object_rows = object_rows_.data() + table * object_rows_.size() / has_objects_.size();
    data.object_frames = object_frames_.data() + table * object_frames_.size() / has_objects_.size();
  }
  return data;
}

bool Frame::is_twisted(const Blocks& blocks, std::size_t b) const {
  if (!has_twist_) return false;
  int count = 0;
  for (std::size_t e = blocks.joint_begin[b]; e < blocks.joint_begin[b + 1]; ++e)
    count += is_twisted_[blocks.joints[e]];
  return count > 1;
}

void Frame::turn_weights(const Blocks& blocks, std::size_t b, std::vector<float>& weights) const {
  all_weights(blocks, b, weights);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const float* pivot = rigid_.data() + 8 * blocks.pivots[lane_count * b + i % lane_count];
    const std::uint16_t carrier = blocks.joints[blocks.joint_begin[b] + i / lane_count];
    if (dot4(pivot, rigid_.data() + 8 * carrier) < 0) weights[i] = -weights[i];
  }
}

void Frame::changed_shapes(const Frame& before, std::size_t part, std::vector<std::uint64_t>& bits) const {
  bits.assign(words_, 0);
  const float *now = coefficients(part), *then = before.coefficients(part);
  for (std::size_t s = 0; s < shapes_; ++s)
    if (now[s] != then[s]) bits[s / 64] |= std::uint64_t{1} << (s % 64);
}

bool Frame::has_moved(const Frame& before, std::size_t carrier) const {
  return !std::equal(matrices_.begin() + 12 * static_cast<std::ptrdiff_t>(carrier),
                     matrices_.begin() + 12 * static_cast<std::ptrdiff_t>(carrier + 1),
                     before.matrices_.begin() + 12 * static_cast<std::ptrdiff_t>(carrier));
}

bool Frame::has_wire_moved(const Frame& before, const WireRows& layout, std::size_t wire) const {
  const bool moves = !wires_.is_still && wires_.is_moving[wire];
  const bool moved = !before.wires_.is_still && before.wires_.is_moving[wire];
  if (!moves || !moved) return moves != moved;
  const auto is_same = [&](int begin, int count) {
    const auto first = wire_rows_.begin() + 3 * begin;
    return std::equal(first, first + 3 * count, before.wire_rows_.begin() + 3 * begin);
  };
  const int w = static_cast<int>(wire);
  return wire_scales_[wire] != before.wire_scales_[wire] ||
         !is_same(layout.control_begin(w), layout.control_count(w)) ||
         !is_same(layout.turn_begin(w), layout.turn_count(w));
}

bool Frame::has_object_moved(const Frame& before, const ObjectRows& layout, std::size_t part,
                             std::size_t object) const {
  const FrameData now = data(part), then = before.data(part);
  const bool moves = now.object_moves && now.object_moves[object];
  const bool moved = then.object_moves && then.object_moves[object];
  if (!moves || !moved) return moves != moved;
  const int o = static_cast<int>(object);
  const auto is_same = [](const float* a, const float* b, int first, int count) {
    return std::equal(a + first, a + first + count, b + first);
  };
  return layout.is_frame(o) ? !is_same(now.object_frames, then.object_frames, 12 * o, 12)
                            : !is_same(now.object_rows, then.object_rows, 3 * layout.control_begin(o),
                                       3 * layout.control_count(o));
}

}  // namespace mien::detail
