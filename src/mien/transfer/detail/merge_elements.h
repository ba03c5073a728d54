#pragma once
/// One element of a rig in three versions into one: whether two are the same, and what both changes come to.

#include "mien/character/character.h"

namespace mien::detail {

/// What counts as the same.
struct Alike {
  double length = 0;     ///< positions and displacements, model units
  double number = 1e-5;  ///< turns, scales, slider values, relative to 1 or themselves
  double weight = 2e-4;  ///< skin weights and weight maps
  bool operator()(double a, double b) const;
  bool operator()(const PointsD& a, const PointsD& b) const;
  bool operator()(const Transform& a, const Transform& b) const;
  bool operator()(const Node& a, const Node& b) const;
  bool operator()(const Shape& a, const Shape& b) const;
  bool operator()(const Slider& a, const Slider& b) const;
  bool operator()(const Corrective& a, const Corrective& b) const { return a == b; }
  bool operator()(const Expression& a, const Expression& b) const;
  bool operator()(const Clip& a, const Clip& b) const;
  bool operator()(const Wire& a, const Wire& b) const;
  bool operator()(const InfluenceObject& a, const InfluenceObject& b) const;
  bool operator()(const Constraint& a, const Constraint& b) const;
  bool operator()(const Control& a, const Control& b) const { return a == b; }
  bool operator()(const std::vector<InfluenceBinding>& a, const std::vector<InfluenceBinding>& b) const;
  bool operator()(const SkinWeights& a, const SkinWeights& b) const;
};

/// What was done to `before` added to `after`. Each has changed.
Transform combined(const Transform& before, const Transform& after, const Transform& edited);
Shape combined(const Shape& before, const Shape& after, const Shape& edited, const Alike& alike);
Slider combined(const Slider& before, const Slider& after, const Slider& edited, const Alike& alike);
InfluenceObject combined(const InfluenceObject& before, const InfluenceObject& after,
                         const InfluenceObject& edited, const Alike& alike);
Wire combined(const Wire& before, const Wire& after, const Wire& edited, const Alike& alike);

}  // namespace mien::detail
