// Eq. 3 in the change from the start: 1/2 |B dx - g|^2 + 1/2 dx'D dx - pull'dx, see detail/box_qp.h. B's rows are the pins'
// derivatives along their held axes, times the root of their weight.
#include "mien/pose/solve_pins.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mien/core/error.h"
#include "mien/pose/detail/box_qp.h"
#include "mien/pose/detail/joint_limits.h"
#include "mien/pose/detail/pin_checks.h"
#include "mien/pose/detail/pinned_rig.h"

namespace mien {
namespace {

using detail::BoxQp;
using detail::pin_name;
using detail::PinnedRig;

constexpr double moved_by = 1e-6;         // slider units
constexpr double met_to = 1e-6;           // of the face's box
constexpr double hard_tolerance = 1e-10;  // of the face's box: where the multipliers stop
constexpr double hard_stiffness = 1e6;    // a hard pin's pull against the sliders' stiffness
constexpr int most_multiplier_steps = 40;

double size_of(const Character& character) {
  double square = 0;
  for (const Part& part : character.parts)
    square = std::max(square, std::pow(bounding_box(part.mesh.positions).diagonal(), 2));
  return square > 0 ? std::sqrt(square) : 1;
}

PinnedRig::Freed freed_by(const SolvePinsOptions& options, double length) {
  PinnedRig::Freed freed;
  freed.length = length;
  for (const DraggedWire& wire : options.wires) freed.wires.push_back(wire.wire);
  for (const DraggedJoint& joint : options.joints) {
    const bool turns = joint.turn_low != joint.turn_high, shifts = joint.shift_low != joint.shift_high;
    if (turns || shifts) freed.joints.push_back({joint.node, turns, shifts});
  }
  return freed;
}

std::span<const double> span_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

const Character& checked(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
                         const SolvePinsOptions& options) {
  detail::check_options(character, options);
  detail::check_pins(character, pins, !options.wires.empty());
  detail::check_start(character, start);
  return character;
}

/// The options with joints that stay within the character's own limits.
SolvePinsOptions narrowed(const Character& character, SolvePinsOptions options) {
  options.joints = detail::within_limits(character, std::move(options.joints));
  return options;
}

}  // namespace

struct PinSolver::Impl {
  Impl(const Character& character, const std::vector<Pin>& given, const RigPose& start,
       const SolvePinsOptions& given_options)
      : pins(given),
        options(narrowed(character, given_options)),
        size(size_of(checked(character, given, start, given_options))),
        rig(character, pins, start, freed_by(options, size)),
        result(start) {
    sliders = static_cast<int>(character.sliders.size());
    x = start_x = rig.start();
    set_rows_at_start();
    set_stiffness(character);
    set_limits(character);
    set_goals();
    low_now = low;
    high_now = high;
    prepare();
    result.misses.resize(pins.size());
    result.moved.reserve(character.sliders.size());
  }

  void set_rows_at_start();
  void set_stiffness(const Character& character);
  void add_prior_rows();
  void set_limits(const Character& character);
  void set_goals();
  void set_row_goals(int pin);
  void prepare();
  void weigh_rows(const Eigen::VectorXd& at);
  double objective(const Eigen::VectorXd& at, Eigen::VectorXd& coordinates);
  double value_of(const Eigen::VectorXd& at, const Eigen::VectorXd& found) const;
  BoxQp::Outcome solve_program();
  void minimise();
  void minimise_linear();
  void minimise_sequence();
  void run();
  bool add_multipliers(double& worst);
  void run_sparse();
  void run_exclusive();
  void hold(int unknown, double change);
  void free_all();
  void write_result();

  std::vector<Pin> pins;  // goals absolute
  SolvePinsOptions options;
  double size;
  PinnedRig rig;
  int sliders = 0;
  Eigen::VectorXd start_x, x, next_x, trial_x;
  Eigen::MatrixXd b;                            // weighted rows, the prior's below
  Eigen::VectorXd row_weight, row_goal, shift;  // root of the weight, goal, what the multipliers add to it
  Eigen::VectorXd goal;                         // of the program
  Eigen::MatrixXd prior_rows;
  Eigen::VectorXd prior_goal;
  Eigen::VectorXd stiffness, pull, sparse, low, high, low_now, high_now;
  Eigen::VectorXd least, most;  // the limits of x itself
  Eigen::VectorXd start_coordinates, coordinates, trial_coordinates;
  Eigen::VectorXd rest;  // of the sliders, as a change
  BoxQp qp;
  std::vector<int> first_row;  // of each pin, and the end
  bool any_hard = false;
  SolvePinsResult result;
};

void PinSolver::Impl::set_rows_at_start() {
  row_weight.resize(rig.row_count());
  for (int r = 0; r < rig.row_count(); ++r) row_weight[r] = std::sqrt(pins[rig.pin_of(r)].weight);
  rig.rows(start_x, b);
  b.array().colwise() *= row_weight.array();
  if (!(b.squaredNorm() > 0))
    throw invalid_input(pins.size() == 1 ? "pin 1" : "pins",
                        options.wires.empty()
                            ? "cannot be moved: no slider moves the face there"
                            : "cannot be moved: neither a slider nor a wire moves the face there",
                        "pin a point that a shape moves");
}

void PinSolver::Impl::set_stiffness(const Character& character) {
  const double alpha = options.file_units ? options.file_units->alpha : options.rho * b.squaredNorm() / 3;
  const double mu = options.file_units ? options.file_units->mu : options.decay * alpha;
  const Eigen::Index n = rig.unknown_count();
  stiffness.setConstant(n, alpha);
  for (std::size_t s = 0; s < options.stiffness.size(); ++s)
    stiffness[static_cast<Eigen::Index>(s)] *= options.stiffness[s];
  stiffness.head(sliders).array() += mu;
  pull.setZero(n);
  pull.head(sliders) = -mu * start_x.head(sliders);
  sparse.setZero(n);
  Eigen::Index column = sliders;
  for (const DraggedJoint& joint : options.joints) {
    const int unknowns = 3 * (joint.turn_low != joint.turn_high) + 3 * (joint.shift_low != joint.shift_high);
    stiffness.segment(column, unknowns).setConstant(joint.stiffness * (alpha + mu));
    column += unknowns;
  }
  for (const DraggedWire& dragged : options.wires) {
    const Wire& wire = character.wires[static_cast<std::size_t>(dragged.wire)];
    const int unknowns = 3 * wire.curve.control_count() + 1 + 3 * wire.turn_controls;
    stiffness.segment(column, unknowns).setConstant(dragged.stiffness * (alpha + mu));
    column += unknowns;
  }
  const double most = row_weight.maxCoeff() * row_weight.maxCoeff();
  for (std::size_t p = 0; p < pins.size(); ++p) {
    if (!pins[p].hard) continue;
    any_hard = true;
    double square = 0;
    for (int r = 0; r < rig.row_count(); ++r)
      if (rig.pin_of(r) == static_cast<int>(p)) square += b.row(r).squaredNorm() / pins[p].weight;
    const double weight = square > 0 ? std::max(hard_stiffness * (alpha + mu) / square, 1000 * most) : 1;
    for (int r = 0; r < rig.row_count(); ++r)
      if (rig.pin_of(r) == static_cast<int>(p)) row_weight[r] = std::sqrt(weight);
  }
  rest.resize(sliders);
  for (int s = 0; s < sliders; ++s)
    rest[s] = character.sliders[static_cast<std::size_t>(s)].rest - start_x[s];
  if (options.prior && options.prior_strength > 0) {
    const Eigen::LLT<Eigen::MatrixXd> root(options.prior->precision);
    if (root.info() != Eigen::Success)
      throw invalid_input("prior", "has a precision that is not positive definite",
                          "one that learn_prior made");
    prior_rows.setZero(sliders, n);
    prior_rows.leftCols(sliders) =
        std::sqrt(options.prior_strength * alpha) * Eigen::MatrixXd(root.matrixU());
    prior_goal.setZero(sliders);
    if (options.towards_prior_mean)
      prior_goal = prior_rows.leftCols(sliders) * (options.prior->mean - start_x.head(sliders));
  }
}

void PinSolver::Impl::set_limits(const Character& character) {
  const Eigen::Index n = rig.unknown_count();
  low.resize(n);
  high.resize(n);
  for (int s = 0; s < sliders; ++s) {
    low[s] = character.sliders[static_cast<std::size_t>(s)].minimum;
    high[s] = character.sliders[static_cast<std::size_t>(s)].maximum;
  }
  for (const SliderLimits& limits : options.limits) {
    low[limits.slider] = limits.low;
    high[limits.slider] = limits.high;
  }
  Eigen::Index column = sliders;
  for (const DraggedJoint& joint : options.joints) {
    if (joint.turn_low != joint.turn_high) {
      low.segment<3>(column) = joint.turn_low;
      high.segment<3>(column) = joint.turn_high;
      column += 3;
    }
    if (joint.shift_low != joint.shift_high) {
      low.segment<3>(column) = joint.shift_low / size;
      high.segment<3>(column) = joint.shift_high / size;
      column += 3;
    }
  }
  low.tail(n - column).setConstant(-std::numeric_limits<double>::infinity());  // wires
  high.tail(n - column).setConstant(std::numeric_limits<double>::infinity());
  for (const int slider : options.locked) low[slider] = high[slider] = start_x[slider];
  least = low;
  most = high;
  low -= start_x;
  high -= start_x;
}

void PinSolver::Impl::set_goals() {
  first_row.push_back(0);
  for (const Pin& pin : pins) first_row.push_back(first_row.back() + pin.axes.count);
  row_goal.resize(rig.row_count());
  shift.setZero(rig.row_count());
  for (std::size_t p = 0; p < pins.size(); ++p) {
    if (pins[p].goal_is_move)
      pins[p].goal += rig.start_positions().row(static_cast<Eigen::Index>(p)).transpose();
    pins[p].goal_is_move = false;
    set_row_goals(static_cast<int>(p));
  }
  detail::check_hard_pins(pins, 1e-9 * size);
}

void PinSolver::Impl::set_row_goals(int pin) {
  for (int r = first_row[static_cast<std::size_t>(pin)]; r < first_row[static_cast<std::size_t>(pin) + 1];
       ++r)
    row_goal[r] = rig.direction_of(r).dot(pins[static_cast<std::size_t>(pin)].goal);
}

void PinSolver::Impl::prepare() {
  goal.resize(rig.row_count() + prior_rows.rows());
  rig.coordinates(start_x, start_coordinates);
  coordinates = trial_coordinates = start_coordinates;
  next_x = trial_x = x;
  weigh_rows(start_x);
  qp.set_rows(b);
  qp.set_sliders({span_of(stiffness), span_of(pull), span_of(sparse), span_of(low_now), span_of(high_now)});
}

void PinSolver::Impl::weigh_rows(const Eigen::VectorXd& at) {
  rig.rows(at, b);
  b.array().colwise() *= row_weight.array();
  if (prior_rows.rows() == 0) return;
  b.conservativeResize(rig.row_count() + prior_rows.rows(), Eigen::NoChange);
  b.bottomRows(prior_rows.rows()) = prior_rows;
}

double PinSolver::Impl::objective(const Eigen::VectorXd& at, Eigen::VectorXd& found) {
  rig.coordinates(at, found);
  return value_of(at, found);
}

double PinSolver::Impl::value_of(const Eigen::VectorXd& at, const Eigen::VectorXd& found) const {
  double value = 0;
  for (int r = 0; r < rig.row_count(); ++r) {
    const double miss = row_weight[r] * (found[r] - row_goal[r] - shift[r]);
    value += miss * miss / 2;
  }
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    const double change = at[j] - start_x[j];
    value += change * (stiffness[j] / 2 * change - pull[j]) + sparse[j] * std::abs(change);
  }
  if (prior_rows.rows() > 0) value += (prior_rows * (at - start_x) - prior_goal).squaredNorm() / 2;
  return value;
}

BoxQp::Outcome PinSolver::Impl::solve_program() {
  if (prior_rows.rows() > 0) goal.tail(prior_rows.rows()) = prior_goal;
  const BoxQp::Outcome outcome = qp.solve(span_of(goal));
  ++result.solves;
  result.converged &= outcome.converged;
  const std::span<const double> change = qp.change();
  for (Eigen::Index j = 0; j < next_x.size(); ++j)  // start + (limit - start) may round past the limit
    next_x[j] = std::clamp(start_x[j] + change[static_cast<std::size_t>(j)], least[j], most[j]);
  return outcome;
}

void PinSolver::Impl::minimise() {
  if (rig.linear())
    minimise_linear();
  else
    minimise_sequence();
}

/// The points' coordinates come out of the program's remainder, without another product.
void PinSolver::Impl::minimise_linear() {
  for (int r = 0; r < rig.row_count(); ++r)
    goal[r] = row_weight[r] * (row_goal[r] + shift[r] - start_coordinates[r]);
  solve_program();
  x = next_x;
  const std::span<const double> remainder = qp.remainder();
  for (int r = 0; r < rig.row_count(); ++r)
    coordinates[r] = row_goal[r] + shift[r] - remainder[static_cast<std::size_t>(r)] / row_weight[r];
}

void PinSolver::Impl::minimise_sequence() {
  // The last pose or the start, whichever is nearer the answer: back at the start the start itself is.
  const Eigen::VectorXd inside = start_x + low_now.cwiseMax(0.0).cwiseMin(high_now);
  x = (start_x + (x - start_x).cwiseMax(low_now).cwiseMin(high_now)).eval();
  const double at_x = objective(x, coordinates);
  if (objective(inside, trial_coordinates) <= at_x) x = inside;
  double value = objective(x, coordinates);
  const int first = result.solves;
  result.converged = false;
  while (result.solves - first < options.most_solves && !result.converged) {
    weigh_rows(x);
    for (int r = 0; r < rig.row_count(); ++r)
      goal[r] = row_weight[r] * (row_goal[r] + shift[r] - coordinates[r]);
    goal.head(rig.row_count()) += b.topRows(rig.row_count()) * (x - start_x);
    qp.set_rows(b);
    qp.set_sliders({span_of(stiffness), span_of(pull), span_of(sparse), span_of(low_now), span_of(high_now)});
    result.converged = true;
    if (!solve_program().converged) result.converged = false;
    const double change = (next_x - x).cwiseAbs().maxCoeff();
    double share = 1;
    for (; share > 1e-3; share /= 2) {
      trial_x = x + share * (next_x - x);
      const double trial = objective(trial_x, trial_coordinates);
      if (trial > value) continue;
      x = trial_x;
      coordinates.swap(trial_coordinates);
      result.converged = change < 1e-7 || value - trial <= 1e-12 * value;
      value = trial;
      break;
    }
    if (share <= 1e-3) result.converged = true;  // nothing along the way is better
  }
}

/// Adds what the hard pins miss to their goals; false when that ends it.
bool PinSolver::Impl::add_multipliers(double& worst) {
  double now = 0;
  for (int r = 0; r < rig.row_count(); ++r) {
    if (!pins[rig.pin_of(r)].hard) continue;
    const double miss = row_goal[r] - coordinates[r];
    shift[r] += miss;
    now = std::max(now, std::abs(miss));
  }
  const bool stuck = now > 0.99 * worst;
  worst = now;
  return now > hard_tolerance * size && !stuck;
}

void PinSolver::Impl::run() {
  shift.setZero();
  minimise();
  double worst = std::numeric_limits<double>::infinity();
  for (int i = 0; any_hard && i < most_multiplier_steps && add_multipliers(worst); ++i) minimise();
}

void PinSolver::Impl::hold(int unknown, double change) {
  low_now[unknown] = high_now[unknown] = std::clamp(change, low[unknown], high[unknown]);
}

void PinSolver::Impl::free_all() {
  low_now = low;
  high_now = high;
  sparse.setZero();
}

void PinSolver::Impl::run_sparse() {
  free_all();
  weigh_rows(start_x);
  const Eigen::VectorXd misses = row_weight.cwiseProduct(row_goal - start_coordinates);
  const Eigen::VectorXd pulls = (b.topRows(rig.row_count()).transpose() * misses).cwiseAbs();
  sparse.setConstant(options.sparsity * pulls.maxCoeff());
  prepare();
  run();
  for (int j = 0; j < static_cast<int>(x.size()); ++j)
    if (std::abs(x[j] - start_x[j]) < 1e-9) hold(j, 0);
  sparse.setZero();
  prepare();
  run();
}

/// Group after group: whichever member alone gives the lowest objective keeps its freedom.
void PinSolver::Impl::run_exclusive() {
  const auto run_one = [&] {
    prepare();
    run();
    return value_of(x, coordinates);
  };
  for (const std::vector<int>& group : options.exclusive) {
    int away = 0;
    for (const int s : group) away += std::abs(x[s] - start_x[s] - rest[s]) > moved_by;
    if (away <= 1) continue;
    int best = group[0];
    double lowest = std::numeric_limits<double>::infinity();
    const Eigen::VectorXd low_before = low_now, high_before = high_now;
    const auto keep = [&](int member) {
      low_now = low_before;
      high_now = high_before;
      for (const int s : group)
        if (s != member) hold(s, rest[s]);
      return run_one();
    };
    for (const int member : group)
      if (const double value = keep(member); value < lowest) {
        lowest = value;
        best = member;
      }
    keep(best);
  }
}

void PinSolver::Impl::write_result() {
  rig.write(x, result.pose);
  result.moved.clear();
  for (int s = 0; s < sliders; ++s)
    if (std::abs(x[s] - start_x[s]) > moved_by) result.moved.push_back(s);
  std::fill(result.misses.begin(), result.misses.end(), 0.0);
  for (int r = 0; r < rig.row_count(); ++r) {
    const double miss = coordinates[r] - row_goal[r];
    result.misses[static_cast<std::size_t>(rig.pin_of(r))] += miss * miss;
  }
  shift.setZero();
  result.objective = value_of(x, coordinates);
  result.hard_met = true;
  for (std::size_t p = 0; p < pins.size(); ++p) {
    result.misses[p] = std::sqrt(result.misses[p]);
    if (pins[p].hard && result.misses[p] > met_to * size) result.hard_met = false;
  }
}

PinSolver::PinSolver(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
                     const SolvePinsOptions& options)
    : impl_(std::make_unique<Impl>(character, pins, start, options)) {}
PinSolver::~PinSolver() = default;
PinSolver::PinSolver(PinSolver&&) noexcept = default;
PinSolver& PinSolver::operator=(PinSolver&&) noexcept = default;

const PointsD& PinSolver::start_positions() const {
  return impl_->rig.start_positions();
}

void PinSolver::set_goal(int pin, const Eigen::Vector3d& goal) {
  if (pin < 0 || pin >= static_cast<int>(impl_->pins.size()))
    throw invalid_input(pin_name(static_cast<std::size_t>(std::max(pin, -1))), "does not exist",
                        "one that the drag started with");
  if (!goal.allFinite())
    throw invalid_input(pin_name(static_cast<std::size_t>(pin)), "has a goal that is not finite",
                        "three finite numbers");
  impl_->pins[static_cast<std::size_t>(pin)].goal = goal;
  impl_->set_row_goals(pin);
}

const SolvePinsResult& PinSolver::solve() {
  Impl& s = *impl_;
  s.result.solves = 0;
  s.result.converged = true;
  if (s.options.sparsity > 0) {
    s.run_sparse();
  } else {
    if (!s.options.exclusive.empty()) {
      s.free_all();
      s.prepare();
    }
    s.run();
  }
  if (!s.options.exclusive.empty()) s.run_exclusive();
  s.write_result();
  return s.result;
}

SolvePinsResult solve_pins(const Character& character, const std::vector<Pin>& pins, const RigPose& start,
                           const SolvePinsOptions& options) {
  PinSolver solver(character, pins, start, options);
  return solver.solve();
}

}  // namespace mien
