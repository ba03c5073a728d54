#pragma once
/// Wires tried on a sample of the face: what a search for ranges or for places asks hundreds of times.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mien/deform/bind_wires.h"
#include "mien/extract/extract_wires.h"

namespace mien::detail {

/// A sample of the vertices around the wires, and the principal shapes there.
class WireTrial {
 public:
  ///   alike   expressions count nearly alike, by the cube root of their size: by size alone, lids would get what suits the jaw
  ///   throws  as WireSolver; no shape that moves what the wires reach
  WireTrial(const Character& character, std::span<const Wire> wires, const WireSolverOptions& solver,
            bool alike);

  /// What wires with bindings on the sample leave of the displacements, of 1.
  double left_over(const std::vector<Wire>& wires) const;

  /// Distances of the w-th wire as it was given, on the sample, up to `measured_range`.
  const std::vector<WireDistances>& distances(std::size_t w) const { return distances_[w]; }
  /// The same of another wire, up to its ranges.
  std::vector<WireDistances> measure(const WireBinder& binder, const Wire& wire) const;

 private:
  void take_sample(const Character& character, const WireSolverOptions& solver);
  void keep_sampled(std::vector<WireDistances>& list) const;
  void take_shapes(bool alike);

  const Character& character_;
  double ridge_;
  std::vector<std::vector<WireDistances>> distances_;  ///< per wire
  std::vector<std::vector<int>> row_of_;  ///< per part and vertex: row of `shapes_`, -1: not in the sample
  std::vector<float> weights_;            ///< per row
  std::vector<PointsD> shapes_;           ///< principal shapes, one row a sampled vertex, model space
  double total_ = 0;                      ///< weighted sum of squares of all shapes
};

/// How far distances are measured when ranges are looked for: four times the wire's longest range.
double measured_range(const Wire& wire);

/// `name` with its side exchanged, or itself.
std::string twin_name(const std::string& name);

/// Wires that change together: each with its twin (the one of `twin_name`) if there is one.
std::vector<std::vector<std::size_t>> twin_groups(const std::vector<Wire>& wires);

}  // namespace mien::detail
