#pragma once
/// A pose as the kernels want it: coefficients, active shapes, joint matrices, in memory that is kept.

#include <cstdint>
#include <utility>
#include <vector>

#include "mien/character/pose.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/compile_blocks.h"
#include "mien/evaluate/detail/object_motion.h"
#include "mien/evaluate/detail/wire_motion.h"

namespace mien::detail {

/// The pairs of carriers whose dual quaternions some vertex adds up, the vertex's strongest first.
class TwistTable {
 public:
  TwistTable() = default;
  explicit TwistTable(const Blocks& blocks);
  bool empty() const { return pairs_.empty(); }
  const std::vector<std::pair<std::uint16_t, std::uint16_t>>& pairs() const { return pairs_; }

 private:
  std::vector<std::pair<std::uint16_t, std::uint16_t>> pairs_;
};

/// What an evaluator compiles of a character.
struct CompiledCharacter {
  ///   throws  invalid_input: as compile_blocks
  CompiledCharacter(const Character& character, const std::vector<std::vector<int>>& vertices,
                    bool is_compact);
  Character outline;
  ConstraintSolver constraints;
  WireRows wire_rows;
  ObjectRows object_rows;
  JointChain chain;
  Blocks blocks;
  TwistTable twists;
};

class Frame {
 public:
  explicit Frame(const CompiledCharacter& compiled);

  ///   throws  invalid_input: as check_pose, WireRows::check and ObjectMotion::set
  void set(const CompiledCharacter& compiled, const Pose& pose);

  FrameData data(std::size_t part) const;
  const float* coefficients(std::size_t part) const {
    return coefficients_.data() + table_of_part_[part] * shapes_;
  }
  std::size_t shape_count() const { return shapes_; }
  std::size_t carrier_count() const { return carried_count_; }

  bool has_twist() const { return has_twist_; }
  /// Whether block `b` adds up quaternions that lie on opposite sides, so that its weights need signs.
  bool is_twisted(const Blocks& blocks, std::size_t b) const;
  ///   weights  16 a joint of the block: the block's own with the sign that joins each to its vertex's strongest
  void turn_weights(const Blocks& blocks, std::size_t b, std::vector<float>& weights) const;

  /// What differs from `before`: bits of shapes on a part, and whether a carrier moved.
  void changed_shapes(const Frame& before, std::size_t part, std::vector<std::uint64_t>& bits) const;
  bool has_moved(const Frame& before, std::size_t carrier) const;
  bool has_wire_moved(const Frame& before, const WireRows& layout, std::size_t wire) const;
  bool has_object_moved(const Frame& before, const ObjectRows& layout, std::size_t part,
                        std::size_t object) const;

 private:
  void set_coefficients(const CompiledCharacter& compiled, const Pose& pose);
  void set_table(std::size_t table, const CompiledCharacter& compiled, const Pose& pose);
  void set_objects(std::size_t table, const ObjectRows& layout, const Pose& pose);
  void set_matrices(const CompiledCharacter& compiled, const Pose& pose);
  void set_rigid(const TwistTable& twists);
  void set_rigid_of(std::size_t carrier);
  void set_wires(const WireRows& layout, const Pose& pose);

  std::size_t shapes_ = 0, words_ = 0, carried_count_ = 0;  // carriers, with the identity past the last
  ShapeWeights weights_;
  std::vector<std::size_t> table_of_part_;  // 0: the pose's own; p + 1: with the exceptions of part p
  std::vector<float> coefficients_;         // shapes a table
  std::vector<std::uint64_t> active_;       // words a table
  std::vector<char> is_dense_;              // by table: nearly all shapes are active
  std::vector<Transform> locals_;           // that obey the constraints
  std::vector<Affine> model_, carried_;
  std::vector<float> matrices_, rigid_, stretches_;
  bool has_stretch_ = false, has_twist_ = false;
  std::vector<char> is_twisted_;  // by carrier
  WireMotion wires_;
  std::vector<float> wire_rows_, wire_scales_;
  ObjectMotion objects_;
  std::vector<char> has_objects_, object_moves_;    // by table; objects a table
  std::vector<float> object_rows_, object_frames_;  // 3 a row and table; 12 an object and table
};

}  // namespace mien::detail
