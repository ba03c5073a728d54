// Extraction of wires: what they leave of the displacements, and what each step costs on one core. ICT-FaceKit's face when the
// environment variable MIEN_ICT names the unpacked folder FaceXModel and MIEN_ICT_LANDMARKS its landmark file, measured over its
// face (vertices 0 to 9408); otherwise the built-in human, over all that wires reach.

#include "mien/deform/wires.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "mien/core/parallel.h"
#include "mien/deform/bind_wires.h"
#include "mien/extract/draw_wires.h"
#include "mien/extract/extract_wires.h"
#include "mien/extract/improve_wires.h"
#include "mien/io/assemble.h"
#include "mien/io/landmark_file.h"
#include "mien/sample/sample.h"

namespace {

constexpr int ict_face = 9409;

bool with_ict() {
  return std::getenv("MIEN_ICT") && std::getenv("MIEN_ICT_LANDMARKS");
}

mien::Character load_face() {
  if (!with_ict()) return mien::make_sample("human");
  const std::filesystem::path folder = std::getenv("MIEN_ICT");
  std::vector<std::filesystem::path> shapes;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".obj" && name.rfind("identity", 0) != 0 &&
        name.rfind("generic", 0) != 0 && name.rfind("Pupil", 0) != 0)
      shapes.push_back(entry.path());
  }
  std::sort(shapes.begin(), shapes.end());
  mien::Character face = mien::assemble(folder / "generic_neutral_mesh.obj", shapes);
  face.landmarks = mien::read_landmarks(std::getenv("MIEN_ICT_LANDMARKS"), face).landmarks;
  return face;
}

const mien::Character& face() {
  static const mien::Character character = load_face();
  return character;
}

struct Setup {
  std::vector<mien::Wire> wires;
  mien::ExtractOptions options;
};

/// Wires with their ranges, made once a row.
const Setup& setup(int count, int turns) {
  static std::map<std::pair<int, int>, Setup> made;
  const auto [at, is_new] = made.try_emplace({count, turns});
  if (!is_new) return at->second;
  mien::set_thread_count(0);
  std::vector<mien::WireSketch> sketches = mien::face_wire_sketches(face(), count);
  for (mien::WireSketch& sketch : sketches) sketch.turn_controls = turns;
  Setup& result = at->second;
  result.wires = mien::draw_wires(face(), sketches);
  result.options.solver.vertex_weights = mien::outer_vertex_weights(face(), result.wires);
  mien::ImproveOptions improve;
  improve.solver = result.options.solver;
  improve.alike = turns > 0;
  result.wires = mien::improve_wires(face(), result.wires, improve).wires;
  return result;
}

bool is_lid(const std::string& shape) {
  for (const char* start : {"eyeBlink", "eyeLook", "eyeSquint", "eyeWide"})
    if (shape.rfind(start, 0) == 0) return true;
  return false;
}

Eigen::Index measured_vertices() {
  return static_cast<Eigen::Index>(with_ict() ? ict_face : face().parts[0].mesh.vertex_count());
}

struct Errors {
  double displacement = 0, error = 0, kept = 0, largest = 0, kept_vertices = 0;
};

/// Over the measured vertices of part 0.
void add_shape(const mien::Shape& shape, const mien::WireFit& fit, Errors& errors) {
  const Eigen::Index count = measured_vertices();
  mien::Points left = mien::Points::Zero(count, 3);
  const auto add = [&](const std::vector<mien::PartDelta>& deltas, float sign) {
    double touched = 0;
    for (const mien::PartDelta& delta : deltas)
      for (std::size_t i = 0; delta.part == 0 && i < delta.vertices.size(); ++i)
        if (delta.vertices[i] < count) {
          left.row(delta.vertices[i]) += sign * delta.deltas.row(static_cast<Eigen::Index>(i));
          ++touched;
        }
    return touched;
  };
  add(shape.parts, 1);
  errors.displacement += left.cast<double>().squaredNorm();
  add(fit.rebuilt, -1);
  errors.error += left.cast<double>().squaredNorm();
  errors.largest = std::max<double>(errors.largest, left.rowwise().norm().maxCoeff());
  errors.kept_vertices += add(fit.residual, -1);
  errors.kept += left.cast<double>().squaredNorm();
}

void extract(benchmark::State& state) {
  const Setup& row = setup(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  mien::set_thread_count(1);
  mien::ExtractResult result;
  double setup_seconds = 1e9, solve_seconds = 1e9;
  for (auto _ : state) {
    result = mien::extract_wires(face(), row.wires, row.options);
    setup_seconds = std::min(setup_seconds, result.setup_seconds);
    solve_seconds = std::min(solve_seconds, result.solve_seconds);
  }
  mien::set_thread_count(0);
  const auto measured = static_cast<double>(measured_vertices());
  mien::ExtractOptions capped = row.options;  // a residual on 2 % of the measured vertices
  capped.residual = 0;
  capped.residual_vertices = 0.02 * measured / static_cast<double>(result.skin_vertices);
  result = mien::extract_wires(face(), row.wires, capped);
  const double box = with_ict()
                         ? mien::bounding_box(face().parts[0].mesh.positions.topRows(ict_face)).diagonal()
                         : result.box;
  Errors all, lids;
  double control = 0;
  for (std::size_t s = 0; s < result.shapes.size(); ++s) {
    add_shape(face().shapes[s], result.shapes[s], all);
    if (is_lid(result.shapes[s].shape)) add_shape(face().shapes[s], result.shapes[s], lids);
    for (const mien::WireMove& move : result.shapes[s].moves)
      control = std::max(control, move.controls.rowwise().norm().maxCoeff());
  }
  const auto shapes = static_cast<double>(result.shapes.size());
  state.counters["error, %"] = 100 * std::sqrt(all.error / all.displacement);
  state.counters["largest, % of box"] = 100 * all.largest / box;
  state.counters["lids, %"] = lids.displacement > 0 ? 100 * std::sqrt(lids.error / lids.displacement) : 0;
  state.counters["with residual, %"] = 100 * std::sqrt(all.kept / all.displacement);
  state.counters["residual on, % of vertices"] = 100 * all.kept_vertices / shapes / measured;
  state.counters["control point, % of box"] = 100 * control / box;
  state.counters["system, ms"] = 1000 * setup_seconds;
  state.counters["a shape, ms"] = 1000 * solve_seconds / shapes;
}

void bind(benchmark::State& state) {
  std::vector<mien::Wire> wires = setup(static_cast<int>(state.range(0)), 4).wires;
  mien::set_thread_count(1);
  for (auto _ : state) wires = mien::bind_wires(face(), std::move(wires));
  mien::set_thread_count(0);
}

void solve(benchmark::State& state) {
  const Setup& row = setup(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const mien::WireSolver solver(face(), row.wires, row.options.solver);
  std::size_t shape = 0;
  for (auto _ : state) benchmark::DoNotOptimize(solver.solve(face().shapes[shape++ % face().shapes.size()]));
}

void apply(benchmark::State& state) {
  const Setup& row = setup(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const mien::WireSolver solver(face(), row.wires, row.options.solver);
  const mien::WireField field(face(), row.wires);
  const std::vector<mien::WireMove> moves = solver.solve(face().shapes[0]);
  mien::PointsD positions = face().parts[0].mesh.positions.cast<double>();
  for (auto _ : state) field.add(0, moves, positions);
}

BENCHMARK(extract)
    ->ArgNames({"wires", "turns"})
    ->ArgsProduct({{15, 22}, {0, 4}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(3);
BENCHMARK(bind)->ArgName("wires")->Arg(15)->Arg(22)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(solve)
    ->ArgNames({"wires", "turns"})
    ->ArgsProduct({{15, 22}, {0, 4}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(apply)
    ->ArgNames({"wires", "turns"})
    ->ArgsProduct({{15, 22}, {0, 4}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
