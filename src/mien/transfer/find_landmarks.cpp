#include "mien/transfer/find_landmarks.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "mien/character/landmark_points.h"
#include "mien/character/shown_parts.h"
#include "mien/core/error.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/correction.h"
#include "mien/transfer/detail/place_head.h"
#include "mien/transfer/detail/template_head.h"
#include "mien/transfer/register_surfaces.h"

namespace mien {
namespace {

using detail::at;
using detail::PlacedHead;
using detail::SoughtHead;
using detail::surface_point;
using detail::TemplateHead;

/// Read off the heads of the documents' table: right placements have scores up to .076 and likeness from .57, wrong ones
/// and things that are no heads scores from .08 and likeness up to .53.
constexpr double accept_score = 0.07, refuse_score = 0.09, least_likeness = 0.5;
/// Trust in the placed landmarks while a head that is alike is registered.
constexpr double twin_trust = 0.05;
/// Likeness of two heads that need no help of normals and of a second look.
constexpr double twins = 0.9;
/// Times that the head is registered, and how far its two sides are evened out between (.5: their mean).
constexpr int passes = 3;
constexpr double evenness = 0.5;
/// A given point further than this from where the others put it, in face sizes, is doubted.
constexpr double least_surprise = 0.05;

}  // namespace

std::string_view name_of(Verdict verdict) {
  return verdict == Verdict::accept ? "accept" : verdict == Verdict::check ? "check" : "refuse";
}

std::vector<Landmark> FoundLandmarks::points() const {
  std::vector<Landmark> result;
  for (const FoundLandmark& found : landmarks) result.push_back(found.landmark);
  return result;
}

namespace {

/// rms of log singular values about their mean, weighted by attention: how the template's triangles were bent.
double stretch_of(const TemplateHead& head, const PointsD& guide) {
  double sum = 0, weights = 0;
  const Triangles& triangles = head.skin.triangles;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const int a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
    const auto frame = [&](const PointsD& p) {
      const Eigen::Vector3d u = (p.row(b) - p.row(a)).transpose(), v = (p.row(c) - p.row(a)).transpose();
      const Eigen::Vector3d x = u.normalized(), y = (v - v.dot(x) * x).normalized();
      Eigen::Matrix2d m;
      m << u.dot(x), v.dot(x), 0, v.dot(y);
      return m;
    };
    const Eigen::Matrix2d before = frame(head.skin.positions), after = frame(guide);
    if (!(std::abs(before.determinant()) > 1e-12)) continue;
    const Eigen::JacobiSVD<Eigen::Matrix2d> svd(after * before.inverse());
    const double weight = (head.attention[a] - 0.1) * std::abs(before.determinant());
    const double ratio = svd.singularValues()[0] / std::max(1e-9, svd.singularValues()[1]);
    sum += weight * std::min(3.0, std::log(ratio));
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

/// One search on its way.
class Search {
 public:
  Search(const Character& target, const Character& like, const FindLandmarksOptions& options)
      : target_(target),
        like_(like),
        options_(options),
        head_(detail::make_template_head(like, options.like_facing)),
        sought_(detail::make_sought_head(target)),
        like_points_(detail::all_points(like)) {}

  FoundLandmarks operator()() {
    read_given();
    placed_ = detail::place_head(head_, sought_, known_, options_.progress).front();
    found_.score = placed_.score.total();
    found_.likeness = placed_.score.relief;
    found_.alike = found_.likeness > twins;
    found_.facing = placed_.placement.rotation.transpose();
    found_.unit = placed_.placement.scale;
    decide();
    if (found_.verdict == Verdict::refuse) return std::move(found_);
    bring_onto_target(placed_.placement(head_.points), false);
    doubt();
    correct();
    for (int pass = 1; pass < passes && !found_.alike; ++pass) again();
    read_off();
    return std::move(found_);
  }

 private:
  void read_given();
  void decide();
  void bring_onto_target(PointsD goals, bool given_hold);
  void even_out();
  void again();
  void read_residuals();
  void correct();
  void read_off();
  void doubt();
  double confidence_of(std::size_t row, const SurfaceQuery::Hit& hit) const;

  /// Displacements between the target's model space and the canonical one.
  Eigen::RowVector3d to_canonical(const Eigen::RowVector3d& v) const {
    return v * placed_.placement.rotation / placed_.placement.scale;
  }
  PointsD to_target(const PointsD& v) const {
    return placed_.placement.scale * v * placed_.placement.rotation.transpose();
  }

  const Character& target_;
  const Character& like_;
  const FindLandmarksOptions& options_;
  const TemplateHead head_;
  const SoughtHead sought_;
  const std::vector<LandmarkPoint> like_points_;
  FoundLandmarks found_;
  std::vector<detail::KnownPoint> known_;
  std::vector<int> known_row_,
      known_given_;  // per known point: the template's point, the option's given point
  PlacedHead placed_;
  Registration registration_;
  PointsD points_, normals_;  // per template point: where it was found, which way the guide faces there
  std::vector<detail::Residual> residuals_;
};

void Search::read_given() {
  Character marked;
  marked.nodes = target_.nodes;
  marked.parts = target_.parts;
  marked.landmarks = options_.given;
  const auto given = landmark_points(marked);
  for (std::size_t g = 0; g < given.size(); ++g) {
    for (std::size_t other = 0; other < g; ++other)
      if (given[other].name == given[g].name)
        throw invalid_input("given landmark " + given[g].name, "is there twice", "each name once");
    if (!given[g].position.allFinite())
      throw invalid_input("given landmark " + given[g].name, "is not at a finite place",
                          "a point of the mesh");
    for (std::size_t i = 0; i < like_.landmarks.size(); ++i) {
      if (like_.landmarks[i].name != given[g].name) continue;
      known_.push_back({head_.points.row(static_cast<Eigen::Index>(i)).transpose(), given[g].position});
      known_row_.push_back(static_cast<int>(i));
      known_given_.push_back(static_cast<int>(g));
    }
  }
}

void Search::decide() {
  const bool like_a_face = found_.likeness >= least_likeness;
  if (found_.score < accept_score && like_a_face) {
    found_.verdict = Verdict::accept;
    found_.reason = "the face fits and has a face's relief";
  } else if (found_.score < refuse_score && like_a_face) {
    found_.verdict = Verdict::check;
    found_.reason = "the best placement fits loosely";
  } else if (known_.size() >= 3) {
    found_.verdict = Verdict::check;
    found_.reason = "only the given points say where the face is";
  } else {
    found_.verdict = Verdict::refuse;
    found_.reason =
        like_a_face ? "no placement of a head fits" : "nothing on it has the relief of eyes, nose and mouth";
  }
}

/// What one side of the face is off by from the head to be like, so is the other, by half.
void Search::even_out() {
  const PointsD found = (points_.rowwise() - placed_.placement.translation.transpose()) *
                        placed_.placement.rotation / placed_.placement.scale;
  const PointsD shift = found - head_.points;
  PointsD change = PointsD::Zero(shift.rows(), 3);
  for (Eigen::Index i = 0; i < shift.rows(); ++i) {
    const int other = head_.mirror[at(i)];
    if (other < 0) continue;
    Eigen::RowVector3d image = shift.row(other);
    image.x() *= -1;
    change.row(i) = evenness * (image - shift.row(i));
  }
  points_ += to_target(change);
}

/// The registration once more, from where the landmarks were found.
void Search::again() {
  even_out();
  bring_onto_target(points_, true);
  correct();
}

/// What the given points are off by without their say tells which of them are doubtful; then they may hold.
void Search::bring_onto_target(PointsD goals, bool given_hold) {
  RegistrationOptions registration;
  registration.landmark_trust =
      Eigen::VectorXd::Constant(goals.rows(), found_.alike ? twin_trust : options_.arrangement_trust);
  registration.landmarks_hold = found_.alike;
  registration.progress = options_.progress;
  for (std::size_t k = 0; k < known_.size() && given_hold; ++k) {
    goals.row(known_row_[k]) = known_[k].goal.transpose();
    registration.landmark_trust[known_row_[k]] = 1;
  }
  registration_ = register_surfaces(head_.skin, sought_.skin.surface, head_.points, goals, registration);
  found_.stretch = stretch_of(head_, registration_.guide);
  const SurfaceQuery own(head_.skin.positions, head_.skin.triangles);
  const PointsD guide_normals = vertex_normals(registration_.guide, head_.skin.triangles);
  points_ = normals_ = PointsD::Zero(head_.points.rows(), 3);
  for (Eigen::Index i = 0; i < head_.points.rows(); ++i) {
    const auto hit = own.closest(head_.points.row(i).transpose());
    for (int k = 0; k < 3; ++k) {
      const int v = head_.skin.triangles(hit.triangle, k);
      points_.row(i) += hit.barycentric[k] * registration_.guide.row(v);
      normals_.row(i) += hit.barycentric[k] * guide_normals.row(v);
    }
    normals_.row(i).normalize();
  }
}

void Search::read_residuals() {
  residuals_.clear();
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const Eigen::Index row = known_row_[k];
    residuals_.push_back(
        {known_row_[k], head_.points.row(row), to_canonical(known_[k].goal.transpose() - points_.row(row))});
  }
}

/// Where heads are alike, what remains at the given points says nothing about their surroundings.
void Search::correct() {
  if (found_.alike) return;
  read_residuals();
  points_ += to_target(
      detail::correction(detail::with_mirror_images(residuals_, head_.points, head_.mirror), head_.points));
}

/// Names the given points that the others contradict, and what stands there instead.
void Search::doubt() {
  read_residuals();
  if (residuals_.size() < 2) return;
  const PointsD surprise = detail::surprises(residuals_, head_.points, head_.mirror);
  std::vector<double> size(residuals_.size());
  for (std::size_t k = 0; k < size.size(); ++k) size[k] = surprise.row(static_cast<Eigen::Index>(k)).norm();
  std::vector<double> sorted = size;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double limit = std::max(least_surprise, 4 * sorted[sorted.size() / 2]);
  for (std::size_t k = 0; k < size.size(); ++k) {
    if (size[k] <= limit) continue;
    DoubtfulPoint point;
    point.name = like_.landmarks[at(known_row_[k])].name;
    point.distance = size[k];
    point.expected =
        known_[k].goal - to_target(PointsD(surprise.row(static_cast<Eigen::Index>(k)))).row(0).transpose();
    double nearest = found_.unit * least_surprise;
    for (std::size_t i = 0; i < like_.landmarks.size(); ++i) {
      const double distance = (points_.row(static_cast<Eigen::Index>(i)).transpose() - known_[k].goal).norm();
      if (distance >= nearest || static_cast<int>(i) == known_row_[k]) continue;
      nearest = distance;
      point.looks_like = like_.landmarks[i].name;
    }
    found_.doubtful.push_back(point);
  }
}

/// High where guide and target agree in place and direction, and both sides of the face agree with each other.
double Search::confidence_of(std::size_t row, const SurfaceQuery::Hit& hit) const {
  const Eigen::Index i = static_cast<Eigen::Index>(row);
  const double off = hit.distance / found_.unit / 0.03;
  double apart = 0;
  if (head_.mirror[row] >= 0) {
    const auto canonical = [&](Eigen::Index r) {
      return to_canonical(points_.row(r) - placed_.placement.translation.transpose());
    };
    Eigen::RowVector3d other = canonical(head_.mirror[row]);
    other.x() *= -1;
    apart = (canonical(i) - other).norm() / 0.08;
  }
  const double fit = std::clamp((refuse_score - found_.score) / (refuse_score - accept_score), 0.2, 1.0);
  return std::clamp(fit * std::exp(-off * off - apart * apart), 0.0, 1.0);
}

void Search::read_off() {
  const SurfaceQuery skin(sought_.skin.surface.positions, sought_.skin.surface.triangles);
  const Surface& surface = sought_.skin.surface;
  const auto place = [&](std::size_t row) {
    const Eigen::Vector3d wanted = points_.row(static_cast<Eigen::Index>(row)).transpose(),
                          normal = normals_.row(static_cast<Eigen::Index>(row)).transpose();
    const auto faces_alike = [&](int t, const Eigen::Vector3d&) {
      const Eigen::Vector3d a = surface.positions.row(surface.triangles(t, 0)).transpose(),
                            b = surface.positions.row(surface.triangles(t, 1)).transpose(),
                            c = surface.positions.row(surface.triangles(t, 2)).transpose();
      return (b - a).cross(c - a).dot(normal) > -0.2 * (b - a).cross(c - a).norm();
    };
    const auto gated = skin.closest(wanted, 0.1 * found_.unit, faces_alike);
    return gated.triangle >= 0 ? gated : skin.closest(wanted);
  };
  for (std::size_t i = 0; i < like_.landmarks.size(); ++i) {
    const auto hit = place(i);
    found_.landmarks.push_back({{like_.landmarks[i].name, surface_point(sought_.pool, sought_.skin, hit)},
                                hit.position,
                                confidence_of(i, hit),
                                false});
  }
  for (std::size_t k = 0; k < known_.size(); ++k)
    found_.landmarks[at(known_row_[k])] = {options_.given[at(known_given_[k])], known_[k].goal, 1, true};
  for (std::size_t g = 0; g < options_.given.size(); ++g)
    if (std::find(known_given_.begin(), known_given_.end(), static_cast<int>(g)) == known_given_.end()) {
      Character marked;
      marked.nodes = target_.nodes;
      marked.parts = target_.parts;
      marked.landmarks = {options_.given[g]};
      found_.landmarks.push_back({options_.given[g], landmark_points(marked)[0].position, 1, true});
    }
  std::size_t row = like_.landmarks.size();
  for (const LandmarkCurve& curve : like_.curves) {
    found_.curves.push_back({curve.name, {}, curve.count});
    for (std::size_t i = 0; i < curve.points.size(); ++i)
      found_.curves.back().points.push_back(surface_point(sought_.pool, sought_.skin, place(row++)));
  }
}

}  // namespace

FoundLandmarks find_landmarks(const Character& target, const Character& like,
                              const FindLandmarksOptions& options) {
  const auto hides_some = [](const Character& c) { return shown_part_count(c) < c.parts.size(); };
  if (hides_some(target) || hides_some(like)) return Search(only_shown(target), only_shown(like), options)();
  return Search(target, like, options)();
}

}  // namespace mien
