#include "mien/transfer/register_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mien/core/error.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/openness.h"
#include "mien/geometry/thin_plate_spline.h"
#include "mien/transfer/detail/face_size.h"
#include "mien/transfer/detail/feature_curves.h"
#include "mien/transfer/detail/matching.h"

namespace mien {
namespace {

struct Stage {
  double stiffness;
  double landmarks;  ///< weight of all landmarks if there are 68
  double
      tangential;  ///< while the surface is stiff, closest points say where to slide; at the end they only say how far
};
/// Weight of one openness level in one direction, while the stiffness is at least `curves_until`: lid and lip lines say
/// where features are, not where each vertex of a margin belongs.
constexpr double curve_weight = 0.033, curves_until = 0.06;
/// A border as long as a neck's, in face sizes; eyes' and mouths' are shorter.
constexpr double least_border = 1.0;

/// From the whole face's proportions down to features of a few edges.
constexpr std::array<Stage, 11> schedule{{{3, .5, .35},
                                          {1, .5, .35},
                                          {.3, .5, .35},
                                          {.1, .5, .35},
                                          {.03, .15, .35},
                                          {.01, .05, .35},
                                          {.003, .015, .35},
                                          {.001, .005, .12},
                                          {2e-4, 0, .12},
                                          {5e-5, 0, .12},
                                          {1e-5, 0, .12}}};

/// How far a match may be, in face sizes: the start may be far off where there are no landmarks (a cranium), later only
/// what lies close is the same place.
double reach_at(std::size_t stage) { return std::max(0.01, 0.1 * std::pow(0.8, static_cast<double>(stage))); }

Eigen::VectorXd normalised_areas(const Surface& surface) {
  const Eigen::VectorXd areas = vertex_areas(surface.positions, surface.triangles);
  return areas / areas.sum();
}

void add_landmark_wishes(const std::vector<SurfaceQuery::Hit>& at, const Triangles& triangles,
                         const PointsD& goals, double weight, std::vector<detail::Wish>& wishes) {
  if (weight <= 0) return;
  for (std::size_t i = 0; i < at.size(); ++i) {
    detail::Wish wish;
    for (int k = 0; k < 3; ++k) {
      wish.vertices[k] = triangles(at[i].triangle, k);
      wish.weights[k] = at[i].barycentric[k];
    }
    wish.goal = goals.row(static_cast<Eigen::Index>(i)).transpose();
    wish.along = wish.across = weight;
    wishes.push_back(wish);
  }
}

}  // namespace

Registration register_surfaces(const Surface& source, const Surface& target, const PointsD& source_landmarks,
                               const PointsD& target_landmarks, const RegistrationOptions& options) {
  Registration result;
  result.similarity = fit_similarity(source_landmarks, target_landmarks);
  result.unit = detail::face_size(target_landmarks, target.positions);
  // From here on the face has size one and sits at its landmarks' centre.
  const Eigen::RowVector3d centre = target_landmarks.colwise().mean();
  const auto normalise = [&](const PointsD& p) { return PointsD((p.rowwise() - centre) / result.unit); };
  const PointsD fixed_points = normalise(target.positions), goals = normalise(target_landmarks);

  result.source_openness = openness(source.positions, source.triangles);
  result.target_openness = openness(target.positions, target.triangles);
  const detail::MatchSurface fixed(fixed_points, target.triangles, result.target_openness,
                                   normalised_areas(target));

  std::vector<detail::CurvePiece> source_curves, target_curves;
  if (options.feature_curves) {
    source_curves = detail::feature_curves(source, result.source_openness,
                                           least_border * result.unit / result.similarity.scale);
    target_curves = detail::feature_curves(target, result.target_openness, least_border * result.unit);
  }
  const Surface fixed_surface{fixed_points, target.triangles};

  const ThinPlateSpline spline(source_landmarks, goals, {options.smoothing, -1});
  const PointsD start = spline(source.positions);
  const detail::DisplacementSolver solver(start, source.triangles);
  const SurfaceQuery source_query(source.positions, source.triangles);
  std::vector<SurfaceQuery::Hit> landmark_hits;
  for (Eigen::Index i = 0; i < source_landmarks.rows(); ++i)
    landmark_hits.push_back(source_query.closest(source_landmarks.row(i).transpose()));

  PointsD u = PointsD::Zero(start.rows(), 3);
  for (std::size_t s = 0; s < schedule.size(); ++s) {
    report_progress(options.progress, "registering", static_cast<double>(s) / schedule.size());
    const detail::MatchSurface moving(start + u, source.triangles, result.source_openness, solver.masses());
    std::vector<detail::Wish> wishes =
        detail::match_both_ways(moving, fixed, {.least_reach = reach_at(s), .tangential = schedule[s].tangential});
    add_landmark_wishes(landmark_hits, source.triangles, goals,
                        options.landmark_trust * schedule[s].landmarks / 68, wishes);
    if (schedule[s].stiffness >= curves_until) {
      const auto pulls = detail::match_curves(source_curves, {start + u, source.triangles}, target_curves,
                                              fixed_surface, curve_weight);
      wishes.insert(wishes.end(), pulls.begin(), pulls.end());
    }
    u = solver.solve(schedule[s].stiffness, wishes, u);
  }
  result.guide = ((start + u) * result.unit).rowwise() + centre;
  return result;
}

}  // namespace mien
