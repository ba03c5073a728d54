// Rigid pieces (an eyeball, a row of teeth) must stay rigid: interpolating the motion of whatever lies closest bends
// them. So the donors' motion is first looked at as a whole; when it is a rigid motion, the target's piece makes the
// same rotation about its own centre and the same translation, scaled. Only what bends on the source (a tongue) bends.
#include "mien/transfer/detail/inner_pieces.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/piece_donors.h"

namespace mien::detail {
namespace {

/// In face sizes, root included.
constexpr double largest_tooth = 0.22;
/// A piece that is closer to the skin on average lies on it, in face sizes.
constexpr double on_skin_within = 0.02;

double closest_third(std::vector<double> distances) {
  const auto third = distances.begin() + static_cast<long>(distances.size() / 3);
  std::nth_element(distances.begin(), third, distances.end());
  return *third;
}

/// Gives every vertex well off the skin the place of the nearest vertex that is close to it: a lash's tip moves with its
/// root, not with whatever skin lies behind it.
void hold_by_roots(const PieceInput& in, const std::vector<double>& distance, PiecePlan& plan) {
  const double close = closest_third(distance);
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
    plan.places.triangle[i] = plan.places.triangle[root];
    plan.places.barycentric[i] = plan.places.barycentric[root];
    plan.fade[i] = plan.fade[root];
  }
}

/// What is close to the skin hangs on it, and the rest follows over the piece's own surface, as a harmonic field: a film
/// between the lids goes with both.
void stretch_between(const PieceInput& in, const std::vector<double>& distance, PiecePlan& plan) {
  const double close = closest_third(distance);
  std::vector<SourcePoint> points;
  for (std::size_t i = 0; i < distance.size(); ++i)
    points.push_back(
        {plan.places.triangle[i], plan.places.barycentric[i], distance[i], distance[i] <= close});
  plan.film = std::make_shared<const AttributeCarrier>(std::move(points), in.target_surface.surface,
                                                       one_piece(in.target, plan.piece).surface);
  std::fill(plan.fade.begin(), plan.fade.end(), 1.0);
}

/// A body (a tooth) encloses its inside; what is worn on the skin is a sheet.
bool is_solid(const Pool& pool, int piece) {
  const PoolSurface chosen = one_piece(pool, piece);
  const std::vector<char> border = boundary_vertices(chosen.vertices.size(), chosen.surface.triangles);
  return std::none_of(border.begin(), border.end(), [](char on) { return on != 0; });
}

/// Whether a piece that hangs on the skin rises from it.
bool stands_off(std::vector<double> distances, double unit) {
  constexpr double rooted = 0.004, risen = 0.01;
  std::sort(distances.begin(), distances.end());
  return distances[distances.size() / 10] < rooted * unit &&
         distances[distances.size() * 9 / 10] > risen * unit;
}

struct SkinFit {
  double mean_distance = 0, behind = 0;  // share of vertices that lie behind the skin
  std::vector<double> distances;         // of each vertex
};

/// The closest place on the target's skin for every vertex of the piece.
SkinFit find_skin(const PieceInput& in, const SurfaceQuery& skin, PiecePlan& plan) {
  SkinFit fit;
  const Triangles& triangles = in.target_surface.surface.triangles;
  const PointsD& positions = in.target_surface.surface.positions;
  plan.places.triangle.clear();
  plan.places.barycentric.clear();
  for (const int v : plan.vertices) {
    const Eigen::Vector3d position = in.target.positions.row(v).transpose();
    const auto hit = skin.closest(position);
    const auto corner = [&](int k) { return Eigen::Vector3d(positions.row(triangles(hit.triangle, k))); };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    plan.places.triangle.push_back(hit.triangle);
    plan.places.barycentric.push_back(hit.barycentric);
    fit.distances.push_back(hit.distance);
    plan.fade.push_back(std::exp(-std::pow(hit.distance / (0.15 * in.unit), 2)));
    fit.mean_distance += hit.distance / static_cast<double>(plan.vertices.size());
    fit.behind += (normal.dot(position - hit.position) < 0) / static_cast<double>(plan.vertices.size());
  }
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
  const PointsD rest = in.source.positions(plan.donor_vertices, Eigen::all);
  const PointsD delta = source_delta(plan.donor_vertices, Eigen::all);
  const PointsD own = in.target.positions(plan.vertices, Eigen::all);
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
      d += plan.places.barycentric[i][k] *
           source_delta.row(in.source.triangles(plan.places.triangle[i], k)).transpose();
    result.row(static_cast<Eigen::Index>(i)) = plan.growth * (turn * d).transpose();
  }
  return plan.rigid ? apply_rigid(fit_rigid(own, result), own) : result;
}

PointsD carry_from_skin(const PieceInput& in, const PiecePlan& plan, const PointsD& skin_delta) {
  if (plan.film) return (*plan.film)(skin_delta);
  PointsD result(static_cast<Eigen::Index>(plan.vertices.size()), 3);
  for (std::size_t i = 0; i < plan.vertices.size(); ++i) {
    Eigen::RowVector3d d = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 3; ++k)
      d += plan.places.barycentric[i][k] *
           skin_delta.row(in.target_surface.surface.triangles(plan.places.triangle[i], k));
    result.row(static_cast<Eigen::Index>(i)) = plan.fade[i] * d;
  }
  return result;
}

/// The skin beneath as a rigid body; taken back where it is none (a lip that is pulled down does not move the teeth).
PointsD carry_with_jaw(const PieceInput& in, const PiecePlan& plan, const PointsD& skin_delta) {
  PiecePlan beneath = plan;
  std::fill(beneath.fade.begin(), beneath.fade.end(), 1.0);
  const PointsD own = in.target.positions(plan.vertices, Eigen::all);
  const PointsD delta = carry_from_skin(in, beneath, skin_delta);
  if (!(delta.cwiseAbs().maxCoeff() > 0)) return PointsD::Zero(own.rows(), 3);
  const RigidMotion motion = fit_rigid(own, delta);
  const double share = std::clamp((0.6 - motion.residual) / 0.35, 0.0, 1.0);
  return share * apply_rigid(motion, own);
}

}  // namespace

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
      const PointsD own = delta(members[p], Eigen::all);
      if (!(own.cwiseAbs().maxCoeff() > 0)) continue;
      const RigidMotion rigid = fit_rigid(source.positions(members[p], Eigen::all), own);
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

Eigen::Matrix3d head_axes(const PieceInput& in) {
  const PointsD centred = in.warped_source.rowwise() - in.warped_source.colwise().mean();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(centred.transpose() * centred).eigenvectors();
}

namespace {

/// Skin is the donor of what is worn on it (a tear, a sheet of lashes), of a small body that nothing else is near (a tooth) and
/// of more skin (a neck, a bag behind the lips): the first goes with the target's own skin beneath, the second with it as
/// a whole, the third with the source's.
PiecePlan::Way way_by_skin(const PieceInput& in, const PiecePlan& plan, const SkinFit& fit) {
  constexpr double small = 0.5;  // in face sizes
  const bool is_small =
      bounding_box(PointsD(in.target.positions(plan.vertices, Eigen::all))).diagonal() < small * in.unit;
  if (is_small && plan.solid) return PiecePlan::Way::jaw;
  return fit.mean_distance < on_skin_within * in.unit ? PiecePlan::Way::attached : PiecePlan::Way::donors;
}

PiecePlan::Way way_without_donors(const PieceInput& in, const PiecePlan& plan, const SkinFit& fit) {
  if (plan.kind == PieceKind::eye) return PiecePlan::Way::still;
  const bool on_skin = fit.behind < 0.5 || fit.mean_distance < on_skin_within * in.unit;
  return plan.kind == PieceKind::other && on_skin && !plan.solid ? PiecePlan::Way::attached
                                                                 : PiecePlan::Way::jaw;
}

/// Of a plan that has looked for donors.
void choose_way(const PieceInput& in, const SurfaceQuery& skin, bool found, PiecePlan& plan) {
  plan.way = PiecePlan::Way::donors;
  if (found && plan.kind != PieceKind::lash && !plan.from_skin) return;
  const PiecePlaces on_donors = plan.places;
  const SkinFit fit = find_skin(in, skin, plan);
  if (plan.kind == PieceKind::lash)
    plan.way = PiecePlan::Way::attached;
  else
    plan.way = found ? way_by_skin(in, plan, fit) : way_without_donors(in, plan, fit);
  if (plan.way == PiecePlan::Way::donors) plan.places = on_donors;
  if (plan.way != PiecePlan::Way::attached) return;
  if (found && plan.same_kind) plan.weight_donors = on_donors;
  // Brows lie on the skin all along; lashes stand off it.
  if (is_lash(in.target.piece_name[at(plan.piece)]))
    hold_by_roots(in, fit.distances, plan);
  else if (plan.kind == PieceKind::other && stands_off(fit.distances, in.unit))
    stretch_between(in, fit.distances, plan);
}

}  // namespace

std::vector<PiecePlan> plan_pieces(const PieceInput& in) {
  std::vector<PieceKind> source_kinds;
  for (int p = 0; p < in.source.piece_count; ++p)
    source_kinds.push_back(in.source_skin[at(p)] ? PieceKind::skin
                                                 : kind_of(in.source, p, in.unit / in.similarity.scale));
  const SurfaceQuery skin(in.target_surface.surface.positions, in.target_surface.surface.triangles);
  DonorFinder donors(in, source_kinds);
  std::vector<PiecePlan> plans;
  for (int p = 0; p < in.target.piece_count; ++p) {
    if (in.target_skin[at(p)]) continue;
    PiecePlan plan;
    plan.piece = p;
    plan.kind = kind_of(in.target, p, in.unit);
    plan.vertices = vertices_of(in.target, p);
    plan.growth = in.similarity.scale;
    plan.solid = is_solid(in.target, p);
    plan.rigid = plan.solid && plan.kind == PieceKind::other &&
                 bounding_box(PointsD(in.target.positions(plan.vertices, Eigen::all))).diagonal() <
                     largest_tooth * in.unit;
    choose_way(in, skin, donors.find(plan), plan);
    plans.push_back(std::move(plan));
  }
  return plans;
}

PiecePoints piece_points(const PieceInput& in, const std::vector<PiecePlan>& plans) {
  std::vector<Eigen::RowVector3d> aligned, target;
  const Eigen::Matrix3d axes = head_axes(in);
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
    add_box(in.similarity(PointsD(in.source.positions(plan.donor_vertices, Eigen::all))), aligned);
    add_box(in.target.positions(plan.vertices, Eigen::all), target);
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

namespace {

WeightMatrix mix_rows(const WeightMatrix& rows, const Triangles& triangles, const PiecePlaces& places) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.triangle.size(); ++i)
    for (int k = 0; k < 3; ++k)
      for (WeightMatrix::InnerIterator entry(rows, triangles(places.triangle[i], k)); entry; ++entry)
        entries.emplace_back(static_cast<int>(i), static_cast<int>(entry.col()),
                             places.barycentric[i][k] * entry.value());
  WeightMatrix result(static_cast<Eigen::Index>(places.triangle.size()), rows.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

WeightMatrix carry_piece_rows(const PieceInput& in, const PiecePlan& plan, const WeightMatrix& source_rows,
                              const WeightMatrix& skin_rows) {
  switch (plan.way) {
    case PiecePlan::Way::donors:
      return mix_rows(source_rows, in.source.triangles, plan.places);
    case PiecePlan::Way::attached:
    case PiecePlan::Way::jaw:
      return plan.film ? (*plan.film)(skin_rows)
                       : mix_rows(skin_rows, in.target_surface.surface.triangles, plan.places);
    case PiecePlan::Way::still:
      break;
  }
  return WeightMatrix(static_cast<Eigen::Index>(plan.vertices.size()), source_rows.cols());
}

WeightMatrix carry_piece_weights(const PieceInput& in, const PiecePlan& plan,
                                 const WeightMatrix& source_weights, const WeightMatrix& skin_weights,
                                 int head_joint) {
  WeightMatrix weights = plan.weight_donors.triangle.empty()
                             ? carry_piece_rows(in, plan, source_weights, skin_weights)
                             : mix_rows(source_weights, in.source.triangles, plan.weight_donors);
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    if (!(weights.row(v).sum() > 0)) weights.coeffRef(v, head_joint) = 1;
  return weights;
}

std::string_view name_of(PiecePlan::Way way) {
  constexpr std::array<std::string_view, 4> names{"source part", "skin beneath", "jaw", "still"};
  return names[static_cast<std::size_t>(way)];
}

}  // namespace mien::detail
