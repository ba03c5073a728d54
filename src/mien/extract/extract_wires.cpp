#include "mien/extract/extract_wires.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <set>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/wires.h"
#include "mien/extract/detail/deltas.h"
#include "mien/extract/detail/pieces.h"
#include "mien/extract/detail/wire_system.h"

namespace mien {
namespace {

using Clock = std::chrono::steady_clock;

/// Shapes that are solved as one product: the factors are read once for all of them.
constexpr std::size_t solved_together = 16;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check_wires(std::span<const Wire> wires, const WireSolverOptions& options) {
  if (wires.empty()) throw invalid_input("wires", "are none", "one or more");
  for (const Wire& wire : wires)
    if (wire.bindings.empty()) throw invalid_input("wire " + wire.name, "reaches no vertex", "bind it first");
  if (!(options.ridge > 0) || !std::isfinite(options.ridge))
    throw invalid_input("ridge", "is " + std::to_string(options.ridge), "a finite number above 0");
}

/// Per part and row of the field.
std::vector<std::vector<float>> row_weights(const Character& character, const WireField& field,
                                            const std::vector<Eigen::VectorXf>& given) {
  if (!given.empty() && given.size() != character.parts.size())
    throw invalid_input("vertex weights", "are for " + std::to_string(given.size()) + " parts",
                        std::to_string(character.parts.size()));
  std::vector<std::vector<float>> weights;
  for (std::size_t p = 0; p < field.parts().size(); ++p) {
    const std::vector<int>& vertices = field.parts()[p].vertices;
    weights.emplace_back(vertices.size(), 1.f);
    if (given.empty() || given[p].size() == 0) continue;
    if (given[p].size() != character.parts[p].mesh.positions.rows() || !given[p].allFinite() ||
        given[p].minCoeff() < 0)
      throw invalid_input("vertex weights of part " + character.parts[p].name,
                          "are negative, not finite or of another number", "one a vertex, 0 or more");
    for (std::size_t row = 0; row < vertices.size(); ++row) weights[p][row] = given[p][vertices[row]];
  }
  return weights;
}

}  // namespace

struct WireSolver::State {
  State(const Character& character, std::span<const Wire> wires, const WireSolverOptions& options)
      : field(character, wires),
        system(field, wires, row_weights(character, field, options.vertex_weights), options.ridge) {
    for (const Wire& wire : wires) {
      controls.push_back(wire.curve.control_count());
      turns.push_back(wire.turn_controls);
    }
    to_model = detail::vectors_to_model(character);
    for (std::size_t p = 0; p < character.parts.size(); ++p) {
      const Part& part = character.parts[p];
      vertex_counts.push_back(static_cast<Eigen::Index>(part.mesh.vertex_count()));
      rows.emplace_back(part.mesh.vertex_count(), -1);
      const std::vector<int>& reached = field.parts()[p].vertices;
      for (std::size_t row = 0; row < reached.size(); ++row)
        rows.back()[reached[row]] = static_cast<int>(row);
    }
  }

  bool add(const Shape& shape, Eigen::Index expression, detail::WireVectors& right) const;
  std::vector<WireMove> moves_of(const detail::WireVectors& found, Eigen::Index expression) const;

  WireField field;
  detail::WireSystem system;
  std::vector<int> controls, turns;         ///< per wire
  std::vector<std::vector<int>> rows;       ///< per part and vertex: its row in the field, -1: out of reach
  std::vector<Eigen::Matrix3d> to_model;    ///< per part: its vectors to model space
  std::vector<Eigen::Index> vertex_counts;  ///< per part
};

WireSolver::WireSolver(const Character& character, std::span<const Wire> wires,
                       const WireSolverOptions& options) {
  check_wires(wires, options);
  state_ = std::make_unique<State>(character, wires, options);
}
WireSolver::~WireSolver() = default;
WireSolver::WireSolver(WireSolver&&) noexcept = default;
WireSolver& WireSolver::operator=(WireSolver&&) noexcept = default;

/// Adds a shape's right-hand side; false: it moves no vertex in reach.
bool WireSolver::State::add(const Shape& shape, Eigen::Index expression, detail::WireVectors& right) const {
  bool moved = false;
  for (const PartDelta& delta : shape.parts) {
    if (delta.part < 0 || delta.part >= static_cast<int>(rows.size()))
      throw invalid_input("shape " + shape.name, "moves part " + std::to_string(delta.part),
                          "a part that exists");
    std::vector<int> reached;
    PointsD displacements(static_cast<Eigen::Index>(delta.vertices.size()), 3);
    for (std::size_t i = 0; i < delta.vertices.size(); ++i) {
      const int row = rows[delta.part][delta.vertices[i]];
      if (row < 0) continue;
      displacements.row(static_cast<Eigen::Index>(reached.size())) =
          delta.deltas.row(static_cast<Eigen::Index>(i)).cast<double>() * to_model[delta.part].transpose();
      reached.push_back(row);
    }
    const auto used = displacements.topRows(static_cast<Eigen::Index>(reached.size()));
    if (used.isZero(0)) continue;
    moved = true;
    system.add(delta.part, reached, displacements, expression, right);
  }
  return moved;
}

std::vector<WireMove> WireSolver::State::moves_of(const detail::WireVectors& found,
                                                  Eigen::Index expression) const {
  std::vector<WireMove> moves;
  const detail::WireColumns& columns = system.columns();
  for (std::size_t w = 0; w < controls.size(); ++w) {
    WireMove move;
    move.wire = static_cast<int>(w);
    move.controls = found.controls.block(columns.controls[w], 3 * expression, controls[w], 3);
    const int sigma = columns.unknowns[columns.coupled[w]];
    move.scale = found.coupled(sigma, expression);
    move.turns.resize(turns[w], 3);
    for (int t = 0; t < turns[w]; ++t)
      move.turns.row(t) = found.coupled.col(expression).segment<3>(sigma + 1 + 3 * t).transpose();
    moves.push_back(std::move(move));
  }
  return moves;
}

std::vector<WireMove> WireSolver::solve(const Shape& shape) const {
  return std::move(solve(std::span(&shape, 1)).front());
}

std::vector<std::vector<WireMove>> WireSolver::solve(std::span<const Shape> shapes) const {
  std::vector<std::vector<WireMove>> moves(shapes.size());
  parallel_for(shapes.size(), solved_together, [&](std::size_t begin, std::size_t end) {
    detail::WireVectors right = state_->system.zero(static_cast<Eigen::Index>(end - begin));
    std::vector<char> moved;
    for (std::size_t s = begin; s < end; ++s)
      moved.push_back(state_->add(shapes[s], static_cast<Eigen::Index>(s - begin), right));
    const detail::WireVectors found = state_->system.solve(right);
    for (std::size_t s = begin; s < end; ++s)
      if (moved[s - begin]) moves[s] = state_->moves_of(found, static_cast<Eigen::Index>(s - begin));
  });
  return moves;
}

std::vector<PartDelta> WireSolver::apply(std::span<const WireMove> moves) const {
  std::vector<PartDelta> deltas;
  for (std::size_t p = 0; p < state_->rows.size(); ++p) {
    const std::vector<int>& reached = state_->field.parts()[p].vertices;
    if (reached.empty()) continue;
    PointsD positions = PointsD::Zero(state_->vertex_counts[p], 3);
    state_->field.add(static_cast<int>(p), moves, positions);
    PartDelta delta;
    delta.part = static_cast<int>(p);
    delta.vertices = reached;
    delta.deltas.resize(static_cast<Eigen::Index>(reached.size()), 3);
    for (std::size_t i = 0; i < reached.size(); ++i)
      delta.deltas.row(static_cast<Eigen::Index>(i)) = positions.row(reached[i]).cast<float>();
    deltas.push_back(std::move(delta));
  }
  return deltas;
}

namespace {

/// 0 up to the threshold, 1 from twice the threshold on.
double kept_share(double value, double threshold) {
  if (!(value > threshold)) return 0;
  return threshold > 0 ? std::min(1.0, 2 * (value - threshold) / value) : 1;
}

/// Takes one shape apart into what wires rebuild, what is kept beside them and what is lost.
class Fitter {
 public:
  Fitter(const Character& character, const WireSolver& solver, const detail::Pieces& pieces,
         const ExtractOptions& options)
      : character_(character),
        solver_(solver),
        pieces_(pieces),
        weights_(options.solver.vertex_weights),
        threshold_(options.residual * pieces.box()) {}

  /// All but the residual. Sums of squares by feature go to `features`, what every vertex that exceeds the threshold counts to
  /// `counts`.
  WireFit fit(const Shape& shape, std::vector<WireMove> moves, std::vector<FeatureError>& features,
              std::vector<float>& counts) const;

  /// What is kept of the shape: nothing of what counts for `least` or less.
  void keep(const Shape& shape, double least, WireFit& fit) const;

 private:
  Points left_over(const Shape& shape, int part, const WireFit& fit) const;
  double weight_of(int part, Eigen::Index vertex) const {
    return weights_.empty() || weights_[part].size() == 0 ? 1 : weights_[part][vertex];
  }
  /// What an error counts for where it is, as a float: as it is sorted.
  float count_of(int part, Eigen::Index vertex, double error) const {
    return static_cast<float>(error * std::sqrt(weight_of(part, vertex)));
  }
  const Character& character_;
  const WireSolver& solver_;
  const detail::Pieces& pieces_;
  const std::vector<Eigen::VectorXf>& weights_;
  double threshold_;
};

Points Fitter::left_over(const Shape& shape, int part, const WireFit& fit) const {
  Points left = detail::dense_delta(character_, shape, part);
  for (const PartDelta& delta : fit.rebuilt)
    if (delta.part == part)
      for (std::size_t i = 0; i < delta.vertices.size(); ++i)
        left.row(delta.vertices[i]) -= delta.deltas.row(static_cast<Eigen::Index>(i));
  return left;
}

WireFit Fitter::fit(const Shape& shape, std::vector<WireMove> moves, std::vector<FeatureError>& features,
                    std::vector<float>& counts) const {
  WireFit result;
  result.shape = shape.name;
  result.moves = std::move(moves);
  result.rebuilt = solver_.apply(result.moves);
  for (int part = 0; part < static_cast<int>(character_.parts.size()); ++part) {
    if (!pieces_.has_skin(part)) continue;
    const Points wanted = detail::dense_delta(character_, shape, part), left = left_over(shape, part, result);
    for (Eigen::Index v = 0; v < wanted.rows(); ++v) {
      if (!pieces_.is_skin(part, static_cast<int>(v))) continue;
      const double scale = pieces_.unit(part), error = scale * left.row(v).cast<double>().norm(),
                   displacement = scale * wanted.row(v).cast<double>().norm();
      result.displacement += displacement * displacement;
      result.error += error * error;
      if (weight_of(part, v) >= 0.5) {
        result.seen_displacement += displacement * displacement;
        result.seen_error += error * error;
        result.seen_largest = std::max(result.seen_largest, error);
        FeatureError& feature = features[pieces_.feature(part, static_cast<int>(v))];
        feature.displacement += displacement * displacement;
        feature.error += error * error;
      }
      if (error > threshold_) counts.push_back(count_of(part, v, error));
      if (error <= result.largest) continue;
      result.largest = error;
      result.part = part;
      result.vertex = static_cast<int>(v);
    }
  }
  for (double* sum : {&result.displacement, &result.error, &result.seen_displacement, &result.seen_error})
    *sum = std::sqrt(*sum);
  return result;
}

void Fitter::keep(const Shape& shape, double least, WireFit& fit) const {
  double lost = 0;
  for (int part = 0; part < static_cast<int>(character_.parts.size()); ++part) {
    if (!pieces_.has_skin(part)) continue;
    Points left = left_over(shape, part, fit);
    for (Eigen::Index v = 0; v < left.rows(); ++v) {
      const double error = pieces_.is_skin(part, static_cast<int>(v))
                               ? pieces_.unit(part) * left.row(v).cast<double>().norm()
                               : 0;
      const double share =
          std::min(kept_share(error, threshold_), kept_share(count_of(part, v, error), least));
      lost += (1 - share) * (1 - share) * error * error;
      left.row(v) *= static_cast<float>(share);
    }
    PartDelta residual = detail::sparse_delta(part, left);
    if (!residual.vertices.empty()) fit.residual.push_back(std::move(residual));
  }
  fit.kept_error = std::sqrt(lost);
}

/// What a vertex has to count for, at least, so that no more than `most` of all `counts` exceed it.
double least_count(const std::vector<std::vector<float>>& counts, std::size_t most) {
  std::vector<float> all;
  for (const std::vector<float>& list : counts) all.insert(all.end(), list.begin(), list.end());
  if (all.size() <= most) return 0;
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(all.begin(), at, all.end(), std::greater<>());
  return *at;
}

/// The shape's new displacements: by wires and what is kept on the skin, its own elsewhere.
std::vector<PartDelta> replaced(const Character& character, const detail::Pieces& pieces, const Shape& shape,
                                const WireFit& fit) {
  std::vector<PartDelta> parts;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    Points dense = detail::dense_delta(character, shape, part);
    for (Eigen::Index v = 0; v < dense.rows(); ++v)
      if (pieces.is_skin(part, static_cast<int>(v))) dense.row(v).setZero();
    for (const std::vector<PartDelta>* list : {&fit.rebuilt, &fit.residual})
      for (const PartDelta& delta : *list)
        if (delta.part == part)
          for (std::size_t i = 0; i < delta.vertices.size(); ++i)
            dense.row(delta.vertices[i]) += delta.deltas.row(static_cast<Eigen::Index>(i));
    const bool listed = std::any_of(shape.parts.begin(), shape.parts.end(),
                                    [&](const PartDelta& delta) { return delta.part == part; });
    PartDelta delta = detail::sparse_delta(part, dense);
    if (listed || !delta.vertices.empty()) parts.push_back(std::move(delta));
  }
  return parts;
}

void add_up(ExtractResult& result) {
  const auto add = [](double& sum, double value) { sum += value * value; };
  for (const WireFit& fit : result.shapes) {
    add(result.displacement, fit.displacement);
    add(result.error, fit.error);
    add(result.kept_error, fit.kept_error);
    add(result.seen_displacement, fit.seen_displacement);
    add(result.seen_error, fit.seen_error);
    result.largest = std::max(result.largest, fit.largest);
    result.seen_largest = std::max(result.seen_largest, fit.seen_largest);
  }
  for (double* sum : {&result.displacement, &result.error, &result.kept_error, &result.seen_displacement,
                      &result.seen_error})
    *sum = std::sqrt(*sum);
  for (FeatureError& feature : result.features) {
    feature.displacement = std::sqrt(feature.displacement);
    feature.error = std::sqrt(feature.error);
  }
}

}  // namespace

ExtractResult extract_wires(const Character& character, std::span<const Wire> wires,
                            const ExtractOptions& options) {
  if (!(options.residual >= 0) || !std::isfinite(options.residual))
    throw invalid_input("residual", "is " + std::to_string(options.residual),
                        "a part of the face's box, 0 or more");
  if (!(options.residual_vertices >= 0 && options.residual_vertices <= 1))
    throw invalid_input("residual vertices", "are " + std::to_string(options.residual_vertices),
                        "a share of the vertices, 0 to 1");
  std::set<std::string> names;
  for (const Wire& wire : wires)
    if (!names.insert(wire.name).second)
      throw invalid_input("wire " + wire.name, "is there twice", "names of their own");
  ExtractResult result;
  report_progress(options.progress, "set up", 0);
  auto start = Clock::now();
  const WireSolver solver(character, wires, options.solver);
  result.setup_seconds = seconds_since(start);
  const detail::Pieces pieces(character, wires);
  result.box = pieces.box();
  result.skin_vertices = pieces.skin_vertices();
  result.skin = pieces.skin();
  result.vertex_weights = options.solver.vertex_weights;
  std::vector<std::vector<FeatureError>> features(character.shapes.size(), pieces.features());
  result.features = pieces.features();
  result.shapes.resize(character.shapes.size());
  const Fitter fitter(character, solver, pieces, options);
  start = Clock::now();
  std::vector<std::vector<WireMove>> moves = solver.solve(character.shapes);
  result.solve_seconds = seconds_since(start);
  std::vector<std::vector<float>> counts(character.shapes.size());
  parallel_for(character.shapes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      result.shapes[s] = fitter.fit(character.shapes[s], std::move(moves[s]), features[s], counts[s]);
  });
  const double least = least_count(
      counts, static_cast<std::size_t>(options.residual_vertices * static_cast<double>(result.skin_vertices) *
                                       static_cast<double>(character.shapes.size())));
  parallel_for(character.shapes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) fitter.keep(character.shapes[s], least, result.shapes[s]);
  });
  for (const auto& list : features)
    for (std::size_t f = 0; f < list.size(); ++f) {
      result.features[f].displacement += list[f].displacement;
      result.features[f].error += list[f].error;
    }
  add_up(result);
  report_progress(options.progress, "write shapes", 0.9);
  result.character = character;
  result.character.wires.assign(wires.begin(), wires.end());
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    Shape& shape = result.character.shapes[s];
    shape.wires = result.shapes[s].moves;
    if (!options.exact && !shape.wires.empty())
      shape.parts = replaced(character, pieces, character.shapes[s], result.shapes[s]);
  }
  report_progress(options.progress, "write shapes", 1);
  return result;
}

}  // namespace mien
