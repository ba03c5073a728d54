#pragma once
/// The guide: the source's surface warped by landmarks and brought onto the target, without folds and without gluing
/// lips, lids and nostrils together.

#include <Eigen/Core>

#include "mien/core/progress.h"
#include "mien/geometry/mesh.h"
#include "mien/geometry/similarity.h"

namespace mien {

/// One connected or several connected skins: no inner parts.
struct Surface {
  PointsD positions;  ///< #V x 3
  Triangles triangles;
};

struct RegistrationOptions {
  /// Trust in each landmark, #L; empty: 1. The schedule's landmark weights are multiplied by it; 0 keeps a landmark as
  /// the start only. Where the mean is below a half the surface slides as little as closest points make it.
  Eigen::VectorXd landmark_trust;
  /// Landmarks hold their surroundings in place. Those that were found by themselves do not: with false, normals say as
  /// much around them as far from all landmarks, and the quadratic maps move the whole skin.
  bool landmarks_hold = true;
  /// Smoothing of the starting spline (ThinPlateSpline::Options::smoothing). Landmarks that are clicked by hand are
  /// off by half a percent of the face; meeting them exactly would bend the start.
  double smoothing = 2e-2;
  /// Lid and lip lines found by openness pull curve onto curve in the stiff stages.
  bool feature_curves = true;
  Progress progress;
};

struct Registration {
  PointsD guide;          ///< #V source vertices on the target
  Similarity similarity;  ///< the landmarks' best rotation, scale and translation, source to target
  double unit = 1;  ///< the face's size in the target's units, the length that all limits are relative to
  Eigen::VectorXd source_openness, target_openness;  ///< #V, see geometry/openness.h
};

/// Non-rigid registration. The landmarks' spline, and far from all landmarks quadratic maps of the whole skin, give the
/// start; a bi-Laplacian prior on the displacement from it loses its stiffness over twelve rounds. Closest points both ways
/// pull, closest in place and, far from landmarks and at the end, in normal too; with gates on normal, distance, border and
/// openness; point to plane with a tangential share, more where the surface bends (a lid's rim); where landmarks are trusted
/// half a step further than they pull, for surfaces slide slowly. Where the skin would fold by that (cartoons), the soft stages are done again by
/// place alone. Lid and lip lines and the neck's border pull onto each other while the surface is stiff; landmarks are
/// priors that fade to a hundredth, and say less where they are vertices of a coarse mesh.
///   source_landmarks, target_landmarks  #L x 3, pairs by row, on or near the surfaces
///   throws  invalid_input: what ThinPlateSpline and fit_similarity refuse; surfaces without triangles
///   cost    about 1.5 s for 14,000 vertices on either side, one core
/// Scaling either side by a power of two changes no digit; turning or moving one changes rounding alone, which
/// gates amplify to about 1e-4 of the face.
Registration register_surfaces(const Surface& source, const Surface& target, const PointsD& source_landmarks,
                               const PointsD& target_landmarks, const RegistrationOptions& options = {});

}  // namespace mien
