// A whole transfer, step by step, in units of one pass of closest points of the same size taken in the same run: seconds
// drift with the machine, passes do not. ICT-FaceKit's face (57 shapes, UVs) goes onto another of its identities when the
// environment variable MIEN_ICT names the unpacked folder FaceXModel and MIEN_ICT_LANDMARKS its landmark file; otherwise
// the built-in human goes onto the creature.

#include "mien/transfer/transfer.h"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "mien/core/parallel.h"
#include "mien/geometry/surface_query.h"
#include "mien/io/assemble.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/sample/sample.h"

namespace {

struct Faces {
  mien::Character source, target;
};

Faces ict_faces(const std::filesystem::path& folder, const char* landmarks) {
  std::vector<std::filesystem::path> shapes;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".obj" && name.rfind("identity", 0) != 0 && name.rfind("generic", 0) != 0)
      shapes.push_back(entry.path());
  }
  std::sort(shapes.begin(), shapes.end());
  Faces faces{mien::assemble(folder / "generic_neutral_mesh.obj", shapes),
              mien::load(folder / "identity000.obj")};
  for (mien::Character* face : {&faces.source, &faces.target})
    face->landmarks = mien::read_landmarks(landmarks, *face).landmarks;
  faces.target.parts[0].mesh.uvs.clear();
  return faces;
}

const Faces& faces() {
  static const Faces both = [] {
    const char* folder = std::getenv("MIEN_ICT");
    const char* landmarks = std::getenv("MIEN_ICT_LANDMARKS");
    if (folder && landmarks) return ict_faces(folder, landmarks);
    return Faces{mien::make_sample("human"), mien::make_sample("creature")};
  }();
  return both;
}

/// Seconds of one pass: building the hierarchy of the source's first part and one closest point for every vertex of the
/// target's.
double pass_seconds() {
  const mien::Mesh &from = faces().target.parts[0].mesh, &to = faces().source.parts[0].mesh;
  const mien::Triangles triangles = mien::triangulate(to.faces);
  std::vector<double> distances(from.vertex_count());
  double best = 1e9;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    const mien::SurfaceQuery query(to.positions, triangles);
    mien::parallel_for(distances.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        distances[v] =
            query.closest(from.positions.row(static_cast<Eigen::Index>(v)).transpose().cast<double>())
                .distance;
    });
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

void transfer(benchmark::State& state) {
  mien::set_thread_count(static_cast<int>(state.range(1)));
  mien::TransferOptions options;
  if (state.range(0)) options.method = mien::TransferMethod::thesis;
  const Faces& both = faces();
  const double pass = pass_seconds();
  std::map<std::string, double> seconds;
  for (auto _ : state) {
    const mien::TransferResult result = mien::transfer(both.source, both.target, options);
    for (const mien::StepTime& step : result.report.steps) {
      double& best = seconds.emplace(step.step, step.seconds).first->second;
      best = std::min(best, step.seconds);
    }
  }
  mien::set_thread_count(0);
  double total = 0;
  for (const auto& [step, time] : seconds) {
    state.counters[step] = time / pass;
    total += time;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["all, passes"] = total / pass;
  state.counters["pass, ms"] = 1000 * pass;
  state.counters["peak MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
}

BENCHMARK(transfer)
    ->ArgNames({"thesis", "threads"})
    ->ArgsProduct({{1, 0}, {1, 0}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(3);

}  // namespace
