#pragma once
/// The modeller's view of a face: which sliders disturb each other, and which move what they should not.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/region_rule.h"

namespace mien {

/// Two sliders that move the same vertices.
struct InterferingPair {
  int first = 0, second = 0;  ///< sliders, first < second
  double overlap = 0;         ///< as Interference::overlap
  double alignment = 0;       ///< as Interference::alignment
  SurfacePoint where;         ///< the vertex where the product of their motions is largest
};

struct Interference {
  /// #sliders x #sliders, [0, 1]: sum over vertices of |d_a| |d_b|, over the root of the two sums of squares. 1: they move the
  /// same vertices in the same proportions; 0: no vertex in common.
  Eigen::MatrixXd overlap;
  /// The same with d_a'd_b, [-1, 1]: above 0 they reinforce, below they work against each other, near 0 with a large overlap they
  /// pull the same vertices different ways.
  Eigen::MatrixXd alignment;
  std::vector<InterferingPair> pairs;  ///< with an overlap above `least`, the largest first
};

/// Sliders move as their slopes at rest say.
///   least   pairs below are left out of the list
///   throws  invalid_input: no sliders
///   cost    vertices x #sliders^2; memory: vertices x #sliders floats
Interference interference(const Character& character, double least = 0.1);

struct RuleBreak {
  int rule = 0;
  double seconds = 0;
  int slider = -1;  ///< the slider that may not move it, -1: the point moves too far
  int point = 0;    ///< of the rule's region
  double by = 0;    ///< how far: what the slider does there, or the whole move
};

/// Checks every frame of a clip. A slider's share is the point's move against the same pose with this slider at rest; below 1e-4
/// of the face's box it counts as none. Each rule reports, for each slider and for going too far, its worst frame alone.
///   throws  invalid_input: a region off the surface or without points, sliders out of range, an fps not above 0
std::vector<RuleBreak> check_region_rules(const Character& character, const Clip& clip,
                                          const std::vector<RegionRule>& rules, double fps = 30);

}  // namespace mien
