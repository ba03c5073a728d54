#include "mien/transfer/register_surfaces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "mien/core/error.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/openness.h"
#include "mien/geometry/thin_plate_spline.h"
#include "mien/transfer/detail/face_size.h"
#include "mien/transfer/detail/feature_curves.h"
#include "mien/transfer/detail/matching.h"
#include "mien/transfer/detail/polynomial_fit.h"

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
/// Openness of what is seen from outside.
constexpr double outer_skin = 0.4;
/// Rays a vertex: twice as many place the lid and lip lines no better.
constexpr int openness_rays = 32;
/// While the surface is stiff this many vertices of either side say as much as all.
constexpr int coarse_vertices = 6000;

/// From the whole face's proportions down to features of a few edges. Landmarks keep a little of their weight to the end:
/// there they are better than a closest point on a lip that lies on another.
constexpr std::array<Stage, 10> schedule{{{3, 2, .35},
                                          {.5, 2, .35},
                                          {.1, 2, .35},
                                          {.03, .6, .35},
                                          {.01, .2, .35},
                                          {.003, .06, .35},
                                          {.001, .02, .12},
                                          {2e-4, .02, .12},
                                          {5e-5, .02, .12},
                                          {1e-5, .02, .12}}};

/// What normals count as in a match (detail/matching.h), in face sizes. Far from all landmarks they hold the surface from
/// the start; near them the landmarks do, and normals only tell the sides of a lid from its rim, once it lies there.
struct Likeness {
  double near, far, bend;
};
constexpr Likeness while_stiff{0, .2, 0}, while_soft{.015, .03, .03};
/// Where proportions differ so much that normals make the skin fold (more than this share of its triangles), the soft
/// stages go by place alone and the last, softest one is left out.
constexpr Likeness by_place{0, 0, 0};
constexpr double most_folds = 2e-3;
constexpr std::size_t stiff_stages = 5;
/// Distances from the nearest landmark between which near becomes far, in face sizes.
constexpr double near_landmarks = .08, far_from_landmarks = .3;

/// How far a match may be, in face sizes: the start may be far off where there are no landmarks (a cranium), later only
/// what lies close is the same place.
double reach_at(std::size_t stage) {
  return std::max(0.01, 0.1 * std::pow(0.8, static_cast<double>(stage)));
}

Eigen::VectorXd normalised_areas(const Surface& surface) {
  const Eigen::VectorXd areas = vertex_areas(surface.positions, surface.triangles);
  return areas / areas.sum();
}

void add_landmark_wishes(const std::vector<SurfaceQuery::Hit>& at, const Triangles& triangles,
                         const PointsD& goals, const Eigen::VectorXd& weights,
                         std::vector<detail::Wish>& wishes) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double weight = weights[static_cast<Eigen::Index>(i)];
    if (!(weight > 0)) continue;
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

/// #V: 0 within `near` of a landmark, 1 from `far` on, smooth between; 1 where there are none.
Eigen::VectorXd far_from(const PointsD& landmarks, const PointsD& positions, double near, double far) {
  Eigen::VectorXd result = Eigen::VectorXd::Ones(positions.rows());
  if (landmarks.rows() == 0) return result;
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const double distance =
        std::sqrt((landmarks.rowwise() - positions.row(v)).rowwise().squaredNorm().minCoeff());
    const double t = std::clamp((distance - near) / (far - near), 0.0, 1.0);
    result[v] = t * t * (3 - 2 * t);
  }
  return result;
}

Eigen::VectorXd trust_of(const RegistrationOptions& options, Eigen::Index count) {
  if (options.landmark_trust.size() == 0) return Eigen::VectorXd::Ones(count);
  if (options.landmark_trust.size() != count)
    throw invalid_input("landmark trust", "has " + std::to_string(options.landmark_trust.size()) + " numbers",
                        "one a landmark (" + std::to_string(count) + "), or none");
  return options.landmark_trust;
}

/// What all stages share: the two surfaces, their curves and the landmarks.
struct Fitting {
  const Surface& source;
  const Surface fixed_surface;
  const detail::MatchSurface& fixed;
  const PointsD &goals, &holding;
  const Eigen::VectorXd& trust;
  const Registration& result;
  const RegistrationOptions& options;
  std::vector<detail::CurvePiece> source_curves, target_curves;
  std::vector<SurfaceQuery::Hit> landmarks;
  Eigen::VectorXd masses;
  std::vector<char> boundary;

  void find_features(const PointsD& source_landmarks) {
    masses = normalised_areas(source);
    boundary = boundary_vertices(static_cast<std::size_t>(source.positions.rows()), source.triangles);
    const SurfaceQuery query(source.positions, source.triangles);
    for (Eigen::Index i = 0; i < source_landmarks.rows(); ++i)
      landmarks.push_back(query.closest(source_landmarks.row(i).transpose()));
    if (!options.feature_curves) return;
    source_curves = detail::feature_curves(source, result.source_openness,
                                           least_border * result.unit / result.similarity.scale);
    target_curves = detail::feature_curves(fixed_surface, result.target_openness, least_border);
  }

  /// All that pulls at the source when it lies at `positions`.
  std::vector<detail::Wish> wishes(const PointsD& positions, const Stage& stage, const Likeness& likeness,
                                   double reach) const {
    detail::MatchSurface moving(positions, source.triangles, result.source_openness, masses, boundary);
    moving.far = far_from(holding, positions, near_landmarks, far_from_landmarks);
    const bool coarse = stage.stiffness >= curves_until;
    detail::MatchOptions match;
    match.least_reach = reach;
    match.tangential = stage.tangential;
    match.normal_length = likeness.near;
    match.far_normal_length = likeness.far;
    match.bend_length = likeness.bend;
    match.most_vertices = coarse ? coarse_vertices : std::numeric_limits<int>::max();
    std::vector<detail::Wish> all = detail::match_both_ways(moving, fixed, match);
    add_landmark_wishes(landmarks, source.triangles, goals, stage.landmarks / 68 * trust, all);
    if (coarse) {
      const auto pulls = detail::match_curves(source_curves, {positions, source.triangles}, target_curves,
                                              fixed_surface, curve_weight);
      all.insert(all.end(), pulls.begin(), pulls.end());
    }
    return all;
  }

  /// The share of the outer skin's triangles that are turned over against the source.
  double folded(const PointsD& positions) const {
    const auto normal = [&](const PointsD& p, Eigen::Index t) {
      const Eigen::Vector3d a = p.row(source.triangles(t, 0)).transpose();
      return (p.row(source.triangles(t, 1)).transpose() - a)
          .cross(p.row(source.triangles(t, 2)).transpose() - a)
          .eval();
    };
    Eigen::Index skin = 0, turned = 0;
    for (Eigen::Index t = 0; t < source.triangles.rows(); ++t) {
      double open = 1;
      for (int k = 0; k < 3; ++k) open = std::min(open, result.source_openness[source.triangles(t, k)]);
      if (open < outer_skin) continue;
      ++skin;
      turned += normal(positions, t).dot(result.similarity.rotation * normal(source.positions, t)) < 0;
    }
    return static_cast<double>(turned) / static_cast<double>(std::max<Eigen::Index>(skin, 1));
  }

  /// Moves what lies far from all landmarks by quadratic maps of the whole skin.
  void fit_whole(PointsD& positions) const {
    constexpr int rounds = 4;
    constexpr double ridge = 1e-4, reach = 0.3, near = 0.15, distant = 0.6;
    const Stage whole{schedule[0].stiffness, 1, 0.1};
    for (int round = 0; round < rounds; ++round) {
      const PointsD shift =
          detail::fit_polynomial(positions, wishes(positions, whole, while_stiff, reach), ridge);
      positions += far_from(holding, positions, near, distant).asDiagonal() * shift;
    }
  }
};

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
  const Eigen::VectorXd trust = trust_of(options, goals.rows());
  const PointsD holding = options.landmarks_hold ? goals : PointsD(0, 3);

  result.source_openness = openness(source.positions, source.triangles, openness_rays);
  result.target_openness = openness(target.positions, target.triangles, openness_rays);
  detail::MatchSurface fixed(
      fixed_points, target.triangles, result.target_openness, normalised_areas(target),
      boundary_vertices(static_cast<std::size_t>(fixed_points.rows()), target.triangles));

  fixed.far = far_from(holding, fixed_points, near_landmarks, far_from_landmarks);

  Fitting fitting{
      source, {fixed_points, target.triangles}, fixed, goals, holding, trust, result, options, {}, {}, {}, {},
      {}};
  fitting.find_features(source_landmarks);
  const ThinPlateSpline spline(source_landmarks, goals, {options.smoothing, -1});
  PointsD start = spline(source.positions);
  fitting.fit_whole(start);
  const detail::DisplacementSolver solver(start, source.triangles);
  std::size_t done = 0;
  const auto run = [&](PointsD u, std::size_t end, const Likeness& likeness) {
    for (std::size_t s = done; s < end; ++s) {
      report_progress(options.progress, "registering", static_cast<double>(s) / schedule.size());
      const Stage& stage = schedule[s];
      u = solver.solve(stage.stiffness, fitting.wishes(start + u, stage, likeness, reach_at(s)), u);
    }
    return u;
  };
  const PointsD stiff = run(PointsD::Zero(start.rows(), 3), stiff_stages, while_stiff);
  done = stiff_stages;
  PointsD u = run(stiff, schedule.size(), while_soft);
  const double folds = fitting.folded(start + u);
  if (folds > most_folds) {
    const PointsD plain = run(stiff, schedule.size() - 1, by_place);
    if (fitting.folded(start + plain) < folds) u = plain;
  }
  result.guide = ((start + u) * result.unit).rowwise() + centre;
  return result;
}

}  // namespace mien
