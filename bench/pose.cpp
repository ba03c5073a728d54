// Dragging and attenuating, in microseconds, beside what else solves the same. Each step of a drag counts with its least
// time of many rounds, the contestants taking turns. MIEN_ICT names ICT-FaceKit's unpacked folder FaceXModel; otherwise the built-in human is
// dragged.

#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <atomic>
#include <chrono>
#include <functional>
#include <new>
#ifdef MIEN_HAS_DLIB
#include <dlib/optimization.h>
#endif

#include "../tests/pose/box_qp_cases.h"
#include "localised_shapes.h"
#include "mien/core/parallel.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"
#include "mien/evaluate/point_evaluator.h"
#include "mien/pose/attenuate.h"
#include "mien/pose/detail/box_qp.h"
#include "mien/pose/solve_pins.h"

namespace {

std::atomic<long> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace mien {
namespace {

using Clock = std::chrono::steady_clock;

/// Microseconds a call, over `steps` calls that belong together (a drag): each step's least of all rounds, averaged. The
/// contestants take turns.
std::vector<double> race(const std::vector<std::function<void()>>& contestants, int steps, int rounds) {
  std::vector<std::vector<double>> best(contestants.size(),
                                        std::vector<double>(static_cast<std::size_t>(steps), 1e18));
  for (int round = 0; round < rounds; ++round)
    for (std::size_t c = 0; c < contestants.size(); ++c)
      for (double& least : best[c]) {
        const auto start = Clock::now();
        contestants[c]();
        least = std::min(least, std::chrono::duration<double, std::micro>(Clock::now() - start).count());
      }
  std::vector<double> mean;
  for (const auto& steps_of_one : best) {
    double sum = 0;
    for (const double least : steps_of_one) sum += least;
    mean.push_back(sum / steps);
  }
  return mean;
}

const Character& face_of(int sliders) {
  static const Character few = dragged_face();
  static const Character many = split_shapes(few, 300);
  return sliders == 300 ? many : few;
}

const Character& corrected_face() {
  static const Character face = with_correctives(face_of(57), 150);
  return face;
}

int moving_vertex(const Character& face, std::mt19937& random) {
  const Shape& shape = face.shapes[random() % face.shapes.size()];
  const PartDelta& delta = shape.parts[0];
  std::size_t most = 0;
  for (std::size_t i = 0; i < delta.vertices.size(); ++i)
    if (delta.deltas.row(static_cast<Eigen::Index>(i)).norm() >
        delta.deltas.row(static_cast<Eigen::Index>(most)).norm())
      most = i;
  return delta.vertices[most];
}

/// A drag of `pins` pins in 100 moves of the pointer: within reach, all towards random slider values, or haphazard: one goes
/// anywhere, the others hold.
struct Drag {
  std::vector<Pin> pins;
  RigPose start;
  std::vector<std::vector<Eigen::Vector3d>> goals;
  double length = 0;  // of the first pin's way

  Drag(const Character& face, int count, bool haphazard, unsigned seed) : start(rest_rig_pose(face)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (double& value : start.sliders.values) value = uniform(random) < 0.7 ? 0 : 0.5 * uniform(random);
    RigPose wanted = start;
    for (double& value : wanted.sliders.values)
      if (uniform(random) < 0.15) value = uniform(random);
    const auto from = evaluate(face, pose_of(face, start)), to = evaluate(face, pose_of(face, wanted));
    std::vector<Eigen::Vector3d> begin, way;
    for (int p = 0; p < count; ++p) {
      Pin pin;
      SurfacePoint at;
      at.vertex = moving_vertex(face, random);
      pin.at = at;
      pins.push_back(pin);
      begin.push_back(from[0].row(at.vertex).transpose().cast<double>());
      way.push_back(to[0].row(at.vertex).transpose().cast<double>() - begin.back());
      pins.back().goal = begin.back();
    }
    length = way[0].norm();
    const double size = bounding_box(face.parts[0].mesh.positions).diagonal();
    for (int step = 0; step <= 100; ++step) {
      std::vector<Eigen::Vector3d> here;
      for (int p = 0; p < count; ++p) {
        const double t = step / 100.0;
        const Eigen::Vector3d wild(std::sin(9 * t + p), std::cos(7 * t + 2 * p), std::sin(5 * t + 3 * p));
        here.push_back(begin[p] +
                       t * (haphazard ? Eigen::Vector3d(p == 0 ? 0.1 * size * wild : 0 * wild) : way[p]));
      }
      goals.push_back(here);
    }
  }
};

void set_goals(PinSolver& solver, const std::vector<Eigen::Vector3d>& goals) {
  for (std::size_t p = 0; p < goals.size(); ++p) solver.set_goal(static_cast<int>(p), goals[p]);
}

/// B, D and g of the drag's program, for the contestants.
struct Program {
  Eigen::MatrixXd b;
  Eigen::VectorXd start, low, high, stiffness, zero;
  std::vector<Eigen::VectorXd> goals;
  double alpha = 0;

  Program(const Character& face, const Drag& drag) {
    std::vector<SurfacePoint> points;
    for (const Pin& pin : drag.pins) points.push_back(std::get<SurfacePoint>(pin.at));
    PointEvaluator evaluator(face, points);
    Eigen::MatrixXd rows;
    evaluator.shape_rows(pose_of(face, drag.start), rows);
    b = rows * shape_weight_slopes(face, drag.start.sliders);
    alpha = 1e-3 * b.squaredNorm() / 3;
    start = drag.start.sliders.values;
    low = -start;
    high = Eigen::VectorXd::Ones(start.size()) - start;
    stiffness.setConstant(start.size(), alpha);
    zero.setZero(start.size());
    PointsD at;
    evaluator.positions(pose_of(face, drag.start), at);
    for (const auto& step : drag.goals) {
      Eigen::VectorXd goal(b.rows());
      for (std::size_t p = 0; p < step.size(); ++p)
        goal.segment<3>(3 * static_cast<Eigen::Index>(p)) =
            step[p] - at.row(static_cast<Eigen::Index>(p)).transpose();
      goals.push_back(goal);
    }
  }
};

std::span<const double> span_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

void solve(benchmark::State& state) {
  const int sliders = static_cast<int>(state.range(0)), pins = static_cast<int>(state.range(1));
  const bool haphazard = state.range(2);
  const Character& face = face_of(sliders);
  const Drag drag(face, pins, haphazard, 1);
  const Program program(face, drag);
  const Eigen::Index rows = program.b.rows(), n = program.b.cols();
  PinSolver solver(face, drag.pins, drag.start);
  std::size_t step = 0, other = 0, third = 0, cold = 0;
  const auto next = [&](std::size_t& s) -> const Eigen::VectorXd& {
    return program.goals[s = (s + 1) % program.goals.size()];
  };
  Eigen::VectorXd w(n), y(rows);
  const Eigen::LDLT<Eigen::MatrixXd> kept(program.b * program.b.transpose() / program.alpha +
                                          Eigen::MatrixXd::Identity(rows, rows));
  detail::BoxQp qp;
  // Woodbury's form without limits: its factor kept, and all of it; Eigen's LDLT of the sliders' matrix, factor kept.
  const Eigen::LDLT<Eigen::MatrixXd> sliders_kept(program.b.transpose() * program.b +
                                                  program.alpha * Eigen::MatrixXd::Identity(n, n));
  std::vector<std::function<void()>> contestants{
      [&] {
        set_goals(solver, drag.goals[step = (step + 1) % drag.goals.size()]);
        solver.solve();
      },
      [&] {
        qp.set_rows(program.b);
        qp.set_sliders({span_of(program.stiffness), span_of(program.zero), span_of(program.zero),
                        span_of(program.low), span_of(program.high)});
        qp.restart();
        qp.solve(span_of(next(cold)));
      },
      [&] {
        y = next(other);
        kept.solveInPlace(y);
        w.noalias() = program.b.transpose() * y;
        w = program.start + w / program.alpha;
      },
      [&] {
        Eigen::MatrixXd k = Eigen::MatrixXd::Identity(rows, rows);
        k.noalias() += program.b * program.b.transpose() / program.alpha;
        y = k.llt().solve(next(third));
        w.noalias() = program.b.transpose() * y;
        w = program.start + w / program.alpha;
      },
      [&] {
        w.noalias() = program.b.transpose() * next(third);
        sliders_kept.solveInPlace(w);
        w += program.start;
      }};
  for (auto _ : state) {
    const std::vector<double> us = race(contestants, 101, pins == 50 ? 15 : 60);
    state.counters["warm_us"] = us[0];
    state.counters["cold_us"] = us[1];
    state.counters["woodbury_kept_us"] = us[2];
    state.counters["woodbury_us"] = us[3];
    state.counters["ldlt_kept_us"] = us[4];
    state.counters["over_woodbury"] = us[0] / us[3];
  }
  const long before = allocations;
  for (int i = 0; i < 300; ++i) contestants[0]();
  state.counters["allocations"] = static_cast<double>(allocations - before);
}
BENCHMARK(solve)
    ->ArgNames({"sliders", "pins", "haphazard"})
    ->ArgsProduct({{57, 300}, {1, 5, 50}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

/// What clipping does instead: distance to the goals over the drag, of the exact answer and of a clipped one.
void clipped(benchmark::State& state) {
  const Character& face = face_of(static_cast<int>(state.range(0)));
  double exact = 0, clip = 0, length = 0, one_pin = 0, one_length = 0;
  for (auto _ : state)
    for (unsigned seed = 0; seed < 40; ++seed) {
      const Drag drag(face, 3, seed % 2, seed);
      const Program program(face, drag);
      const Eigen::VectorXd& goal = program.goals.back();
      PinSolver solver(face, drag.pins, drag.start);
      set_goals(solver, drag.goals.back());
      const Eigen::VectorXd w = solver.solve().pose.sliders.values - program.start;
      const Eigen::MatrixXd h =
          program.b.transpose() * program.b + program.alpha * Eigen::MatrixXd::Identity(w.size(), w.size());
      const Eigen::VectorXd free =
          h.ldlt().solve(program.b.transpose() * goal).cwiseMax(program.low).cwiseMin(program.high);
      exact += (program.b * w - goal).norm();
      clip += (program.b * free - goal).norm();
      length += goal.norm();
      const Drag single(face, 1, false, seed);
      if (single.length < 1e-3 * bounding_box(face.parts[0].mesh.positions).diagonal()) continue;
      PinSolver one(face, single.pins, single.start);
      set_goals(one, single.goals.back());
      one_pin += one.solve().misses[0];
      one_length += single.length;
    }
  state.counters["exact_miss_%"] = 100 * exact / length;
  state.counters["clipped_miss_%"] = 100 * clip / length;
  state.counters["one_pin_reachable_miss_%"] = 100 * one_pin / one_length;
}
BENCHMARK(clipped)->ArgName("sliders")->Arg(57)->Arg(300)->Iterations(1)->Unit(benchmark::kMillisecond);

void optimality(benchmark::State& state) {
  std::mt19937 random(17);
  detail::BoxQp solver;
  double worst = 0;
  int failures = 0, most = 0;
  for (auto _ : state)
    for (int trial = 0; trial < 100000; ++trial) {
      const test::BoxQpCase c = test::random_box_qp(random, 80, false);
      solver.set_rows(c.b);
      solver.restart();
      solver.set_sliders(c.sliders());
      const detail::BoxQp::Outcome outcome = solver.solve(test::BoxQpCase::span(c.goal));
      const double gap = test::optimality_gap(c, test::change_of(solver));
      worst = std::max(worst, gap);
      failures += !(gap <= 1e-9);
      most = std::max(most, outcome.iterations);
    }
  state.counters["cases"] = 100000;
  state.counters["failures"] = failures;
  state.counters["worst_gap"] = worst;
  state.counters["most_iterations"] = most;
}
BENCHMARK(optimality)->Iterations(1)->Unit(benchmark::kMillisecond);

void correctives(benchmark::State& state) {
  const Character& face = corrected_face();
  const int pins = static_cast<int>(state.range(0));
  const Drag drag(face, pins, state.range(1), 2);
  PinSolver solver(face, drag.pins, drag.start);
  std::size_t step = 0;
  long solves = 0, calls = 0, most = 0;
  const std::vector<std::function<void()>> move{[&] {
    set_goals(solver, drag.goals[step = (step + 1) % drag.goals.size()]);
    const SolvePinsResult& result = solver.solve();
    solves += result.solves;
    most = std::max<long>(most, result.solves);
    ++calls;
  }};
  for (auto _ : state) state.counters["us"] = race(move, 101, 30)[0];
  state.counters["programs"] = static_cast<double>(solves) / static_cast<double>(calls);
  state.counters["most_programs"] = static_cast<double>(most);
}
BENCHMARK(correctives)
    ->ArgNames({"pins", "haphazard"})
    ->ArgsProduct({{1, 5, 50}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

void drag_to_mesh(benchmark::State& state) {
  const Character& face = face_of(static_cast<int>(state.range(0)));
  const Drag drag(face, 5, false, 3);
  set_thread_count(1);
  PinSolver solver(face, drag.pins, drag.start);
  Evaluator evaluator(face);
  std::vector<float> positions(3 * evaluator.vertex_count());
  std::size_t step = 0;
  const std::vector<std::function<void()>> move{[&] {
    set_goals(solver, drag.goals[step = (step + 1) % drag.goals.size()]);
    evaluator.evaluate(pose_of(face, solver.solve().pose), positions);
  }};
  for (auto _ : state) state.counters["us"] = race(move, 101, 10)[0];
  set_thread_count(0);
}
BENCHMARK(drag_to_mesh)->ArgName("sliders")->Arg(57)->Arg(300)->Iterations(1)->Unit(benchmark::kMillisecond);

void tag(benchmark::State& state) {
  const Character& face = face_of(static_cast<int>(state.range(0)));
  set_thread_count(1);
  std::mt19937 random(4);
  const auto start = Clock::now();
  Attenuator attenuator(face, rest_rig_pose(face));
  state.counters["once_ms"] = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  const auto tag_of = [&](int vertex) {
    Tag tag;
    tag.at.vertex = vertex;
    return tag;
  };
  for (int i = 0; i < static_cast<int>(state.range(1)) - 1; ++i)
    attenuator.add_tag(tag_of(moving_vertex(face, random)));
  const Tag one = tag_of(moving_vertex(face, random));
  SliderValues values = rest_sliders(face);
  double add = 1e18, remove = 1e18, move = 1e18;
  for (auto _ : state)
    for (int round = 0; round < 200; ++round) {
      const auto begin = Clock::now();
      const int number = attenuator.add_tag(one);
      const auto added = Clock::now();
      for (int i = 0; i < 1000; ++i) attenuator.move_slider(i % 57, 1e-6, values);
      const auto moved = Clock::now();
      attenuator.remove_tag(number);
      const auto removed = Clock::now();
      add = std::min(add, std::chrono::duration<double, std::micro>(added - begin).count());
      move = std::min(move, std::chrono::duration<double, std::micro>(moved - added).count() / 1000);
      remove = std::min(remove, std::chrono::duration<double, std::micro>(removed - moved).count());
    }
  state.counters["add_us"] = add;
  state.counters["remove_us"] = remove;
  state.counters["move_us"] = move;
  set_thread_count(0);
}
BENCHMARK(tag)
    ->ArgNames({"sliders", "tags"})
    ->ArgsProduct({{57, 300}, {1, 10}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

#ifdef MIEN_HAS_DLIB
/// The one box QP solver that Debian packages, on the same program to the same accuracy in its own measure.
void dlib_solver(benchmark::State& state) {
  const Character& face = face_of(static_cast<int>(state.range(0)));
  const Program program(face, Drag(face, static_cast<int>(state.range(1)), false, 1));
  const Eigen::Index n = program.b.cols();
  const Eigen::MatrixXd h =
      program.b.transpose() * program.b + program.alpha * Eigen::MatrixXd::Identity(n, n);
  dlib::matrix<double> q(n, n);
  dlib::matrix<double, 0, 1> c(n), x(n), low(n), high(n);
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index k = 0; k < n; ++k) q(r, k) = h(r, k);
  std::size_t step = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    low(j) = program.low[j];
    high(j) = program.high[j];
    x(j) = std::clamp(0.0, low(j), high(j));
  }
  const std::vector<std::function<void()>> move{[&] {
    const Eigen::VectorXd right =
        -(program.b.transpose() * program.goals[step = (step + 1) % program.goals.size()]);
    for (Eigen::Index j = 0; j < n; ++j) c(j) = right[j];
    dlib::solve_qp_box_constrained(q, c, x, low, high, 1e-9 * program.alpha, 100000);
  }};
  for (auto _ : state) state.counters["warm_us"] = race(move, 5, 3)[0];
}
BENCHMARK(dlib_solver)
    ->ArgNames({"sliders", "pins"})
    ->ArgsProduct({{57, 300}, {1, 5}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace mien
