#pragma once
/// The left half of a head's skin while it is being made: quads with named loops around its openings.

#include <array>
#include <vector>

#include "mien/sample/detail/head_form.h"

namespace mien::sample {

using Eigen::Vector2d;
using Loop = std::vector<int>;

struct HalfHead {
  /// What relaxing may do with a vertex: slide it over the flesh, nothing but lay it on the flesh, nothing.
  enum class Hold { free, surface, fixed };

  std::vector<Vector3d> points;
  std::vector<Vector2d> uvs;
  std::vector<Hold> holds;
  std::vector<char> midline;              ///< 1: shared with the right half, stays at x = 0
  std::vector<std::array<int, 4>> quads;  ///< counter-clockwise from outside; the last is -1 in a triangle
  std::vector<char> cap;                  ///< per quad, 1: part of the crown's own UV island

  /// Loops run clockwise seen from outside, from the outermost to the innermost.
  /// Eye: start at the inner corner, go over the upper lid. Mouth: open, from the middle of the upper lip
  /// over the corner to the middle of the lower lip. Ear: start ahead, go over the top.
  std::vector<Loop> eye, mouth, nostril, ear;
  int lid_edge = 0;  ///< eye[lid_edge]: the outer edge of the lids' margins; the next one touches the eyeball
  int lip_border = 0;   ///< mouth[lip_border]: where the red of the lips begins
  int lip_contact = 0;  ///< mouth[lip_contact]: where the lips meet
  Loop front;           ///< the middle of the face from the base of the neck up, interrupted at the mouth
  std::vector<std::vector<int>> grid;  ///< [column][row], -1 inside a block

  int add(const Vector3d& point, const Vector2d& uv, Hold hold, bool on_midline = false);
  /// Quads between two loops of equal length, `outer` around `inner`.
  void bridge(const Loop& outer, const Loop& inner, bool closed);
};

/// The grid around the head with its crown closed and its blocks left open.
HalfHead make_grid(const HeadForm& form);
/// The vertices around a block: clockwise seen from outside, from the middle of the side nearest the face's
/// middle; for a block on the midline from the middle of its top to the middle of its bottom.
Loop border_of(const HalfHead& half, const Block& block);

void add_eyelids(HalfHead& half, const HeadForm& form);
void add_mouth(HalfHead& half, const HeadForm& form);
void add_nostril(HalfHead& half, const HeadForm& form);
void add_ear(HalfHead& half, const HeadForm& form);

/// Lays the skin on the flesh and evens its cells out.
void relax(HalfHead& half, const HeadForm& form);

}  // namespace mien::sample
