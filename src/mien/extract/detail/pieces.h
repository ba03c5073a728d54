#pragma once
/// Which pieces of surface carry wires, and which feature each vertex belongs to.

#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/extract/extract_wires.h"

namespace mien::detail {

class Pieces {
 public:
  Pieces(const Character& character, std::span<const Wire> wires);

  /// Whether the vertex is on a connected piece of surface that a wire reaches.
  bool is_skin(int part, int vertex) const { return skin_[part][vertex]; }
  const std::vector<std::vector<char>>& skin() const { return skin_; }
  bool has_skin(int part) const { return has_skin_[part]; }
  std::size_t skin_vertices() const { return skin_vertices_; }
  /// Index into `features` of the wire with the largest share; the last one: out of reach.
  int feature(int part, int vertex) const { return feature_[part][vertex]; }
  /// Features by name of first appearance, and one without a name for what no wire reaches. Sums are zero.
  const std::vector<FeatureError>& features() const { return features_; }
  /// Diagonal of the box around the vertices that wires reach, model space.
  double box() const { return box_; }
  /// Length in model space of a unit in the part's own space (cube root of the volume).
  double unit(int part) const { return unit_[part]; }

 private:
  std::vector<std::vector<char>> skin_;
  std::vector<char> has_skin_;
  std::vector<std::vector<int>> feature_;
  std::vector<FeatureError> features_;
  std::vector<double> unit_;
  std::size_t skin_vertices_ = 0;
  double box_ = 0;
};

}  // namespace mien::detail
