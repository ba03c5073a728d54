// Thresholds come from a study on 58 pairs of faces; docs/transfer.md has the table. They are relative to the landmark
// box's diagonal, about half of the diagonal of a whole head's skin.
#include "mien/transfer/contact.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <span>
#include <unordered_map>

#include "mien/core/parallel.h"
#include "mien/geometry/laplacian.h"
#include "mien/geometry/surface_query.h"

namespace mien {
namespace {

constexpr double moving_share = 0.25;  // of a shape's largest displacement
constexpr double least_gap = 0.017;    // neutral
constexpr double largest_gap = 0.25;
constexpr double shrunk = 0.4;  // deformed gap over neutral gap
constexpr double least_closed = 0.6;
constexpr double air = 0.08;  // distance of the gap's middle from the surface, of the gap
constexpr std::size_t least_pairs = 5, most_pairs = 80, most_seeds = 300;
constexpr int least_shapes = 5;
constexpr double jacobian_radius = 0.095, stretch_radius = 0.3, lid_radius = 0.12;

Eigen::Vector3d row(const PointsD& points, int r) {
  return points.row(r).transpose();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Vertices inside a box in cells of a grid, to ask for those near a point.
class Grid {
 public:
  struct Entry {
    Eigen::Vector3d point, neutral;
    int vertex;
  };
  Grid(const PointsD& points, const PointsD& neutral, const Eigen::AlignedBox3d& box, double cell)
      : cell_(cell) {
    for (int v = 0; v < static_cast<int>(points.rows()); ++v) {
      const Eigen::Vector3d point = row(points, v);
      if (box.contains(point)) cells_[key(index(point))].push_back({point, row(neutral, v), v});
    }
  }
  /// Visits what is in the cell of `point` and those around it, but for cells further away than `least`, a square that the
  /// visits may make smaller.
  template <class Visit>
  void near(const Eigen::Vector3d& point, const double& least, const Visit& visit) const {
    const Eigen::Array3i centre = index(point);
    const auto look = [&](const Eigen::Array3i& at) {
      const Eigen::Array3d low = cell_ * at.cast<double>();
      const Eigen::Array3d off = (low - point.array()).max(point.array() - low - cell_).max(0);
      if (off.square().sum() >= least) return;
      const auto found = cells_.find(key(at));
      if (found == cells_.end()) return;
      for (const Entry& entry : found->second) visit(entry);
    };
    look(centre);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (x != 0 || y != 0 || z != 0) look(centre + Eigen::Array3i(x, y, z));
  }

 private:
  Eigen::Array3i index(const Eigen::Vector3d& p) const { return (p / cell_).array().floor().cast<int>(); }
  static std::int64_t key(const Eigen::Array3i& i) {
    return ((static_cast<std::int64_t>(i[0]) & 0x1fffff) << 42) |
           ((static_cast<std::int64_t>(i[1]) & 0x1fffff) << 21) |
           (static_cast<std::int64_t>(i[2]) & 0x1fffff);
  }
  double cell_;
  std::unordered_map<std::int64_t, std::vector<Entry>> cells_;
};

/// How far displacements close the gap from a to b, as a fraction of it.
double closing(const PointsD& positions, const PointsD& deltas, int a, int b) {
  const Eigen::Vector3d gap = row(positions, b) - row(positions, a);
  return (row(deltas, a) - row(deltas, b)).dot(gap) / gap.squaredNorm();
}

/// The affine map of a Gaussian neighbourhood, pulled towards its uniform scale by `ridge`.
class LocalAffine {
 public:
  LocalAffine(const PointsD& from, const PointsD& to, const std::vector<int>& samples) {
    from_ = from(samples, Eigen::all);
    to_ = to(samples, Eigen::all);
  }
  Eigen::Matrix3d operator()(const Eigen::Vector3d& at, double radius, double ridge) const {
    const Eigen::VectorXd weight =
        ((from_.rowwise() - at.transpose()).rowwise().squaredNorm().array() / (-2 * radius * radius)).exp();
    const double sum = weight.sum();
    if (!(sum > 1e-12)) return Eigen::Matrix3d::Identity();
    const Eigen::RowVector3d a_mean = weight.transpose() * from_ / sum,
                             b_mean = weight.transpose() * to_ / sum;
    const PointsD a = from_.rowwise() - a_mean, b = to_.rowwise() - b_mean;
    const Eigen::Matrix3d aa = a.transpose() * weight.asDiagonal() * a,
                          ba = b.transpose() * weight.asDiagonal() * a;
    const double pull = ridge * aa.trace() / 3;
    const double scale = ba.trace() / aa.trace();
    return (ba + pull * scale * Eigen::Matrix3d::Identity()) *
           (aa + pull * Eigen::Matrix3d::Identity()).inverse();
  }

 private:
  PointsD from_, to_;
};

bool speaks_of_lids(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  return (has("blink") || has("lid") || has("wink") || has("clos") || has("eye")) && !has("mouth") &&
         !has("lip") && !has("jaw") && !has("slide");
}

}  // namespace

struct ContactModel::State {
  const Surface& source;
  const DeltaMaps& maps;
  PointsD guide;
  double unit;
  std::vector<std::string> names;
  std::vector<std::vector<ContactPair>> pairs;  // per shape
  std::vector<std::vector<PointsD>>
      pair_deltas;         // per shape: turned displacements of a (first) and b (second)
  Eigen::VectorXd motion;  // #V: largest displacement over all shapes, target units
};

ContactModel::ContactModel(const Surface& source, const Registration& registration, const DeltaMaps& maps)
    : state_(new State{source, maps, registration.guide, registration.unit, {}, {}, {}, {}}) {}

ContactModel::~ContactModel() = default;

namespace {

double square(double x) {
  return x * x;
}

Eigen::AlignedBox3d grown_box(const PointsD& points, const std::vector<int>& rows, double by) {
  Eigen::AlignedBox3d box;
  for (const int r : rows) box.extend(row(points, r));
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(by);
  return {box.min() - margin, box.max() + margin};
}

/// Rows that move, at most `most_seeds` of them, evenly chosen.
std::vector<int> moving_rows(const PointsD& deltas) {
  const Eigen::VectorXd size = deltas.rowwise().norm();
  const double limit = moving_share * size.maxCoeff();
  std::vector<int> rows;
  for (Eigen::Index v = 0; v < size.size(); ++v)
    if (size[v] > limit) rows.push_back(static_cast<int>(v));
  if (rows.size() <= most_seeds) return rows;
  std::vector<int> some;
  for (std::size_t i = 0; i < most_seeds; ++i) some.push_back(rows[i * rows.size() / most_seeds]);
  return some;
}

std::vector<ContactPair> find_pairs(const PointsD& positions, const PointsD& deltas,
                                    const SurfaceQuery& surface, double unit) {
  std::vector<ContactPair> found;
  if (!(deltas.cwiseAbs().maxCoeff() > 1e-3 * unit)) return found;
  const PointsD deformed = positions + deltas;
  const double reach = shrunk * largest_gap * unit;
  const std::vector<int> moving = moving_rows(deltas);
  const Grid grid(deformed, positions, grown_box(deformed, moving, reach), reach / 2);
  for (const int a : moving) {
    int best = -1;
    double best_distance = reach * reach;  // squares
    const Eigen::Vector3d place = row(deformed, a), neutral = row(positions, a);
    grid.near(place, best_distance, [&](const Grid::Entry& entry) {
      const double distance = (entry.point - place).squaredNorm();
      if (distance >= best_distance) return;
      const double gap = (entry.neutral - neutral).squaredNorm();
      if (gap < square(least_gap * unit) || gap > square(largest_gap * unit) ||
          distance > square(shrunk) * gap)
        return;
      if (closing(positions, deltas, a, entry.vertex) < least_closed) return;
      best = entry.vertex;
      best_distance = distance;
    });
    if (best < 0) continue;
    const Eigen::Vector3d middle = (row(positions, a) + row(positions, best)) / 2;
    const double gap = (row(positions, best) - row(positions, a)).norm();
    if (surface.closest(middle, 2 * gap).distance < air * gap) continue;
    found.push_back({a, best, closing(positions, deltas, a, best)});
  }
  if (found.size() < least_pairs) found.clear();
  std::vector<ContactPair> some;
  const std::size_t count = std::min(found.size(), most_pairs);
  for (std::size_t i = 0; i < count; ++i) some.push_back(found[i * found.size() / count]);
  return some;
}

}  // namespace

void ContactModel::look_at_shapes(const std::vector<std::string>& names,
                                  const std::function<PointsD(std::size_t)>& delta) {
  State& s = *state_;
  s.names = names;
  s.pairs.resize(names.size());
  s.pair_deltas.resize(names.size());
  const SurfaceQuery surface(s.maps.aligned, s.source.triangles);
  std::vector<Eigen::VectorXd> motion(names.size());
  parallel_for(names.size(), 1, [&](std::size_t begin, std::size_t) {
    const PointsD turned = s.maps.similarity.of_vectors(delta(begin));
    motion[begin] = turned.rowwise().norm();
    s.pairs[begin] = find_pairs(s.maps.aligned, turned, surface, s.unit);
    PointsD a(static_cast<Eigen::Index>(s.pairs[begin].size()), 3), b = a;
    for (std::size_t i = 0; i < s.pairs[begin].size(); ++i) {
      a.row(static_cast<Eigen::Index>(i)) = turned.row(s.pairs[begin][i].a);
      b.row(static_cast<Eigen::Index>(i)) = turned.row(s.pairs[begin][i].b);
    }
    s.pair_deltas[begin] = {a, b};
  });
  s.motion = Eigen::VectorXd::Zero(s.guide.rows());
  for (const auto& m : motion) s.motion = s.motion.cwiseMax(m);
}

const std::vector<ContactPair>& ContactModel::pairs(std::size_t shape) const {
  return state_->pairs[shape];
}

namespace {

/// How far a model's closings miss the source's, in one shape: by their median, and pair by pair.
struct Miss {
  double median = 0, pairwise = 0;
};
Miss miss_of(const std::vector<ContactPair>& pairs, const std::vector<double>& closed) {
  std::vector<double> wanted, got, off;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    wanted.push_back(std::min(pairs[i].closed, 1.0));
    got.push_back(std::min(closed[i], 1.0));
    off.push_back(std::abs(got.back() - wanted.back()) / wanted.back());
  }
  return {std::abs(median(got) / median(wanted) - 1), median(off)};
}

}  // namespace

DeltaDecision ContactModel::decide(DeltaModel wanted) const {
  const State& s = *state_;
  DeltaDecision decision;
  decision.model = wanted;
  if (wanted != DeltaModel::automatic) {
    decision.warp_share = wanted == DeltaModel::warp ? 1 : 0;
    decision.reason = "asked for by name";
    return decision;
  }
  const LocalAffine affine(s.maps.aligned, s.guide, s.maps.samples);
  const double near = jacobian_radius * s.unit;
  Miss raw, jacobian;
  for (std::size_t shape = 0; shape < s.pairs.size(); ++shape) {
    const auto& pairs = s.pairs[shape];
    if (pairs.empty()) continue;
    ++decision.contact_shapes;
    std::vector<double> raw_closed(pairs.size()), jacobian_closed(pairs.size());
    parallel_for(pairs.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3d gap = row(s.guide, pairs[i].b) - row(s.guide, pairs[i].a);
        const Eigen::Vector3d da = row(s.pair_deltas[shape][0], static_cast<int>(i));
        const Eigen::Vector3d db = row(s.pair_deltas[shape][1], static_cast<int>(i));
        const Eigen::Matrix3d ja = affine(row(s.maps.aligned, pairs[i].a), near, 0.1);
        const Eigen::Matrix3d jb = affine(row(s.maps.aligned, pairs[i].b), near, 0.1);
        raw_closed[i] = (da - db).dot(gap) / gap.squaredNorm();
        jacobian_closed[i] = (ja * da - jb * db).dot(gap) / gap.squaredNorm();
      }
    });
    const Miss r = miss_of(pairs, raw_closed), j = miss_of(pairs, jacobian_closed);
    raw.median += r.median;
    raw.pairwise += r.pairwise;
    jacobian.median += j.median;
    jacobian.pairwise += j.pairwise;
  }

  double weight = 0, sum = 0, squares = 0;
  for (const int v : std::span(s.maps.samples).first(std::min<std::size_t>(300, s.maps.samples.size()))) {
    const Eigen::Matrix3d a = affine(row(s.maps.aligned, v), stretch_radius * s.unit, 0.03);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squared(a.transpose() * a, Eigen::EigenvaluesOnly);
    const Eigen::Array3d stretch = squared.eigenvalues().array().max(1e-12).log() / 2;
    for (int k = 0; k < 3; ++k) {
      weight += s.motion[v];
      sum += s.motion[v] * stretch[k];
      squares += s.motion[v] * stretch[k] * stretch[k];
    }
  }
  if (weight > 0) decision.stretch = std::sqrt(std::max(0.0, squares / weight - std::pow(sum / weight, 2)));
  if (decision.contact_shapes > 0)
    decision.contact_ratio = std::max(jacobian.median / std::max(raw.median, 1e-9),
                                      jacobian.pairwise / std::max(raw.pairwise, 1e-9));
  const auto ramp = [](double x) { return std::clamp(x, 0.0, 1.0); };
  const double share = decision.contact_shapes < least_shapes ? 0.0
                                                              : ramp((0.62 - decision.contact_ratio) / 0.15) *
                                                                    ramp((decision.stretch - 0.03) / 0.015);
  if (decision.contact_shapes < least_shapes) {
    decision.reason = "fewer than 5 source shapes close a gap, so contacts say nothing: smooth local scale";
  } else {
    decision.warp_share = share;
    decision.reason =
        share <= 0   ? "the source's contacts are kept no better by following the map: smooth local scale"
        : share >= 1 ? "the source's contacts are kept by following the map: warp"
                     : "the source's contacts lie between the two: a blend of local scale and warp";
  }
  return decision;
}

bool ContactModel::closes_lid(std::size_t shape) const {
  return !state_->pairs[shape].empty() && speaks_of_lids(state_->names[shape]);
}

double ContactModel::lid_warp_share(std::size_t shape, const PointsD& moved) const {
  if (!closes_lid(shape)) return 0;
  std::vector<double> kept;
  for (const ContactPair& pair : state_->pairs[shape])
    kept.push_back(closing(state_->guide, moved, pair.a, pair.b) / pair.closed);
  return std::clamp((0.8 - median(kept)) / 0.2, 0.0, 1.0);
}

namespace {

/// A part of a surface, row i its vertex `vertices[i]`.
struct Piece {
  Surface surface;
  std::vector<int> vertices, row_of;  // row_of: -1 where a vertex is not in it
};

/// The triangles that begin within `radius` of the middle of some vertices, and these.
Piece piece_around(const PointsD& positions, const Triangles& triangles, const std::vector<int>& some,
                   double radius) {
  Piece piece;
  piece.row_of.assign(static_cast<std::size_t>(positions.rows()), -1);
  const auto take = [&](int vertex) {
    int& r = piece.row_of[static_cast<std::size_t>(vertex)];
    if (r < 0) {
      r = static_cast<int>(piece.vertices.size());
      piece.vertices.push_back(vertex);
    }
    return r;
  };
  const Eigen::Vector3d middle = positions(some, Eigen::all).colwise().mean().transpose();
  for (const int vertex : some) take(vertex);
  piece.surface.triangles.resize(triangles.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    if ((row(positions, triangles(t, 0)) - middle).norm() >= radius) continue;
    for (int k = 0; k < 3; ++k) piece.surface.triangles(count, k) = take(triangles(t, k));
    ++count;
  }
  piece.surface.triangles.conservativeResize(count, 3);
  piece.surface.positions = positions(piece.vertices, Eigen::all);
  return piece;
}

}  // namespace

void ContactModel::close_lids(std::size_t shape, PointsD& moved) const {
  if (!closes_lid(shape)) return;
  const State& s = *state_;
  struct Row {
    int a, b;
    double qa, qb, goal;
  };
  std::vector<Row> rows;
  for (const ContactPair& pair : s.pairs[shape]) {
    const Eigen::Vector3d gap = row(s.guide, pair.b) - row(s.guide, pair.a);
    if (gap.norm() < 0.02 * s.unit) continue;
    const double qa = row(moved, pair.a).dot(gap) / gap.squaredNorm();
    const double qb = -row(moved, pair.b).dot(gap) / gap.squaredNorm();
    const double now = qa + qb;
    if (now < 0.35 * pair.closed || now > 2.5 * pair.closed) continue;
    // A lid that stops short is pulled on, one that runs through the other back; between, it is left alone.
    const double goal = std::clamp(now, pair.closed, std::max(pair.closed, 1.0));
    rows.push_back({pair.a, pair.b, qa, qb, goal - now});
  }
  if (rows.empty() ||
      std::all_of(rows.begin(), rows.end(), [](const Row& r) { return std::abs(r.goal) < 0.02; }))
    return;

  // The factor is one far from the lid: the system is set up on the surface around the contacts alone.
  const double radius = lid_radius * s.unit, area = std::numbers::pi * radius * radius;
  std::vector<int> contacts_at;
  for (const Row& r : rows) contacts_at.insert(contacts_at.end(), {r.a, r.b});
  const Piece piece = piece_around(s.guide, s.source.triangles, contacts_at, 4 * radius);
  const Surface& around = piece.surface;
  SparseMatrix system = radius * radius * cotangent_laplacian(around.positions, around.triangles);
  const Eigen::VectorXd masses = vertex_areas(around.positions, around.triangles);
  for (Eigen::Index v = 0; v < masses.size(); ++v)
    system.coeffRef(v, v) += std::max(masses[v], 1e-6 * masses.mean());
  system /= area;

  const double weight = 100.0 / static_cast<double>(rows.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(masses.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const Row& r : rows) {
    const int a = piece.row_of[static_cast<std::size_t>(r.a)],
              b = piece.row_of[static_cast<std::size_t>(r.b)];
    entries.emplace_back(a, a, weight * r.qa * r.qa);
    entries.emplace_back(b, b, weight * r.qb * r.qb);
    entries.emplace_back(a, b, weight * r.qa * r.qb);
    entries.emplace_back(b, a, weight * r.qa * r.qb);
    right[a] += weight * r.qa * r.goal;
    right[b] += weight * r.qb * r.goal;
  }
  SparseMatrix contacts(masses.size(), masses.size());
  contacts.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<SparseMatrix> factor(system + contacts);
  const Eigen::VectorXd h = factor.solve(right);
  for (std::size_t i = 0; i < piece.vertices.size(); ++i)
    moved.row(piece.vertices[i]) *= std::clamp(1 + h[static_cast<Eigen::Index>(i)], 0.5, 2.0);
}

}  // namespace mien
