// The unit that other benchmarks count in: one pass of closest points, every vertex of one face to the other
// face.

#include <benchmark/benchmark.h>

#include <vector>

#include "mien/core/parallel.h"
#include "mien/geometry/surface_query.h"
#include "sphere_face.h"

namespace {

using mien::bench::sphere_face;

void build(benchmark::State& state) {
  const auto target = sphere_face(static_cast<int>(state.range(0)), 0.5);
  for (auto _ : state) {
    mien::SurfaceQuery query(target.positions, target.triangles);
    benchmark::DoNotOptimize(query);
  }
  state.counters["triangles"] = static_cast<double>(target.triangles.rows());
}

void closest_point_pass(benchmark::State& state) {
  const auto source = sphere_face(static_cast<int>(state.range(0)), 0.0);
  const auto target = sphere_face(static_cast<int>(state.range(0)), 0.5);
  const mien::SurfaceQuery query(target.positions, target.triangles);
  std::vector<double> distances(static_cast<std::size_t>(source.positions.rows()));
  mien::set_thread_count(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    mien::parallel_for(distances.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        distances[v] = query.closest(source.positions.row(static_cast<Eigen::Index>(v))).distance;
    });
    benchmark::DoNotOptimize(distances.data());
  }
  mien::set_thread_count(0);
  state.counters["queries"] = static_cast<double>(distances.size());
}

BENCHMARK(build)->Arg(1000)->Arg(10000)->Arg(27000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(closest_point_pass)
    ->ArgNames({"vertices", "threads"})
    ->ArgsProduct({{1000, 10000, 27000, 100000}, {1, 0}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
