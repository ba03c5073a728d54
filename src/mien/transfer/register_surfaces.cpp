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
#include "mien/transfer/detail/landmark_influence.h"
#include "mien/transfer/detail/matching.h"
#include "mien/transfer/detail/polynomial_fit.h"

namespace mien {
namespace {

struct Stage {
  double stiffness;
  double landmarks;   ///< weight of all landmarks if there are 68
  double tangential;  ///< how much closest points say where to slide, beside how far
  /// How far a match may be, in face sizes: the start may be far off where there are no landmarks (a cranium), later only
  /// what lies close is the same place.
  double reach;
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
/// While the surface is stiff this many vertices of either side say as much as all, and fewer about maps of the whole.
constexpr int coarse_vertices = 6000, whole_vertices = 2000;

/// From the whole face's proportions down to features of a few edges; where most of the sliding is done the stiffness
/// stays for a second round. Landmarks keep a little of their weight to the end: there they are better than a closest
/// point on a lip that lies on another.
constexpr std::array<Stage, 12> schedule{{{3, 2, .18, .1},
                                          {.5, 2, .18, .08},
                                          {.1, 2, .18, .064},
                                          {.1, 2, .18, .064},
                                          {.03, .6, .7, .051},
                                          {.03, .6, .7, .051},
                                          {.01, .2, .7, .041},
                                          {.01, .2, .7, .041},
                                          {.003, .06, .7, .033},
                                          {5e-4, .02, .12, .024},
                                          {1e-4, .02, .12, .019},
                                          {1e-5, .02, .12, .013}}};

/// What normals count as in a match (detail/matching.h), in face sizes. Far from all landmarks they hold the surface from
/// the start; near them the landmarks do, and normals only tell the sides of a lid from its rim, once it lies there.
struct Likeness {
  double near, far, bend;
};
constexpr Likeness while_soft{.015, .03, .03};
/// Where proportions differ so much that normals make the skin fold (more than this share of its triangles), the soft
/// stages go by place alone and the last, softest one is left out.
constexpr Likeness by_place{0, 0, 0};
constexpr double most_folds = 2e-3;
constexpr std::size_t stiff_stages = 8;
/// Distances from the nearest landmark between which near becomes far, in face sizes.
constexpr double near_landmarks = .08, far_from_landmarks = .3;

/// How boldly the surface slides to where it looks alike.
struct Manner {
  Likeness while_stiff;
  /// What faces another way than a landmark is this further from it, in face sizes a radian: the chin's tip does not hold
  /// the chin's underside.
  double turned_away;
  /// Each stage but the last goes on by this share of what it moved: closest points hold what should slide.
  double further;
};
constexpr Manner by_landmarks{{0, .3, 0}, .08, .5};
/// Landmarks that are not trusted leave the start as the best guess of where places go.
constexpr Manner by_itself{{0, .2, 0}, 0, 0};
constexpr double least_trust = 0.5;

const Manner& manner_of(const RegistrationOptions& options, const Eigen::VectorXd& trust) {
  return options.landmarks_hold && trust.mean() >= least_trust ? by_landmarks : by_itself;
}

Eigen::VectorXd normalised_areas(const Surface& surface) {
  const Eigen::VectorXd areas = vertex_areas(surface.positions, surface.triangles);
  return areas / areas.sum();
}

/// #L x 3.
PointsD normals_at(const std::vector<SurfaceQuery::Hit>& places, const detail::MatchSurface& surface) {
  PointsD normals(static_cast<Eigen::Index>(places.size()), 3);
  for (std::size_t i = 0; i < places.size(); ++i)
    normals.row(static_cast<Eigen::Index>(i)) = surface.normal_at(places[i]).transpose();
  return normals;
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
  const PointsD& goals;
  const Eigen::MatrixXd& holding;         // #L x 6, facing
  const Eigen::VectorXd& landmark_share;  // #L, of the schedule's weights
  const std::vector<SurfaceQuery::Hit>& landmarks;
  const Registration& result;
  const RegistrationOptions& options;
  const Manner& manner;
  std::vector<detail::CurvePiece> source_curves = {}, target_curves = {};
  Eigen::VectorXd masses = {};
  std::vector<char> boundary = {};
  mutable detail::MatchMemory memory = {};  // makes matching faster, changes nothing

  void find_features() {
    masses = normalised_areas(source);
    boundary = boundary_vertices(static_cast<std::size_t>(source.positions.rows()), source.triangles);
    if (!options.feature_curves) return;
    source_curves = detail::feature_curves(source, result.source_openness,
                                           least_border * result.unit / result.similarity.scale);
    target_curves = detail::feature_curves(fixed_surface, result.target_openness, least_border);
  }

  /// All that pulls at the source when it lies at `positions`; while it is stiff at most `most_vertices` of either side ask.
  std::vector<detail::Wish> wishes(const PointsD& positions, const Stage& stage, const Likeness& likeness,
                                   int most_vertices = coarse_vertices) const {
    detail::MatchSurface moving(positions, source.triangles, result.source_openness, masses, boundary,
                                SurfaceQuery::Build::fast);
    moving.far = detail::far_from(holding, detail::facing(positions, moving.normals, manner.turned_away),
                                  near_landmarks, far_from_landmarks);
    const bool coarse = stage.stiffness >= curves_until;
    detail::MatchOptions match;
    match.least_reach = stage.reach;
    match.tangential = stage.tangential;
    match.normal_length = likeness.near;
    match.far_normal_length = likeness.far;
    match.bend_length = likeness.bend;
    match.most_vertices = coarse ? most_vertices : std::numeric_limits<int>::max();
    std::vector<detail::Wish> all = detail::match_both_ways(moving, fixed, match, memory);
    add_landmark_wishes(landmarks, source.triangles, goals, stage.landmarks / 68 * landmark_share, all);
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
    constexpr double ridge = 1e-4, near = 0.15, distant = 0.6;
    constexpr Stage whole{schedule[0].stiffness, 1, 0.1, 0.3};
    for (int round = 0; round < rounds; ++round) {
      const PointsD shift = detail::fit_polynomial(
          positions, wishes(positions, whole, manner.while_stiff, whole_vertices), ridge);
      positions += detail::far_from(holding.leftCols<3>(), positions, near, distant).asDiagonal() * shift;
    }
  }
};

/// The displacement from `start` after stages `first` to `end`.
PointsD go_through(const Fitting& fitting, const detail::DisplacementSolver& solver, const PointsD& start,
                   PointsD u, std::size_t first, std::size_t end, const Likeness& likeness) {
  for (std::size_t s = first; s < end; ++s) {
    report_progress(fitting.options.progress, "registering", static_cast<double>(s) / schedule.size());
    const PointsD pulled =
        solver.solve(schedule[s].stiffness, fitting.wishes(start + u, schedule[s], likeness), u);
    u = s + 1 < end ? PointsD(pulled + fitting.manner.further * (pulled - u)) : pulled;
  }
  return u;
}

/// The source's vertices on the target, from where the spline brings them.
PointsD bring_onto_target(const Fitting& fitting, const PointsD& start) {
  const detail::DisplacementSolver solver(start, fitting.source.triangles);
  constexpr std::size_t end = schedule.size();
  const PointsD stiff = go_through(fitting, solver, start, PointsD::Zero(start.rows(), 3), 0, stiff_stages,
                                   fitting.manner.while_stiff);
  const PointsD soft = start + go_through(fitting, solver, start, stiff, stiff_stages, end, while_soft);
  const double folds = fitting.folded(soft);
  if (folds <= most_folds) return soft;
  const PointsD plain = start + go_through(fitting, solver, start, stiff, stiff_stages, end - 1, by_place);
  return fitting.folded(plain) < folds ? plain : soft;
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
  const std::vector<SurfaceQuery::Hit> landmarks =
      detail::closest_points(SurfaceQuery(source.positions, source.triangles), source_landmarks);

  result.source_openness = openness(source.positions, source.triangles, openness_rays);
  result.target_openness = openness(target.positions, target.triangles, openness_rays);
  detail::MatchSurface fixed(
      fixed_points, target.triangles, result.target_openness, normalised_areas(target),
      boundary_vertices(static_cast<std::size_t>(fixed_points.rows()), target.triangles));
  const std::vector<SurfaceQuery::Hit> marked = detail::closest_points(fixed.query, goals);
  const Eigen::VectorXd trust = trust_of(options, goals.rows());
  const Manner& manner = manner_of(options, trust);
  Eigen::MatrixXd holding(0, 6);
  if (options.landmarks_hold) holding = detail::facing(goals, normals_at(marked, fixed), manner.turned_away);
  fixed.far = detail::far_from(holding, detail::facing(fixed_points, fixed.normals, manner.turned_away),
                               near_landmarks, far_from_landmarks);

  const Eigen::VectorXd spread = detail::landmark_spread(marked, target, result.unit);
  const Eigen::VectorXd share = trust.cwiseQuotient(spread);
  Fitting fitting{
      source, {fixed_points, target.triangles}, fixed, goals, holding, share, landmarks, result, options,
      manner};
  fitting.find_features();
  PointsD start = ThinPlateSpline(source_landmarks, goals, {options.smoothing, -1, spread})(source.positions);
  fitting.fit_whole(start);
  result.guide = (bring_onto_target(fitting, start) * result.unit).rowwise() + centre;
  return result;
}

}  // namespace mien
