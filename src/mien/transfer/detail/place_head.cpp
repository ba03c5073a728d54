#include "mien/transfer/detail/place_head.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mien/core/parallel.h"
#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/relief.h"

namespace mien::detail {
namespace {

/// 6 of rigid motion, 1 of scale, 3 of strain.
constexpr int unknowns = 10;
using System = Eigen::Matrix<double, unknowns, unknowns>;
using Vector = Eigen::Matrix<double, unknowns, 1>;

/// One run of closest points.
struct Phase {
  int steps, samples;
  double wide, narrow;  ///< the robust distance at the first and at the last step, face sizes
  bool strains;
};
constexpr Phase glance{4, 120, 0.25, 0.12, false}, coarse{8, 250, 0.2, 0.07, false},
    middle{12, 600, 0.09, 0.03, true}, fine{20, 1200, 0.05, 0.02, true};
/// Below this a placement fits and other orientations need not be tried.
constexpr double good_score = 0.07;
constexpr double least_cosine = 0.2, open_skin = 0.4;
constexpr double tangential = 0.1, strain_penalty = 3e-3;
constexpr double clip = 0.12;

const std::array<Eigen::Matrix3d, 3>& strain_basis() {
  static const std::array<Eigen::Matrix3d, 3> basis = [] {
    std::array<Eigen::Matrix3d, 3> b;
    b[0] = Eigen::Vector3d(1, -1, 0).normalized().asDiagonal();
    b[1] = Eigen::Vector3d(1, 1, -2).normalized().asDiagonal();
    b[2].setZero();
    b[2](1, 2) = b[2](2, 1) = std::sqrt(0.5);
    return b;
  }();
  return basis;
}

/// Evenly spread over the area of the open skin by number: what the template is asked about.
struct TargetSamples {
  PointsD positions, normals;
};

/// Triangles that are not all inside a cavity.
Triangles open_triangles(const SoughtHead& head) {
  const Triangles& all = head.skin.surface.triangles;
  Triangles open(all.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < all.rows(); ++t) {
    double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, head.openness[all(t, k)]);
    if (most > open_skin) open.row(count++) = all.row(t);
  }
  return count > 0 ? Triangles(open.topRows(count)) : all;
}

class Placer {
 public:
  Placer(const TemplateHead& head, const SoughtHead& target, const std::vector<KnownPoint>& known)
      : head_(head),
        target_(target),
        known_(known),
        open_(open_triangles(target)),
        fixed_(target.skin.surface.positions, open_),
        moving_(head.skin.positions, head.skin.triangles) {
    constexpr Eigen::Index most = 1500;
    const Eigen::Index count = target.skin.surface.positions.rows(),
                       step = std::max<Eigen::Index>(1, count / most);
    for (Eigen::Index v = 0; v < count; v += step)
      if (target.openness[v] > open_skin) asked_.push_back(static_cast<int>(v));
  }

  void improve(Placement& p, const Phase& phase) const {
    for (int step = 0; step < phase.steps; ++step) {
      const double t = phase.steps > 1 ? static_cast<double>(step) / (phase.steps - 1) : 1;
      advance(p, phase, phase.wide * std::pow(phase.narrow / phase.wide, t));
    }
  }

  PlacementScore score(const Placement& p, int samples) const;
  /// Adds to the score what needs the target's relief at the placement's scale.
  void compare_relief(PlacedHead& placed);

 private:
  SurfaceQuery::Hit closest(const Eigen::Vector3d& x) const { return fixed_.closest(x); }
  Eigen::Vector3d target_normal(int triangle) const {
    const Triangles& t = open_;
    const PointsD& p = target_.skin.surface.positions;
    const Eigen::Vector3d a = p.row(t(triangle, 0)).transpose(), b = p.row(t(triangle, 1)).transpose(),
                          c = p.row(t(triangle, 2)).transpose();
    return (b - a).cross(c - a).normalized();
  }
  void advance(Placement& p, const Phase& phase, double reach) const;

  const TemplateHead& head_;
  const SoughtHead& target_;
  const std::vector<KnownPoint>& known_;
  Triangles open_;
  SurfaceQuery fixed_, moving_;
  std::map<int, Eigen::VectorXd> relief_;  // by octave of the radius
  std::vector<int> asked_;
};

/// How the point moves with the unknowns: rotation, translation, log scale, strains; canonical axes, scale one.
Eigen::Matrix<double, 3, unknowns> motion_of(const Eigen::Vector3d& point, const Eigen::Vector3d& strained) {
  Eigen::Matrix<double, 3, unknowns> j;
  j.leftCols<3>() << 0, strained.z(), -strained.y(), -strained.z(), 0, strained.x(), strained.y(),
      -strained.x(), 0;
  j.middleCols<3>(3).setIdentity();
  j.col(6) = strained;
  for (int k = 0; k < 3; ++k) j.col(7 + k) = strain_basis()[static_cast<std::size_t>(k)] * point;
  return j;
}

void Placer::advance(Placement& p, const Phase& phase, double reach) const {
  System system = System::Zero();
  Vector right = Vector::Zero();
  double total = 0;
  const Eigen::Matrix3d linear = p.linear(), stretch = Eigen::Matrix3d::Identity() + p.strain;
  const Eigen::Matrix3d turn_normals = p.rotation * stretch.inverse();
  const std::size_t count =
      std::min<std::size_t>(head_.samples.size(), static_cast<std::size_t>(phase.samples));
  for (std::size_t i = 0; i < count; ++i) {
    const int v = head_.samples[i];
    const Eigen::Vector3d at = head_.skin.positions.row(v).transpose();
    const Eigen::Vector3d x = linear * at + p.translation;
    const SurfaceQuery::Hit hit = closest(x);
    const Eigen::Vector3d normal = target_normal(hit.triangle);
    const Eigen::Vector3d own = turn_normals * head_.normals.row(v).transpose();
    if (!(own.dot(normal) > least_cosine * own.norm())) continue;
    const double d = hit.distance / p.scale / reach;
    const double weight = head_.attention[v] / std::pow(1 + d * d, 2);
    const auto j = motion_of(at, stretch * at);
    const Eigen::Vector3d n = p.rotation.transpose() * normal;
    const Eigen::Vector3d gap = p.rotation.transpose() * (hit.position - x) / p.scale;
    const Eigen::Matrix3d w =
        weight * (tangential * Eigen::Matrix3d::Identity() + (1 - tangential) * n * n.transpose());
    system += j.transpose() * w * j;
    right += j.transpose() * w * gap;
    total += weight;
  }
  if (!(total > 0)) return;
  system /= total;
  right /= total;
  const double share = 0.3 * std::min(1.0, static_cast<double>(known_.size()) / 9) /
                       std::max<double>(1, static_cast<double>(known_.size()));
  for (const KnownPoint& point : known_) {
    const Eigen::Vector3d x = linear * point.at + p.translation;
    const Eigen::Vector3d gap = p.rotation.transpose() * (point.goal - x) / p.scale;
    const double weight = share / std::pow(1 + gap.squaredNorm() / (4 * reach * reach), 2);
    const auto j = motion_of(point.at, stretch * point.at);
    system += weight * j.transpose() * j;
    right += weight * j.transpose() * gap;
  }
  for (int k = 0; k < 3; ++k) {
    const double now = strain_basis()[static_cast<std::size_t>(k)].cwiseProduct(p.strain).sum();
    const double stiff = phase.strains ? strain_penalty : 1e9;
    system(7 + k, 7 + k) += stiff;
    right[7 + k] -= phase.strains ? stiff * now : 0;
  }
  system.diagonal().array() += 1e-6;
  const Vector step = system.ldlt().solve(right);
  if (!step.allFinite()) return;
  const Eigen::Vector3d spin = step.head<3>();
  const double angle = spin.norm();
  p.translation += p.scale * p.rotation * step.segment<3>(3);
  if (angle > 0) p.rotation = p.rotation * Eigen::AngleAxisd(angle, spin / angle).toRotationMatrix();
  p.scale *= std::exp(std::clamp(step[6], -0.5, 0.5));
  for (int k = 0; k < 3; ++k) p.strain += step[7 + k] * strain_basis()[static_cast<std::size_t>(k)];
}

PlacementScore Placer::score(const Placement& p, int samples) const {
  PlacementScore score;
  const Eigen::Matrix3d linear = p.linear(), back = linear.inverse();
  const Eigen::Matrix3d turn_normals = p.rotation * (Eigen::Matrix3d::Identity() + p.strain).inverse();
  double weights = 0, turned = 0;
  const std::size_t count = std::min<std::size_t>(head_.samples.size(), static_cast<std::size_t>(samples));
  for (std::size_t i = 0; i < count; ++i) {
    const int v = head_.samples[i];
    const double weight = head_.attention[v] - 0.1;
    const Eigen::Vector3d x = linear * head_.skin.positions.row(v).transpose() + p.translation;
    const SurfaceQuery::Hit hit = closest(x);
    score.forward += weight * std::min(clip, hit.distance / p.scale);
    const Eigen::Vector3d own = (turn_normals * head_.normals.row(v).transpose()).normalized();
    turned += weight * (1 - own.dot(target_normal(hit.triangle)));
    weights += weight;
  }
  score.forward /= weights;
  score.turned = turned / weights;
  double back_weights = 0;
  const std::size_t skip = samples < 600 ? 3 : 1;
  for (std::size_t i = 0; i < asked_.size(); i += skip) {
    const int v = asked_[i];
    const Eigen::Vector3d at = back * (target_.skin.surface.positions.row(v).transpose() - p.translation);
    const double weight = std::exp(-at.squaredNorm() / 0.25);
    if (weight < 0.02) continue;
    score.backward += weight * std::min(clip, moving_.closest(at).distance);
    back_weights += weight;
  }
  score.backward = back_weights > 0 ? score.backward / back_weights : clip;
  score.strain = p.strain.norm();
  return score;
}

void Placer::compare_relief(PlacedHead& placed) {
  const Placement& p = placed.placement;
  const int octave = static_cast<int>(std::lround(2 * std::log2(p.scale / target_.size)));
  Eigen::VectorXd& field = relief_[octave];
  if (field.size() == 0)
    field = relief(target_.skin.surface, target_.normals,
                   relief_radius * target_.size * std::pow(2, octave / 2.0));
  const Eigen::Index count = static_cast<Eigen::Index>(head_.samples.size());
  Eigen::VectorXd own(count), other(count), weights(count);
  const Eigen::Matrix3d linear = p.linear();
  for (Eigen::Index i = 0; i < count; ++i) {
    const int v = head_.samples[static_cast<std::size_t>(i)];
    const auto hit = closest(linear * head_.skin.positions.row(v).transpose() + p.translation);
    own[i] = head_.relief[v];
    other[i] = 0;
    for (int k = 0; k < 3; ++k) other[i] += hit.barycentric[k] * field[open_(hit.triangle, k)];
    weights[i] = head_.attention[v] - 0.1;
  }
  placed.score.relief = correlation(own, other, weights);
}

/// The template at a share of the target's height, its top `lower` below the target's, in the middle of what is there
/// and touching its front.
Placement start_at(const TemplateHead& head, const PointsD& turned, const Eigen::Matrix3d& orientation,
                   const Eigen::Vector3d& share_lower_pitch) {
  const Eigen::RowVector3d low = turned.colwise().minCoeff(), high = turned.colwise().maxCoeff();
  const Eigen::RowVector3d template_low = head.skin.positions.colwise().minCoeff(),
                           template_high = head.skin.positions.colwise().maxCoeff();
  const double height = high.y() - low.y();
  Placement p;
  p.scale = share_lower_pitch[0] * height / (template_high.y() - template_low.y());
  const double middle = high.y() - share_lower_pitch[1] * height - p.scale * template_high.y();
  double left = high.x(), right = low.x(), front = low.z();
  for (Eigen::Index v = 0; v < turned.rows(); ++v) {
    if (std::abs(turned(v, 1) - middle) > 0.2 * p.scale) continue;
    left = std::min(left, turned(v, 0));
    right = std::max(right, turned(v, 0));
    front = std::max(front, turned(v, 2));
  }
  if (left > right) {
    left = low.x();
    right = high.x();
    front = high.z();
  }
  const Eigen::Vector3d place((left + right) / 2, middle, front - p.scale * template_high.z());
  p.rotation = orientation.transpose() *
               Eigen::AngleAxisd(share_lower_pitch[2], Eigen::Vector3d::UnitX()).toRotationMatrix();
  p.translation = orientation.transpose() * place;
  return p;
}

void add_starts(const TemplateHead& head, const SoughtHead& target, const Eigen::Matrix3d& orientation,
                bool few, std::vector<Placement>& starts) {
  const PointsD turned = target.skin.surface.positions * orientation.transpose();
  for (const double share : {1.3, 1.0, 0.85, 0.7, 0.57, 0.45})
    for (const double lower : {-0.12, 0.0, 0.12})
      for (const double pitch : {-0.25, 0.0, 0.25}) {
        if (few && (lower != 0 || pitch != 0 || share == 0.85 || share == 0.57)) continue;
        starts.push_back(start_at(head, turned, orientation, {share, lower, pitch}));
      }
}

/// The rotations of the icosahedron: no orientation is further than 45 degrees from one of them.
std::vector<Eigen::Matrix3d> orientations() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const Eigen::Matrix3d fifth =
      Eigen::AngleAxisd(2 * M_PI / 5, Eigen::Vector3d(0, 1, g).normalized()).toRotationMatrix();
  const Eigen::Matrix3d third =
      Eigen::AngleAxisd(2 * M_PI / 3, Eigen::Vector3d(1, 1, 1).normalized()).toRotationMatrix();
  std::vector<Eigen::Matrix3d> all{Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i < all.size() && all.size() < 120; ++i)
    for (const Eigen::Matrix3d& turn : {fifth, third}) {
      const Eigen::Matrix3d next = all[i] * turn;
      const bool known = std::any_of(all.begin(), all.end(),
                                     [&](const Eigen::Matrix3d& r) { return (r - next).norm() < 1e-6; });
      if (!known) all.push_back(next);
    }
  return all;
}

bool same_basin(const Placement& a, const Placement& b) {
  const double scale = std::max(a.scale, b.scale);
  return (a.translation - b.translation).norm() < 0.1 * scale &&
         std::abs(std::log(a.scale / b.scale)) < 0.15 && (a.rotation - b.rotation).norm() < 0.35;
}

std::vector<PlacedHead> distinct_best(std::vector<PlacedHead> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), [](const PlacedHead& a, const PlacedHead& b) {
    return a.score.total() < b.score.total();
  });
  std::vector<PlacedHead> kept;
  for (const PlacedHead& one : all) {
    if (kept.size() == most) break;
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const PlacedHead& k) { return same_basin(k.placement, one.placement); }))
      kept.push_back(one);
  }
  return kept;
}

std::vector<PlacedHead> run(const Placer& placer, const std::vector<Placement>& starts, const Phase& phase) {
  std::vector<PlacedHead> results(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      results[i].placement = starts[i];
      placer.improve(results[i].placement, phase);
      results[i].score = placer.score(results[i].placement, phase.samples);
    }
  });
  return results;
}

std::vector<Placement> placements(const std::vector<PlacedHead>& heads) {
  std::vector<Placement> all;
  for (const PlacedHead& head : heads) all.push_back(head.placement);
  return all;
}

/// Many starts are first glanced at, and the most hopeful ones improved.
std::vector<PlacedHead> refine(Placer& placer, std::vector<Placement> starts) {
  constexpr std::size_t hopeful = 60;
  if (starts.size() > hopeful) starts = placements(distinct_best(run(placer, starts, glance), hopeful));
  const auto some = distinct_best(run(placer, starts, coarse), 16);
  auto better = run(placer, placements(some), middle);
  for (PlacedHead& one : better) placer.compare_relief(one);
  better = run(placer, placements(distinct_best(better, 4)), fine);
  for (PlacedHead& one : better) placer.compare_relief(one);
  return distinct_best(better, 3);
}

}  // namespace

std::vector<PlacedHead> place_head(const TemplateHead& head, const SoughtHead& target,
                                   const std::vector<KnownPoint>& known, const Progress& progress) {
  Placer placer(head, target, known);
  report_progress(progress, "looking for the face", 0);
  std::vector<Placement> starts;
  if (known.size() >= 3) {
    PointsD from(static_cast<Eigen::Index>(known.size()), 3), to = from;
    for (std::size_t i = 0; i < known.size(); ++i) {
      from.row(static_cast<Eigen::Index>(i)) = known[i].at.transpose();
      to.row(static_cast<Eigen::Index>(i)) = known[i].goal.transpose();
    }
    const Similarity fit = fit_similarity(from, to);
    Placement p;
    p.scale = fit.scale;
    p.rotation = fit.rotation;
    p.translation = fit.translation;
    starts.push_back(p);
  }
  add_starts(head, target, Eigen::Matrix3d::Identity(), false, starts);
  std::vector<PlacedHead> best = refine(placer, starts);
  if (best.front().score.total() < good_score) return best;
  report_progress(progress, "looking for the face in other orientations", 0.3);
  starts.clear();
  for (const Eigen::Matrix3d& orientation : orientations())
    add_starts(head, target, orientation, true, starts);
  for (const PlacedHead& turned : refine(placer, starts)) best.push_back(turned);
  best = distinct_best(best, 3);
  starts.clear();
  add_starts(head, target, best.front().placement.rotation.transpose(), false, starts);
  for (const PlacedHead& again : refine(placer, starts)) best.push_back(again);
  return distinct_best(best, 3);
}

}  // namespace mien::detail
