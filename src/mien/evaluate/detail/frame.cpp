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

float dot4(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

}  // namespace

TwistTable::TwistTable(const Blocks& blocks) {
  std::set<std::pair<std::uint16_t, std::uint16_t>> pairs;
  for (const PartBlocks& part : blocks.parts)
    for (std::size_t b = part.begin; b < part.end && part.skin == BlockSkin::dual_quaternion; ++b)
      for (std::size_t e = blocks.joint_begin[b]; e < blocks.joint_begin[b + 1]; ++e)
        for (std::size_t l = 0; l < lane_count; ++l)
          if (const std::uint16_t pivot = blocks.pivots[lane_count * b + l];
              blocks.joint_weights[lane_count * e + l] > 0 && pivot != blocks.joints[e])
            pairs.insert({pivot, blocks.joints[e]});
  for (const PartBlocks& part :
       blocks.parts)  // a block of one joint each has no pair, and yet needs its quaternions
    if (part.skin == BlockSkin::dual_quaternion && part.begin < part.end)
      pairs.insert({blocks.pivots[lane_count * part.begin], blocks.pivots[lane_count * part.begin]});
  pairs_.assign(pairs.begin(), pairs.end());
}

Frame::Frame(const Character& outline, const JointChain& chain, const Blocks& blocks)
    : shapes_(outline.shapes.size()),
      words_(blocks.words),
      carried_count_(chain.carriers().size() + 1),
      weights_(static_cast<Eigen::Index>(shapes_)),
      table_of_part_(blocks.parts.size(), 0),
      coefficients_(shapes_ * (blocks.parts.size() + 1)),
      active_(words_ * (blocks.parts.size() + 1)),
      is_dense_(blocks.parts.size() + 1, 0),
      matrices_(12 * carried_count_, 0.f),
      rigid_(8 * carried_count_, 0.f),
      stretches_(9 * carried_count_, 0.f),
      is_twisted_(carried_count_, 0) {
  model_.reserve(chain.links().size());
  carried_.reserve(carried_count_);
  for (int i = 0; i < 3; ++i) matrices_[12 * (carried_count_ - 1) + static_cast<std::size_t>(5 * i)] = 1;
}

void Frame::set(const Character& outline, const JointChain& chain, const Blocks& blocks,
                const TwistTable& twists, const Pose& pose) {
  check_pose(outline, pose);
  set_coefficients(blocks, pose);
  set_matrices(chain, outline.nodes, pose);
  if (!twists.empty()) set_rigid(twists);
}

void Frame::set_coefficients(const Blocks& blocks, const Pose& pose) {
  weights_ = pose.shape_weights.values;
  set_table(0, blocks);
  std::fill(table_of_part_.begin(), table_of_part_.end(), 0);
  for (const PartShapeWeight& exception : pose.part_shape_weights) {
    const auto part = static_cast<std::size_t>(exception.part);
    if (part >= table_of_part_.size() || table_of_part_[part]) continue;
    weights_on_part(pose, exception.part, weights_);
    set_table(part + 1, blocks);
    table_of_part_[part] = part + 1;
  }
}

void Frame::set_table(std::size_t table, const Blocks& blocks) {
  float* coefficients = coefficients_.data() + table * shapes_;
  std::uint64_t* active = active_.data() + table * words_;
  std::fill(active, active + words_, 0);
  std::size_t count = 0;
  for (std::size_t s = 0; s < shapes_; ++s) {
    const double scale = blocks.scales.empty() ? 1 : blocks.scales[s];
    coefficients[s] = static_cast<float>(weights_[static_cast<Eigen::Index>(s)] * scale);
    if (coefficients[s] == 0) continue;
    active[s / 64] |= std::uint64_t{1} << (s % 64);
    ++count;
  }
  is_dense_[table] = static_cast<double>(count) >= dense_share * static_cast<double>(shapes_);
}

void Frame::set_matrices(const JointChain& chain, const std::vector<Node>& nodes, const Pose& pose) {
  chain.evaluate(nodes, pose, model_, carried_);
  for (std::size_t c = 0; c < carried_.size(); ++c)
    for (int i = 0; i < 3; ++i) {
      float* row = matrices_.data() + 12 * c + 4 * static_cast<std::size_t>(i);
      for (int k = 0; k < 3; ++k) row[k] = static_cast<float>(carried_[c].linear(i, k));
      row[3] = static_cast<float>(carried_[c].origin[i]);
    }
}

/// All quaternions are first turned to the side of the first: then few pairs, mostly none, lie on opposite sides, and
/// only blocks with such a pair pay for signs.
void Frame::set_rigid(const TwistTable& twists) {
  has_stretch_ = false;
  for (std::size_t c = 0; c < carried_count_; ++c) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    if (c < carried_.size()) matrix.topRows<3>() << carried_[c].linear, carried_[c].origin;
    const StretchedMotion motion = split_motion(matrix);
    const DualQuaternion q = dual_quaternion(motion.rotation, motion.translation);
    float* rigid = rigid_.data() + 8 * c;
    for (int k = 0; k < 4; ++k) {
      rigid[k] = static_cast<float>(q.real[k]);
      rigid[4 + k] = static_cast<float>(q.dual[k]);
    }
    if (dot4(rigid, rigid_.data()) < 0)
      for (int k = 0; k < 8; ++k) rigid[k] = -rigid[k];
    for (int k = 0; k < 9; ++k)
      stretches_[9 * c + static_cast<std::size_t>(k)] = static_cast<float>(motion.stretch(k / 3, k % 3));
    has_stretch_ = has_stretch_ ||
                   (motion.stretch - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > stretch_tolerance;
  }
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
  weights.clear();
  for (std::size_t e = blocks.joint_begin[b]; e < blocks.joint_begin[b + 1]; ++e)
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float* pivot = rigid_.data() + 8 * blocks.pivots[lane_count * b + l];
      const float weight = blocks.joint_weights[lane_count * e + l];
      weights.push_back(dot4(pivot, rigid_.data() + 8 * blocks.joints[e]) < 0 ? -weight : weight);
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

}  // namespace mien::detail
