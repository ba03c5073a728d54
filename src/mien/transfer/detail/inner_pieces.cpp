// Rigid pieces (an eyeball, a row of teeth) must stay rigid: interpolating the motion of whatever lies closest bends
// them. So the donors' motion is first looked at as a whole; when it is a rigid motion, the target's piece makes the
// same rotation about its own centre and the same translation, scaled. Only what bends on the source (a tongue) bends.
#include "mien/transfer/detail/inner_pieces.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/at.h"

namespace mien::detail {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool has(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* w) { return text.find(w) != std::string::npos; });
}

/// +1 upper, -1 lower, 0 not said.
int row_from_name(const std::string& name) {
  const std::string n = lower(name);
  return has(n, {"upper", "top"}) ? 1 : has(n, {"lower", "bottom"}) ? -1 : 0;
}

PointsD rows(const PointsD& points, const std::vector<int>& which) {
  PointsD result(static_cast<Eigen::Index>(which.size()), 3);
  for (std::size_t i = 0; i < which.size(); ++i)
    result.row(static_cast<Eigen::Index>(i)) = points.row(which[i]);
  return result;
}

std::vector<int> vertices_of(const Pool& pool, int piece) {
  std::vector<int> result;
  for (std::size_t v = 0; v < pool.piece.size(); ++v)
    if (pool.piece[v] == piece) result.push_back(static_cast<int>(v));
  return result;
}

/// A ball: distances from the centre of the box differ little. Half-balls and eyes with a cornea pass.
bool is_ball(const PointsD& points, double unit) {
  const Eigen::RowVector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const Eigen::RowVector3d size = high - low;
  if (points.rows() < 20 || size.maxCoeff() > 0.5 * unit || size.minCoeff() < 0.6 * size.maxCoeff())
    return false;
  const Eigen::VectorXd radius = (points.rowwise() - (low + high) / 2).rowwise().norm();
  return radius.minCoeff() > 0.7 * radius.maxCoeff();
}

PieceKind kind_of(const Pool& pool, int piece, double unit) {
  const PieceKind named = kind_from_name(pool.piece_name[at(piece)]);
  if (named != PieceKind::other) return named;
  return is_ball(rows(pool.positions, vertices_of(pool, piece)), unit) ? PieceKind::eye : PieceKind::other;
}

/// Source pieces that may give to a target piece: not worn on the skin, skin only to what has no kind, of the same kind and row when both
/// sides say what they are.
std::vector<char> donor_pieces(const PieceInput& in, PieceKind kind, const std::string& name,
                               const std::vector<PieceKind>& source_kinds) {
  std::vector<char> same(source_kinds.size(), 0), any(source_kinds.size(), 0);
  bool found_same = false;
  for (std::size_t p = 0; p < source_kinds.size(); ++p) {
    if (source_kinds[p] == PieceKind::lash) continue;
    if (in.source_skin[p]) {
      // A loose mouth bag is part of many a source's skin.
      any[p] = kind == PieceKind::other;
      continue;
    }
    const int row = row_from_name(name), source_row = row_from_name(in.source.piece_name[p]);
    if (row * source_row < 0) continue;
    const bool eye = kind == PieceKind::eye, source_eye = source_kinds[p] == PieceKind::eye;
    any[p] = eye == source_eye || kind == PieceKind::other;
    same[p] = kind != PieceKind::other && source_kinds[p] == kind;
    found_same = found_same || same[p];
  }
  return found_same ? same : any;
}

/// Donor pieces ready to be asked; many target pieces ask the same.
struct DonorSurface {
  PoolSurface pieces;
  std::unique_ptr<SurfaceQuery> query;
};
class DonorSurfaces {
 public:
  explicit DonorSurfaces(const PieceInput& in) : in_(in) {}
  const DonorSurface& of(const std::vector<char>& donors) {
    DonorSurface& surface = known_[donors];
    if (!surface.query) {
      surface.pieces = select_pieces(in_.source, donors);
      if (surface.pieces.surface.triangles.rows() > 0)
        surface.query = std::make_unique<SurfaceQuery>(rows(in_.warped_source, surface.pieces.vertices),
                                                       surface.pieces.surface.triangles);
    }
    return surface;
  }

 private:
  const PieceInput& in_;
  std::map<std::vector<char>, DonorSurface> known_;
};

/// The places on the donor pieces closest to the piece's vertices; the number of them on each donor.
std::map<int, int> closest_on(const PieceInput& in, const DonorSurface& donors, PiecePlan& plan,
                              double& median_distance) {
  std::map<int, int> votes;
  plan.triangle.clear();
  plan.barycentric.clear();
  median_distance = std::numeric_limits<double>::infinity();
  if (!donors.query) return votes;
  std::vector<double> distance;
  for (const int v : plan.vertices) {
    const auto hit = donors.query->closest(in.target.positions.row(v).transpose());
    distance.push_back(hit.distance);
    plan.triangle.push_back(donors.pieces.triangles[at(hit.triangle)]);
    plan.barycentric.push_back(hit.barycentric);
    ++votes[in.source.piece[at(in.source.triangles(plan.triangle.back(), 0))]];
  }
  std::nth_element(distance.begin(), distance.begin() + static_cast<long>(distance.size() / 2),
                   distance.end());
  median_distance = distance[distance.size() / 2];
  return votes;
}

constexpr double rigid_bend = 0.12;

/// Rigid pieces that make the same motion (the teeth of one jaw) count as one; what bends stands alone.
bool moves_alike(const PieceInput& in, int a, int b) {
  const PieceMotion &ma = in.source_motion[at(a)], &mb = in.source_motion[at(b)];
  if (a == b) return true;
  if (ma.bend > rigid_bend || mb.bend > rigid_bend) return false;
  const double size = std::max(ma.signature.norm(), mb.signature.norm());
  return (ma.signature - mb.signature).norm() <= 0.3 * size + 1e-3 * in.unit / in.similarity.scale;
}

/// Of the pieces with votes the group that the piece should move with: the one its name asks for (lower teeth move more
/// than upper), else the one with most votes.
std::vector<char> choose_group(const PieceInput& in, const std::map<int, int>& votes, const PiecePlan& plan,
                               int row) {
  int best = -1;
  double best_score = -std::numeric_limits<double>::infinity();
  for (const auto& [leader, own] : votes) {
    int count = 0;
    for (const auto& [other, more] : votes) count += moves_alike(in, leader, other) ? more : 0;
    const bool counts = count >= 0.1 * static_cast<double>(plan.vertices.size()) &&
                        in.source_motion[at(leader)].bend <= rigid_bend;
    const double motion = in.source_motion[at(leader)].signature.norm();
    double score = count;
    if (plan.kind == PieceKind::teeth && row != 0)
      score = counts ? (row < 0 ? motion : -motion) : score - 1e9;
    if (score <= best_score) continue;
    best_score = score;
    best = leader;
  }
  std::vector<char> group(in.source_skin.size(), 0);
  for (const auto& [other, more] : votes) group[at(other)] = moves_alike(in, best, other);
  return group;
}

/// Where the piece's donors are, or false when nothing of the source lies near.
bool find_donors(const PieceInput& in, const std::vector<char>& donors, const std::vector<PieceKind>& kinds,
                 DonorSurfaces& surfaces, PiecePlan& plan) {
  double distance = 0;
  const auto votes = closest_on(in, surfaces.of(donors), plan, distance);
  if (votes.empty() || distance > 0.15 * in.unit) return false;
  const auto group = choose_group(in, votes, plan, row_from_name(in.target.piece_name[at(plan.piece)]));
  closest_on(in, surfaces.of(group), plan, distance);
  plan.same_kind = plan.kind != PieceKind::other;
  for (std::size_t p = 0; p < group.size(); ++p) {
    if (!group[p]) continue;
    plan.same_kind = plan.same_kind && kinds[p] == plan.kind;
    const auto members = vertices_of(in.source, static_cast<int>(p));
    plan.donor_vertices.insert(plan.donor_vertices.end(), members.begin(), members.end());
  }
  return true;
}

/// Gives every vertex well off the skin the place of the nearest vertex that is close to it: a lash's tip moves with its
/// root, not with whatever skin lies behind it.
void hold_by_roots(const PieceInput& in, std::vector<double> distance, PiecePlan& plan) {
  std::vector<double> sorted = distance;
  const auto third = sorted.begin() + static_cast<long>(sorted.size() / 3);
  std::nth_element(sorted.begin(), third, sorted.end());
  const double close = *third;
  for (std::size_t i = 0; i < plan.vertices.size(); ++i) {
    if (distance[i] <= close) continue;
    std::size_t root = i;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < plan.vertices.size(); ++j) {
      const double d =
          (in.target.positions.row(plan.vertices[i]) - in.target.positions.row(plan.vertices[j])).norm();
      if (distance[j] > close || d >= best) continue;
      best = d;
      root = j;
    }
    plan.triangle[i] = plan.triangle[root];
    plan.barycentric[i] = plan.barycentric[root];
    plan.fade[i] = plan.fade[root];
  }
}

struct SkinFit {
  double mean_distance = 0, behind = 0;  // share of vertices that lie behind the skin
};

/// The closest place on the target's skin for every vertex of the piece.
SkinFit find_skin(const PieceInput& in, const SurfaceQuery& skin, PiecePlan& plan) {
  SkinFit fit;
  std::vector<double> distances;
  const Triangles& triangles = in.target_surface.surface.triangles;
  const PointsD& positions = in.target_surface.surface.positions;
  plan.triangle.clear();
  plan.barycentric.clear();
  for (const int v : plan.vertices) {
    const Eigen::Vector3d position = in.target.positions.row(v).transpose();
    const auto hit = skin.closest(position);
    const auto corner = [&](int k) { return Eigen::Vector3d(positions.row(triangles(hit.triangle, k))); };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    plan.triangle.push_back(hit.triangle);
    plan.barycentric.push_back(hit.barycentric);
    distances.push_back(hit.distance);
    plan.fade.push_back(std::exp(-std::pow(hit.distance / (0.15 * in.unit), 2)));
    fit.mean_distance += hit.distance / static_cast<double>(plan.vertices.size());
    fit.behind += (normal.dot(position - hit.position) < 0) / static_cast<double>(plan.vertices.size());
  }
  // Brows lie on the skin all along; lashes stand off it.
  if (has(lower(in.target.piece_name[at(plan.piece)]), {"lash"})) hold_by_roots(in, distances, plan);
  return fit;
}

/// R (x - centre) + centre + shift.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
  double residual = 0;  // rms of what is not rigid over rms of the motion
};

RigidMotion fit_rigid(const PointsD& rest, const PointsD& delta) {
  RigidMotion motion;
  motion.centre = rest.colwise().mean().transpose();
  motion.shift = delta.colwise().mean().transpose();
  const PointsD a = rest.rowwise() - motion.centre.transpose();
  const PointsD b = (rest + delta).rowwise() - (motion.centre + motion.shift).transpose();
  motion.rotation = closest_rotation(b.transpose() * a);
  const double total = delta.norm();
  motion.residual = total > 0 ? (b - a * motion.rotation.transpose()).norm() / total : 0;
  return motion;
}

PointsD apply_rigid(const RigidMotion& motion, const PointsD& positions) {
  const PointsD centred = positions.rowwise() - motion.centre.transpose();
  return (centred * motion.rotation.transpose() - centred).rowwise() + motion.shift.transpose();
}

PointsD carry_from_donors(const PieceInput& in, const PiecePlan& plan, const PointsD& source_delta) {
  const PointsD rest = rows(in.source.positions, plan.donor_vertices);
  const PointsD delta = rows(source_delta, plan.donor_vertices);
  const PointsD own = rows(in.target.positions, plan.vertices);
  const Eigen::Matrix3d& turn = in.similarity.rotation;
  if (!(delta.cwiseAbs().maxCoeff() > 0)) return PointsD::Zero(own.rows(), 3);
  const RigidMotion motion = fit_rigid(rest, delta);
  if (motion.residual < rigid_bend) {
    RigidMotion carried;
    carried.rotation = turn * motion.rotation * turn.transpose();
    carried.centre = own.colwise().mean().transpose();
    carried.shift = plan.growth * (turn * motion.shift);
    return apply_rigid(carried, own);
  }
  PointsD result = PointsD::Zero(own.rows(), 3);
  for (std::size_t i = 0; i < plan.vertices.size(); ++i) {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      d += plan.barycentric[i][k] * source_delta.row(in.source.triangles(plan.triangle[i], k)).transpose();
    result.row(static_cast<Eigen::Index>(i)) = plan.growth * (turn * d).transpose();
  }
  return result;
}

PointsD carry_from_skin(const PieceInput& in, const PiecePlan& plan, const PointsD& skin_delta) {
  PointsD result(static_cast<Eigen::Index>(plan.vertices.size()), 3);
  for (std::size_t i = 0; i < plan.vertices.size(); ++i) {
    Eigen::RowVector3d d = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 3; ++k)
      d += plan.barycentric[i][k] * skin_delta.row(in.target_surface.surface.triangles(plan.triangle[i], k));
    result.row(static_cast<Eigen::Index>(i)) = plan.fade[i] * d;
  }
  return result;
}

/// The skin beneath as a rigid body; taken back where it is none (a lip that is pulled down does not move the teeth).
PointsD carry_with_jaw(const PieceInput& in, const PiecePlan& plan, const PointsD& skin_delta) {
  PiecePlan beneath = plan;
  std::fill(beneath.fade.begin(), beneath.fade.end(), 1.0);
  const PointsD own = rows(in.target.positions, plan.vertices);
  const PointsD delta = carry_from_skin(in, beneath, skin_delta);
  if (!(delta.cwiseAbs().maxCoeff() > 0)) return PointsD::Zero(own.rows(), 3);
  const RigidMotion motion = fit_rigid(own, delta);
  const double share = std::clamp((0.6 - motion.residual) / 0.35, 0.0, 1.0);
  return share * apply_rigid(motion, own);
}

}  // namespace

PieceKind kind_from_name(const std::string& name) {
  // Of "part: group" the group knows better: a part of eyes and lashes has groups of either.
  const std::size_t colon = name.rfind(": ");
  if (colon != std::string::npos) {
    const PieceKind group = kind_from_name(name.substr(colon + 2));
    return group != PieceKind::other ? group : kind_from_name(name.substr(0, colon));
  }
  const std::string n = lower(name);
  if (has(n, {"lash", "brow", "beard", "hair", "mustache", "moustache"})) return PieceKind::lash;
  if (has(n, {"teeth", "tooth", "gum", "denture"})) return PieceKind::teeth;
  if (has(n, {"tongue"})) return PieceKind::tongue;
  if (has(n, {"eye", "cornea", "iris", "pupil", "sclera"}) && !has(n, {"lid"})) return PieceKind::eye;
  return PieceKind::other;
}

std::vector<PieceMotion> piece_motions(const Pool& source, const std::vector<char>& skin, std::size_t shapes,
                                       const std::function<PointsD(std::size_t)>& deltas,
                                       const WeightMatrix& weights, double unit) {
  const std::size_t count = at(source.piece_count);
  std::vector<std::vector<int>> members(count);
  for (std::size_t v = 0; v < source.piece.size(); ++v)
    members[at(source.piece[v])].push_back(static_cast<int>(v));
  const Eigen::Index width = 3 * static_cast<Eigen::Index>(shapes);
  std::vector<PieceMotion> motions(count);
  std::vector<double> bent(count, 0), moved(count, 0);
  for (PieceMotion& motion : motions) motion.signature = Eigen::VectorXd::Zero(width + weights.cols());
  for (std::size_t s = 0; s < shapes; ++s) {
    const PointsD delta = deltas(s);
    for (std::size_t p = 0; p < count; ++p) {
      if (skin[p]) continue;
      const PointsD own = rows(delta, members[p]);
      if (!(own.cwiseAbs().maxCoeff() > 0)) continue;
      const RigidMotion rigid = fit_rigid(rows(source.positions, members[p]), own);
      motions[p].signature.segment<3>(3 * static_cast<Eigen::Index>(s)) = rigid.shift;
      bent[p] += std::pow(rigid.residual * own.norm(), 2);
      moved[p] += own.squaredNorm();
    }
  }
  for (std::size_t p = 0; p < count; ++p) {
    for (const int v : weights.rows() > 0 ? members[p] : std::vector<int>())
      for (WeightMatrix::InnerIterator entry(weights, v); entry; ++entry)
        motions[p].signature[width + entry.col()] +=
            unit * entry.value() / static_cast<double>(members[p].size());
    motions[p].bend = skin[p] ? 1 : moved[p] > 0 ? std::sqrt(bent[p] / moved[p]) : 0;
  }
  return motions;
}

std::vector<PiecePlan> plan_pieces(const PieceInput& in) {
  std::vector<PieceKind> source_kinds;
  for (int p = 0; p < in.source.piece_count; ++p)
    source_kinds.push_back(in.source_skin[at(p)] ? PieceKind::skin
                                                 : kind_of(in.source, p, in.unit / in.similarity.scale));
  const SurfaceQuery skin(in.target_surface.surface.positions, in.target_surface.surface.triangles);
  DonorSurfaces surfaces(in);
  std::vector<PiecePlan> plans;
  for (int p = 0; p < in.target.piece_count; ++p) {
    if (in.target_skin[at(p)]) continue;
    PiecePlan plan;
    plan.piece = p;
    plan.kind = kind_of(in.target, p, in.unit);
    plan.vertices = vertices_of(in.target, p);
    plan.growth = in.similarity.scale;
    const auto donors = donor_pieces(in, plan.kind, in.target.piece_name[at(p)], source_kinds);
    if (plan.kind != PieceKind::lash && find_donors(in, donors, source_kinds, surfaces, plan)) {
      plan.way = PiecePlan::Way::donors;
    } else {
      const SkinFit fit = find_skin(in, skin, plan);
      const bool worn =
          plan.kind == PieceKind::lash ||
          (plan.kind == PieceKind::other && (fit.behind < 0.5 || fit.mean_distance < 0.02 * in.unit));
      if (worn)
        plan.way = PiecePlan::Way::attached;
      else if (plan.kind == PieceKind::eye)
        plan.way = PiecePlan::Way::still;
      else
        plan.way = PiecePlan::Way::jaw;
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

PiecePoints piece_points(const PieceInput& in, const std::vector<PiecePlan>& plans) {
  std::vector<Eigen::RowVector3d> aligned, target;
  // Boxes along the head's own axes: turning a head turns its boxes.
  const PointsD centred = in.warped_source.rowwise() - in.warped_source.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> head(centred.transpose() * centred);
  const Eigen::Matrix3d axes = head.eigenvectors();
  const auto add_box = [&](const PointsD& points, std::vector<Eigen::RowVector3d>& list) {
    const PointsD along = points * axes;
    const Eigen::RowVector3d low = along.colwise().minCoeff(), high = along.colwise().maxCoeff();
    const Eigen::RowVector3d middle = (low + high) / 2;
    const std::size_t first = list.size();
    list.push_back(middle);
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {low[axis], high[axis]}) {
        list.push_back(middle);
        list.back()[axis] = side;
      }
    for (std::size_t i = first; i < list.size(); ++i) list[i] = list[i] * axes.transpose();
  };
  for (const PiecePlan& plan : plans) {
    if (plan.way != PiecePlan::Way::donors || !plan.same_kind) continue;
    add_box(in.similarity(rows(in.source.positions, plan.donor_vertices)), aligned);
    add_box(rows(in.target.positions, plan.vertices), target);
  }
  PiecePoints points{PointsD(static_cast<Eigen::Index>(aligned.size()), 3),
                     PointsD(static_cast<Eigen::Index>(target.size()), 3)};
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    points.aligned.row(static_cast<Eigen::Index>(i)) = aligned[i];
    points.target.row(static_cast<Eigen::Index>(i)) = target[i];
  }
  return points;
}

PointsD carry_piece(const PieceInput& in, const PiecePlan& plan, const PointsD& source_delta,
                    const PointsD& skin_delta) {
  switch (plan.way) {
    case PiecePlan::Way::donors:
      return carry_from_donors(in, plan, source_delta);
    case PiecePlan::Way::attached:
      return carry_from_skin(in, plan, skin_delta);
    case PiecePlan::Way::jaw:
      return carry_with_jaw(in, plan, skin_delta);
    case PiecePlan::Way::still:
      break;
  }
  return PointsD::Zero(static_cast<Eigen::Index>(plan.vertices.size()), 3);
}

WeightMatrix carry_piece_rows(const PieceInput& in, const PiecePlan& plan, const WeightMatrix& source_rows,
                              const WeightMatrix& skin_rows) {
  const bool donors = plan.way == PiecePlan::Way::donors;
  const Triangles& triangles = donors ? in.source.triangles : in.target_surface.surface.triangles;
  const WeightMatrix& rows = donors ? source_rows : skin_rows;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < plan.vertices.size() && plan.way != PiecePlan::Way::still; ++i)
    for (int k = 0; k < 3; ++k)
      for (WeightMatrix::InnerIterator entry(rows, triangles(plan.triangle[i], k)); entry; ++entry)
        entries.emplace_back(static_cast<int>(i), static_cast<int>(entry.col()),
                             plan.barycentric[i][k] * entry.value());
  WeightMatrix result(static_cast<Eigen::Index>(plan.vertices.size()), rows.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

WeightMatrix carry_piece_weights(const PieceInput& in, const PiecePlan& plan,
                                 const WeightMatrix& source_weights, const WeightMatrix& skin_weights,
                                 int head_joint) {
  WeightMatrix weights = carry_piece_rows(in, plan, source_weights, skin_weights);
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    if (!(weights.row(v).sum() > 0)) weights.coeffRef(v, head_joint) = 1;
  return weights;
}

std::string_view name_of(PieceKind kind) {
  constexpr std::array<std::string_view, 6> names{"skin", "eye", "teeth", "tongue", "lash", "other"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(PiecePlan::Way way) {
  constexpr std::array<std::string_view, 4> names{"source part", "skin beneath", "jaw", "still"};
  return names[static_cast<std::size_t>(way)];
}

}  // namespace mien::detail
