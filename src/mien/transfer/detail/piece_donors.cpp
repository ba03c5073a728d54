#include "mien/transfer/detail/piece_donors.h"

#include <algorithm>
#include <limits>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/geometry/similarity.h"
#include "mien/transfer/detail/at.h"

namespace mien::detail {
namespace {

/// Source pieces that may give to a target piece: lashes to lashes alone, nothing else that is worn on the skin, skin only to
/// what has no kind, of the same kind and row when both sides say what they are.
std::vector<char> donor_pieces(const PieceInput& in, PieceKind kind, const std::string& name,
                               const std::vector<PieceKind>& source_kinds) {
  std::vector<char> same(source_kinds.size(), 0), any(source_kinds.size(), 0);
  bool found_same = false;
  for (std::size_t p = 0; p < source_kinds.size(); ++p) {
    if (source_kinds[p] == PieceKind::lash) {
      same[p] = is_lash(name) && is_lash(in.source.piece_name[p]);
      found_same = found_same || same[p];
      continue;
    }
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
  constexpr double most_of = 0.8;
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
  // Lashes of both lids, or both eyes, may be one piece: each hair then goes with its own.
  const bool all =
      plan.kind == PieceKind::lash && best_score < most_of * static_cast<double>(plan.vertices.size());
  std::vector<char> group(in.source_skin.size(), 0);
  for (const auto& [other, more] : votes) group[at(other)] = all || moves_alike(in, best, other);
  return group;
}

/// How far donors may be on the median, in face sizes: a piece of the same head; a body in its place.
constexpr double near_head = 0.15, near_body = 0.05;

/// Lower teeth, and what nothing names.
bool may_hang_on_jaw(PieceKind kind, int row) {
  return (kind == PieceKind::teeth && row < 0) || kind == PieceKind::other;
}

/// Turned and scaled, round after round, to where the closest points are.
///   throws  what fit_similarity does: points on one line
PointsD settle(const SurfaceQuery& query, PointsD points) {
  constexpr int rounds = 15;
  for (int round = 0; round < rounds; ++round) {
    PointsD onto(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      onto.row(i) = query.closest(points.row(i).transpose()).position.transpose();
    points = fit_similarity(points, onto)(points);
  }
  return points;
}

}  // namespace

const DonorFinder::Donors& DonorFinder::of(const std::vector<char>& pieces) {
  Donors& donors = known_[pieces];
  if (!donors.query) {
    donors.pieces = select_pieces(in_.source, pieces);
    if (donors.pieces.surface.triangles.rows() > 0)
      donors.query = std::make_unique<SurfaceQuery>(
          PointsD(in_.warped_source(donors.pieces.vertices, Eigen::all)), donors.pieces.surface.triangles);
  }
  return donors;
}

/// The places on the donor pieces closest to the piece's vertices (where they lie: `positions`); the number of them on
/// each donor.
std::map<int, int> DonorFinder::closest_on(const Donors& donors, const PointsD& positions, PiecePlan& plan,
                                           double& median_distance) const {
  std::map<int, int> votes;
  plan.places.triangle.clear();
  plan.places.barycentric.clear();
  median_distance = std::numeric_limits<double>::infinity();
  if (!donors.query) return votes;
  const auto count = static_cast<std::size_t>(positions.rows());
  std::vector<double> distance(count);
  plan.places.triangle.resize(count);
  plan.places.barycentric.resize(count);
  parallel_for(count, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto hit = donors.query->closest(positions.row(static_cast<Eigen::Index>(i)).transpose());
      distance[i] = hit.distance;
      plan.places.triangle[i] = donors.pieces.triangles[at(hit.triangle)];
      plan.places.barycentric[i] = hit.barycentric;
    }
  });
  for (const int t : plan.places.triangle) ++votes[in_.source.piece[at(in_.source.triangles(t, 0))]];
  std::nth_element(distance.begin(), distance.begin() + static_cast<long>(distance.size() / 2),
                   distance.end());
  median_distance = distance[distance.size() / 2];
  return votes;
}

/// The points moved so that their box, along the head's own axes, is the others'.
PointsD DonorFinder::box_onto_box(const PointsD& points, const PointsD& others) const {
  const PointsD a = points * axes_, b = others * axes_;
  const Eigen::RowVector3d low = a.colwise().minCoeff(), size = a.colwise().maxCoeff() - low;
  const Eigen::RowVector3d to = b.colwise().minCoeff(), to_size = b.colwise().maxCoeff() - to;
  PointsD moved = a.rowwise() - low;
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] > 0) moved.col(axis) *= to_size[axis] / size[axis];
  return (moved.rowwise() + to) * axes_.transpose();
}

/// The piece's vertices where they lie on its donors. The warp of the head follows the skin: what bends by itself may lie
/// elsewhere in the head, be longer and point another way.
PointsD DonorFinder::lay_on_donors(const SurfaceQuery& donors, const PointsD& positions,
                                   const PiecePlan& plan) const {
  const PointsD boxed = box_onto_box(positions, in_.warped_source(plan.donor_vertices, Eigen::all));
  if (plan.kind != PieceKind::tongue) return boxed;
  try {
    return settle(donors, boxed);
  } catch (const Error&) {
    return boxed;  // a sliver, which has no way to turn
  }
}

/// Whether any of the pieces is skin, moves in a shape or hangs on a joint. What may hang on the jaw and has found what stands
/// still in every shape goes with the jaw; lower teeth with bodies in their place that do move, where a source keeps its lower
/// teeth in another part.
bool DonorFinder::moves(const std::vector<char>& group) const {
  for (std::size_t p = 0; p < group.size(); ++p)
    if (group[p] && (in_.source_skin[p] || in_.source_motion[p].signature.norm() > 0)) return true;
  return false;
}

std::vector<char> DonorFinder::moving_bodies() const {
  std::vector<char> bodies(kinds_.size(), 0);
  for (std::size_t p = 0; p < bodies.size(); ++p)
    bodies[p] = !in_.source_skin[p] && kinds_[p] != PieceKind::eye && kinds_[p] != PieceKind::lash &&
                in_.source_motion[p].bend <= rigid_bend && in_.source_motion[p].signature.norm() > 0;
  return bodies;
}

double DonorFinder::mean_distance(const std::vector<char>& pieces, const PointsD& positions) {
  const SurfaceQuery& query = *of(pieces).query;
  double sum = 0;
  for (Eigen::Index i = 0; i < positions.rows(); ++i)
    sum += query.closest(positions.row(i).transpose()).distance;
  return sum / static_cast<double>(positions.rows());
}

/// Of the donors of a body of `count` vertices those that are bodies, if a tenth of it is next to some.
void DonorFinder::keep_bodies(const std::map<int, int>& votes, double count,
                              std::vector<char>& pieces) const {
  constexpr double least = 0.1;
  std::vector<char> bodies = pieces;
  double own = 0;
  for (const auto& [piece, vote] : votes) {
    if (!pieces[at(piece)]) continue;
    bodies[at(piece)] = in_.source_motion[at(piece)].bend <= rigid_bend;
    if (bodies[at(piece)]) own += vote;
  }
  if (own >= least * count) pieces = bodies;
}

/// The donors of a piece that nothing names. What is in the mouth is surrounded by skin, and what lies on an eye (a tear, a
/// shadow) belongs to the lids: so a quarter of the votes speaks for teeth and tongue, and hardly less than all for an eye.
/// A piece that reaches as far as they do (gums) moves with what is next to each vertex; a smaller one with the body that is
/// closest to it as a whole, for closed rows of teeth lie side by side.
std::vector<char> DonorFinder::group_of_unnamed(const std::map<int, int>& votes, const PointsD& positions,
                                                bool rigid) {
  constexpr double least_inside = 0.25, least_eye = 0.8, as_far = 0.7;
  std::vector<char> skin(in_.source_skin.size(), 0), eyes = skin, inside = skin;
  double inside_votes = 0, eye_votes = 0;
  for (const auto& [piece, count] : votes) {
    const bool eye = kinds_[at(piece)] == PieceKind::eye;
    (in_.source_skin[at(piece)] ? skin : eye ? eyes : inside)[at(piece)] = 1;
    if (!in_.source_skin[at(piece)]) (eye ? eye_votes : inside_votes) += count;
  }
  const auto all = static_cast<double>(positions.rows());
  if (eye_votes >= least_eye * all) return eyes;
  if (inside_votes < least_inside * all) return eye_votes + inside_votes < all ? skin : eyes;
  if (rigid) keep_bodies(votes, all, inside);
  const PointsD donors = in_.warped_source(of(inside).pieces.vertices, Eigen::all);
  if (bounding_box(positions).diagonal() > as_far * bounding_box(donors).diagonal()) return inside;
  std::vector<char> best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [leader, count] : votes) {
    if (!inside[at(leader)]) continue;
    std::vector<char> body(inside.size(), 0);
    for (std::size_t p = 0; p < inside.size(); ++p)
      body[p] = inside[p] && moves_alike(in_, leader, static_cast<int>(p));
    const double distance = mean_distance(body, positions);
    if (distance >= least) continue;
    least = distance;
    best = body;
  }
  return best;
}

bool DonorFinder::find(PiecePlan& plan) {
  const std::string& name = in_.target.piece_name[at(plan.piece)];
  const PointsD positions = in_.target.positions(plan.vertices, Eigen::all);
  double distance = 0;
  auto votes = closest_on(of(donor_pieces(in_, plan.kind, name, kinds_)), positions, plan, distance);
  if (votes.empty() || distance > near_head * in_.unit) return false;
  auto group = plan.kind == PieceKind::other ? group_of_unnamed(votes, positions, plan.rigid)
                                             : choose_group(in_, votes, plan, row_from_name(name));
  if (may_hang_on_jaw(plan.kind, row_from_name(name)) && !moves(group)) {
    if (plan.kind == PieceKind::other) return false;
    group = moving_bodies();
    votes = closest_on(of(group), positions, plan, distance);
    if (votes.empty() || distance > near_body * in_.unit) return false;
  }
  plan.same_kind = plan.kind != PieceKind::other;
  for (std::size_t p = 0; p < group.size(); ++p) {
    if (!group[p]) continue;
    plan.same_kind = plan.same_kind && kinds_[p] == plan.kind;
    plan.from_skin = plan.from_skin || in_.source_skin[p];
    const auto members = vertices_of(in_.source, static_cast<int>(p));
    plan.donor_vertices.insert(plan.donor_vertices.end(), members.begin(), members.end());
  }
  const Donors& donors = of(group);
  const bool laid = plan.same_kind && (plan.kind == PieceKind::tongue || plan.kind == PieceKind::lash);
  const bool all_in_group =
      std::all_of(votes.begin(), votes.end(), [&](const auto& vote) { return group[at(vote.first)]; });
  if (laid)
    closest_on(donors, lay_on_donors(*donors.query, positions, plan), plan, distance);
  else if (!all_in_group)
    closest_on(donors, positions, plan, distance);
  return true;
}

}  // namespace mien::detail
