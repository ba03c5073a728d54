#pragma once
/// What a shape does to the triangles and edges of a face: folds, stretches, tears.

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// The triangles and edges of all parts of a character, measured at rest once.
class ShapeMeasure {
 public:
  ///   rest  one #V x 3 a part, model space
  ///   unit  the face's size; edges shorter than a thousandth of it count as that long
  ShapeMeasure(const Character& character, const std::vector<Points>& rest, double unit);

  /// Adds one to every corner of a triangle whose normal turns by more than a right angle; `counts` is one #V a part.
  void count_folds(const std::vector<Points>& posed, std::vector<Eigen::VectorXf>& counts) const;

  /// The largest length of an edge relative to its length at rest.
  double worst_stretch(const std::vector<Points>& posed) const;

  /// Edges more than twice as long as in `reference`: 0 or 1 each, in the measure's own order of edges.
  std::vector<char> torn_edges(const std::vector<Points>& posed, const std::vector<Points>& reference) const;

  std::size_t edge_count() const;

 private:
  struct PartMeasure {
    Triangles triangles;
    PointsD normals;                         // #T x 3, unnormalised
    std::vector<std::pair<int, int>> edges;  // first < second, ascending
    std::vector<double> lengths;             // at rest
  };
  std::vector<PartMeasure> parts_;
  double least_ = 0;
};

/// How far two results are apart.
struct Displacement {
  double rms = 0;  ///< of `posed` from `rest`, over the vertices of all parts, model units
  double largest = 0;
};
///   throws  invalid_input: sizes that differ
Displacement displacement(const std::vector<Points>& posed, const std::vector<Points>& rest);

}  // namespace mien
