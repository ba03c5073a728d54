#pragma once
/// Where two surfaces are one and the same: a character whose mesh was subdivided, cut into other triangles or changed in
/// places (thesis 4.4, the target's topology changes), perhaps moved as a whole.

#include <optional>
#include <vector>

#include "mien/transfer/carry_skin_weights.h"
#include "mien/transfer/correspondence.h"

namespace mien {

struct TwinOptions {
  /// How far from the source a vertex may be to lie on it, of the target's box: what is left of a coordinate in a text file.
  double tolerance = 1e-5;
  /// Below this share of the target's vertices the surfaces are taken for two that meet by chance.
  double least_share = 0.25;
};

struct Twin {
  Similarity placement;             ///< source to target
  std::vector<SourcePoint> points;  ///< #V target; accepted where the vertex lies on the placed source
  double share = 0;                 ///< of the target's vertices that do
  bool whole() const { return share >= 1; }
};

/// The target as the source itself, placed by one of `starts` or by what improving the last of them by closest points comes to. A vertex lies
/// on the source when a triangle that faces as it does is within tolerance, and when most of its neighbours lie on it too.
///   starts  tried in order; one that fits as it is is kept to the digit
///   returns nothing where fewer than `least_share` of the vertices lie on the source
///   cost    a closest point a vertex where the surfaces agree, a few thousand otherwise
std::optional<Twin> find_twin(const Surface& source, const Surface& target,
                              const std::vector<Similarity>& starts, const TwinOptions& options = {});

/// Which vertices of the source the twin keeps (#V): those that come to lie on target triangles whose corners all lie on the source.
///   reach  how far a source vertex may be from the target's triangles, target units: what their chords cut off
std::vector<char> kept_vertices(const Twin& twin, const Surface& source, const Surface& target, double reach);

/// Brings the kept vertices of a guide to their places (#V x 3); the others follow by the harmonic extension of what that
/// changes, so that nothing tears at the border.
void settle_guide(const PointsD& places, const std::vector<char>& kept, const Surface& source,
                  PointsD& guide);

/// Gives the target's rows that lie on the source the mix of the source's rows there; other rows stay.
///   triangles  the source's; values #V source x K, target #V target x K
void set_twin_rows(const Twin& twin, const Triangles& triangles, const PointsD& values, PointsD& target);
WeightMatrix with_twin_rows(const Twin& twin, const Triangles& triangles, const WeightMatrix& values,
                            const WeightMatrix& target);

/// Brings factors (#V) to 1 at the kept vertices and, over a twentieth of the face, back to themselves around them.
void keep_scale(const std::vector<char>& kept, const PointsD& positions, const Triangles& triangles,
                double unit, Eigen::VectorXd& scale);

}  // namespace mien
