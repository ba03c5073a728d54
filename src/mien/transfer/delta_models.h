#pragma once
/// How a displacement of the source's skin becomes one of the target's: no single rule is right for copied artist
/// shapes, joint-driven faces and cartoons, so there are several and a rule that chooses.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mien/geometry/mesh.h"
#include "mien/geometry/thin_plate_spline.h"
#include "mien/transfer/register_surfaces.h"

namespace mien {

enum class DeltaModel {
  automatic,  ///< local, or the warp where the source's own contacts ask for it
  local,      ///< s R d with s a smooth local scale of the surface's area
  raw,        ///< s R d with the landmarks' scale
  copy,       ///< R d: the same size in the files' units
  warp,       ///< T(x + d) - T(x), T a spline through landmarks and 500 points of the guide
  thesis,     ///< T(x + d) - T(x), T the landmarks' spline (thesis 4.7.2, with the errata's reading)
};

/// "auto", "local", ...: the names of the command line.
std::string_view name_of(DeltaModel model);

/// #V factors that bring the aligned source's areas to the guide's, smoothed over `radius`:
/// s = sqrt(u1 / u0), (M + radius^2 L) u_k = areas_k, on the aligned source; 1 where nothing is known.
///   aligned  #V x 3: the source after the similarity; guide #V x 3; radius in their units
///   cost     one sparse factorisation, about 0.08 s at 14,000 vertices
Eigen::VectorXd local_scale(const PointsD& aligned, const PointsD& guide, const Triangles& triangles,
                            double radius);

/// A spline from the aligned source to the guide through the landmarks and the vertices `samples` (500 farthest points).
///   landmarks_from, landmarks_to  #L x 3 in the same frames; diagonal smoothing 1e-3 of the box
ThinPlateSpline dense_spline(const PointsD& aligned, const PointsD& guide, const PointsD& landmarks_from,
                             const PointsD& landmarks_to, std::span<const int> samples);

/// The skin and the maps that displacements are carried by.
struct DeltaMaps {
  PointsD positions;  ///< #V x 3 source skin, source model space
  PointsD aligned;    ///< #V x 3 after the similarity
  Similarity similarity;
  std::vector<int> samples;  ///< farthest points of `aligned`, in order: the first k are a choice of k
  Eigen::VectorXd scale;     ///< #V: local_scale; used by local
  const ThinPlateSpline* dense = nullptr;      ///< aligned -> target; used by warp
  const ThinPlateSpline* landmarks = nullptr;  ///< source -> target; used by thesis
  PointsD dense_image;     ///< #V: dense(aligned), or no rows: computed where it is needed
  PointsD landmark_image;  ///< #V: landmarks(positions), or no rows
};

/// One shape's displacements (#V x 3, source model space) in the target's model space, still at the source's vertices:
/// (1 - warp_share) local + warp_share warp when `model` is automatic, else the named model alone. Cost: O(#V), and
/// O(#samples) a moving vertex for the splines.
PointsD carry_deltas(const DeltaMaps& maps, DeltaModel model, double warp_share, const PointsD& deltas);

/// Indices of `count` rows, each the farthest from those before, starting with the row farthest from the mean.
std::vector<int> farthest_points(const PointsD& points, int count);

}  // namespace mien
