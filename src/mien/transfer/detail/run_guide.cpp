// What of the source lies where on the target: the guide, each target vertex's place on the source, the pieces inside.
#include <algorithm>
#include <optional>
#include <utility>

#include "mien/core/error.h"
#include "mien/transfer/detail/assemble_target.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/evening.h"
#include "mien/transfer/detail/face_size.h"
#include "mien/transfer/detail/pool_uvs.h"
#include "mien/transfer/detail/run.h"
#include "mien/transfer/thesis.h"

namespace mien::detail {
namespace {

/// Points of the guide: the dense spline goes through the first, contacts look at all.
constexpr std::size_t spline_samples = 500;
constexpr int guide_samples = 1000;

/// How far the chords of a twin's triangles may cut below the source, relative to the face's size.
constexpr double kept_reach = 0.02;

/// How far from where the landmarks' spline expects them UVs may bring vertices, as a median and relative to the face's size:
/// other proportions, not another head.
constexpr double uv_reach = 0.15;

}  // namespace

/// None in what was found; given ones among them count as much as their share: a few that pull alone would dent the guide
/// around them. A curve's samples are named after it.
Eigen::VectorXd Run::trust_in(const std::vector<std::string>& landmarks) const {
  const auto found = [&](const std::string& name) {
    const auto& all = options_.found_landmarks;
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  Eigen::VectorXd given = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(landmarks.size()));
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (found(landmarks[i]) || found(landmarks[i].substr(0, landmarks[i].rfind('.'))))
      given[static_cast<Eigen::Index>(i)] = 0;
  return given.mean() * given;
}

void Run::find_guide() {
  const PointsD from = report_.pairs.source_positions(), to = report_.pairs.target_positions();
  landmark_spline_ = std::make_unique<ThinPlateSpline>(from, to);
  if (thesis()) {
    registration_ = thesis_registration(source_surface_.surface, target_surface_.surface, from, to);
  } else if (!register_twin(from, to)) {
    if (!register_by_uvs(from, to)) {
      RegistrationOptions registration;
      registration.landmark_trust = trust_in(report_.pairs.names);
      registration.landmarks_hold = options_.landmarks_hold;
      registration.progress = options_.progress;
      registration_ =
          register_surfaces(source_surface_.surface, target_surface_.surface, from, to, registration);
    }
    if (twin_) keep_twin();
  }
  report_.similarity = registration_.similarity;
  report_.unit = registration_.unit;
  maps_.positions = source_surface_.surface.positions;
  maps_.similarity = registration_.similarity;
  maps_.aligned = registration_.similarity(maps_.positions);
  maps_.landmarks = landmark_spline_.get();
  maps_.landmark_image = (*landmark_spline_)(maps_.positions);
  model_ = thesis() && options_.deltas == DeltaModel::automatic ? DeltaModel::thesis : options_.deltas;
  if (thesis() && options_.deltas != DeltaModel::warp) return;
  maps_.samples = farthest_points(maps_.aligned, guide_samples);
  dense_ = std::make_unique<ThinPlateSpline>(
      dense_spline(maps_.aligned, registration_.guide, registration_.similarity(from), to,
                   std::span(maps_.samples).first(std::min(maps_.samples.size(), spline_samples))));
  maps_.dense = dense_.get();
  maps_.dense_image = (*dense_)(maps_.aligned);
}

/// Looks whether the target is the source with another mesh; true where no registration is needed then.
bool Run::register_twin(const PointsD& from, const PointsD& to) {
  twin_ =
      find_twin({source_pool_.positions, source_pool_.triangles},
                {target_pool_.positions, target_pool_.triangles}, {Similarity{}, fit_similarity(from, to)});
  if (!twin_) return false;
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  twin_skin_ = twin_of_surfaces(*twin_, source_surface_, target_surface_, source_pool_.triangles.rows());
  if (twin_skin_.share < TwinOptions{}.least_share) {  // other faces, with the same eyes and teeth
    twin_.reset();
    twin_skin_ = {};
    return false;
  }
  if (!twin_skin_.whole()) return false;
  registration_.similarity = twin_->placement;
  registration_.unit = face_size(to, target.positions);
  registration_.guide = twin_->placement(source.positions);
  kept_.assign(static_cast<std::size_t>(source.positions.rows()), 1);
  return true;
}

/// After a registration: what is the source's own surface stays exactly that.
void Run::keep_twin() {
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  registration_.similarity = twin_->placement;
  kept_ = kept_vertices(twin_skin_, source, target, kept_reach * registration_.unit);
  settle_guide(twin_->placement(source.positions), kept_, source, registration_.guide);
}

/// Looks whether source and target share a UV layout; true where it brings the one onto the other.
bool Run::register_by_uvs(const PointsD& from, const PointsD& to) {
  if (options_.correspondence == Correspondence::surfaces) return false;
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  const auto source_uvs = uv_layout(source_, source_pool_, source_surface_),
             target_uvs = uv_layout(target_, target_pool_, target_surface_);
  const double unit = face_size(to, target.positions);
  const PointsD expected = (*landmark_spline_)(source.positions);
  if (source_uvs && target_uvs)
    uvs_ = find_shared_uvs(*source_uvs, *target_uvs, target.positions, expected, uv_reach * unit);
  if (!uvs_ && options_.correspondence == Correspondence::shared_uvs)
    throw invalid_input("target", "does not share the source's UV layout",
                        "UVs with the source's charts on both, or the correspondence by surfaces");
  if (!uvs_) return false;
  registration_.similarity = fit_similarity(from, to);
  registration_.unit = unit;
  registration_.guide = expected;
  settle_guide(uvs_->guide, uvs_->known, source, registration_.guide);
  report_.correspondence = Correspondence::shared_uvs;
  return true;
}

std::vector<SourcePoint> Run::find_points() const {
  if (thesis()) return thesis_correspondence(registration_, source_surface_.surface, target_surface_.surface);
  if (twin_ && twin_skin_.whole()) return twin_skin_.points;
  std::vector<SourcePoint> points = uvs_ ? points_by_uvs() : points_on_guide();
  for (std::size_t v = 0; v < twin_skin_.points.size(); ++v)
    if (twin_skin_.points[v].accepted) points[v] = twin_skin_.points[v];
  return points;
}

/// What the UVs do not say is filled in from around, or taken from the guide where nothing is around.
std::vector<SourcePoint> Run::points_by_uvs() const {
  std::vector<SourcePoint> points = uvs_->points;
  const SurfaceQuery guide(registration_.guide, source_surface_.surface.triangles);
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (points[v].accepted) continue;
    const auto hit =
        guide.closest(target_surface_.surface.positions.row(static_cast<Eigen::Index>(v)).transpose());
    points[v] = {hit.triangle, hit.barycentric, hit.distance, false};
  }
  return points;
}

std::vector<SourcePoint> Run::points_on_guide() const {
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  std::vector<SourcePoint> points = find_correspondence(registration_, source, target);
  TearInput tears{source_.shapes.size(),
                  [&](std::size_t s) {
                    return registration_.similarity.of_vectors(
                        pooled_delta(source_.shapes[s])(source_surface_.vertices, Eigen::all));
                  },
                  {},
                  registration_.unit};
  if (source_weights_.rows() > 0) tears.weights = select_rows(source_weights_, source_surface_.vertices);
  reject_torn(tears, source, target, points);
  return points;
}

/// The skin is where the guide is; the spline takes along what lies inside.
void Run::warp_source() {
  warped_source_.resize(source_pool_.positions.rows(), 3);
  for (std::size_t r = 0; r < source_surface_.vertices.size(); ++r)
    warped_source_.row(source_surface_.vertices[r]) = registration_.guide.row(static_cast<Eigen::Index>(r));
  std::vector<int> inside;
  for (std::size_t v = 0; v < source_pool_.piece.size(); ++v)
    if (!source_skin_[at(source_pool_.piece[v])]) inside.push_back(static_cast<int>(v));
  const PointsD positions = source_pool_.positions(inside, Eigen::all);
  warped_source_(inside, Eigen::all) =
      thesis() ? (*landmark_spline_)(positions) : (*dense_)(registration_.similarity(positions));
  if (uvs_) place_pieces_by_uvs();
}

/// Where the skins share a layout, eyes, teeth and tongue may: each goes onto the nearest piece that shares its own.
void Run::place_pieces_by_uvs() {
  struct Piece {
    PoolSurface surface;
    std::optional<UvLayout> uvs;
  };
  const auto pieces_of = [](const Character& character, const Pool& pool, const std::vector<char>& skin) {
    std::vector<Piece> pieces;
    for (int p = 0; p < pool.piece_count; ++p) {
      if (skin[at(p)]) continue;
      pieces.push_back({one_piece(pool, p), {}});
      pieces.back().uvs = uv_layout(character, pool, pieces.back().surface);
    }
    return pieces;
  };
  const std::vector<Piece> sources = pieces_of(source_, source_pool_, source_skin_),
                           targets = pieces_of(target_, target_pool_, target_skin_);
  const double reach = uv_reach * registration_.unit;
  for (const Piece& from : sources) {
    if (!from.uvs) continue;
    const PointsD expected = warped_source_(from.surface.vertices, Eigen::all);
    std::vector<std::pair<double, const Piece*>> near;
    for (const Piece& to : targets) {
      const double apart = (to.surface.surface.positions.colwise().mean() - expected.colwise().mean()).norm();
      if (to.uvs && apart < reach) near.emplace_back(apart, &to);
    }
    std::stable_sort(near.begin(), near.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [apart, to] : near) {
      const auto shared =
          find_shared_uvs(*from.uvs, *to->uvs, to->surface.surface.positions, expected, reach);
      if (!shared) continue;
      warped_source_(from.surface.vertices, Eigen::all) = shared->guide;
      break;
    }
  }
}

void Run::find_places() {
  const Surface &source = source_surface_.surface, &target = target_surface_.surface;
  if (!source_.skins.empty())
    source_weights_ = pooled_skin_weights(source_, source_pool_, list_joints(source_));
  carrier_ = std::make_unique<AttributeCarrier>(find_points(), source, target);
  if (!thesis() && !uvs_ && !twin_)
    evening_ = evening(carrier_->correspondence(), maps_.aligned, source.triangles, target);
  warp_source();
  piece_motions_ = piece_motions(
      source_pool_, source_skin_, source_.shapes.size(),
      [&](std::size_t s) { return pooled_delta(source_.shapes[s]); }, source_weights_,
      registration_.unit / registration_.similarity.scale);
  plans_ = plan_pieces(piece_input());
  for (const PiecePlan& plan : plans_)
    report_.pieces.push_back({target_pool_.piece_name[at(plan.piece)], std::string(name_of(plan.kind)),
                              std::string(name_of(plan.way))});
  if (has_control_points()) {
    aligned_query_ = std::make_unique<SurfaceQuery>(maps_.aligned, source.triangles);
    target_query_ = std::make_unique<SurfaceQuery>(target.positions, target.triangles);
  }
  report_maps();
}

PieceInput Run::piece_input() const {
  return {source_pool_,
          target_pool_,
          source_skin_,
          target_skin_,
          target_surface_,
          warped_source_,
          registration_.similarity,
          piece_motions_,
          registration_.unit};
}

void Run::report_maps() {
  for (std::size_t p = 0; p < source_.parts.size(); ++p) {
    Points positions(source_.parts[p].mesh.positions.rows(), 3);
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
      positions.row(v) =
          warped_source_.row(source_pool_.welded[p][static_cast<std::size_t>(v)]).cast<float>();
    report_.guide.push_back(std::move(positions));
  }
  std::vector<char> filled(carrier_->correspondence().size(), 0);
  for (const int v : carrier_->filled()) filled[at(v)] = 1;
  for (std::size_t p = 0; p < target_.parts.size(); ++p) {
    const Eigen::Index count = target_.parts[p].mesh.positions.rows();
    Eigen::VectorXf distance = Eigen::VectorXf::Zero(count), fill = Eigen::VectorXf::Zero(count);
    for (Eigen::Index v = 0; v < count; ++v) {
      const int r = target_surface_.row_of[at(target_pool_.welded[p][static_cast<std::size_t>(v)])];
      if (r < 0) continue;
      distance[v] = static_cast<float>(carrier_->correspondence()[at(r)].distance / registration_.unit);
      fill[v] = filled[at(r)];
    }
    report_.distance.push_back(std::move(distance));
    report_.filled.push_back(std::move(fill));
  }
  const double share = static_cast<double>(carrier_->filled().size()) / static_cast<double>(filled.size());
  if (share > 0.1)
    warn("the guide reaches only " + std::to_string(static_cast<int>(100 * (1 - share))) +
             " % of the target's skin",
         "look at the error map; landmarks on the part that the source lacks do not help, more on the face "
         "may");
}

}  // namespace mien::detail
