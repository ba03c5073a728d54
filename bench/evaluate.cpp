// Evaluation against its peers and against the machine's limits, all in one run: rows of a table, each the minimum of many
// short batches that take turns, so that a busy machine slows all of them alike. ICT-FaceKit's face when the environment
// variable MIEN_ICT names the unpacked folder FaceXModel (57 shapes, and 5 sums of them), a procedural one otherwise.
// OpenBLAS is taken from the system when it is installed (libopenblas0-serial); Eigen is compiled for this machine.
#include "mien/evaluate/evaluate.h"

#include <benchmark/benchmark.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <random>

#include "evaluate_faces.h"
#include "mien/core/parallel.h"
#include "mien/evaluate/evaluator.h"
#include "mien/io/load.h"
#include "peers/evaluate.h"

namespace {

using mien::Character;
using mien::DeltaPrecision;
using mien::Evaluator;
using mien::EvaluatorOptions;
using mien::Pose;
using mien::bench::DenseFace;

struct Contender {
  std::string name;
  std::function<void()> run;
  double seconds = std::numeric_limits<double>::infinity();
};

/// Seconds that this thread has run: what a busy machine does in between does not count. A call takes 0.2 us.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Minimum over batches that take turns for about `seconds` in all. The first two runs of a batch bring data back into the caches (a
/// victim cache has it after the second); the others are timed together.
void race(std::vector<Contender>& contenders, double seconds) {
  for (Contender& contender : contenders) contender.run();
  const double start = thread_seconds();
  do {
    for (Contender& contender : contenders) {
      contender.run();
      const double second = thread_seconds();
      contender.run();
      const double third = thread_seconds();
      const int count = std::clamp(static_cast<int>(3e-4 / (third - second)), 1, 20);
      for (int run = 0; run < count; ++run) contender.run();
      contender.seconds = std::min(contender.seconds, (thread_seconds() - third) / count);
    }
  } while (thread_seconds() - start < seconds);
}

/// OpenBLAS as the system has it.
struct Blas {
  using Gemv = void (*)(int, int, int, int, float, const float*, int, const float*, int, float, float*, int);
  using Gemm = void (*)(int, int, int, int, int, int, float, const float*, int, const float*, int, float,
                        float*, int);
  Gemv gemv = nullptr;
  Gemm gemm = nullptr;
  std::string core;
  Blas() {
    void* library = dlopen("libopenblas.so.0", RTLD_NOW);
    if (!library) return;
    gemv = reinterpret_cast<Gemv>(dlsym(library, "cblas_sgemv"));
    gemm = reinterpret_cast<Gemm>(dlsym(library, "cblas_sgemm"));
    if (const auto threads = reinterpret_cast<void (*)(int)>(dlsym(library, "openblas_set_num_threads")))
      threads(1);
    if (const auto name = reinterpret_cast<char* (*)()>(dlsym(library, "openblas_get_corename")))
      core = name();
  }
};
const Blas& blas() {
  static const Blas found;
  return found;
}

constexpr int column_major = 102, row_major = 101, as_is = 111;

double seconds_of(const std::vector<Contender>& contenders, const std::string& name) {
  for (const Contender& contender : contenders)
    if (contender.name == name) return contender.seconds;
  return std::numeric_limits<double>::quiet_NaN();
}

void print_row(const std::string& what, double seconds, const std::string& remark) {
  fmt::print("| {:<44} | {:>9.1f} | {} |\n", what, 1e6 * seconds, remark);
}

std::string times(double peer, double own, double wanted) {
  return std::isfinite(peer) ? fmt::format("{:.1f} x (wanted {})", peer / own, wanted) : "peer not installed";
}

void print_title(const std::string& title) {
  fmt::print("\n{}\n\n| | us | |\n|---|---|---|\n", title);
}

/// Everything that one face is measured with; buffers outlive the contenders that write to them.
struct Bench {
  const Character& face;
  DenseFace dense;
  Evaluator exact, compact;
  std::vector<float> rows, blocks, peer;
  explicit Bench(const Character& character)
      : face(character),
        dense(character),
        exact(character),
        compact(character, {DeltaPrecision::compact, mien::InstructionSet::best, {}}),
        rows(3 * exact.vertex_count()),
        blocks(48 * std::max(exact.block_count(), compact.block_count())),
        peer(rows.size()) {}

  Contender own(const std::string& name, Evaluator& evaluator, const Pose& pose) {
    return {name, [&evaluator, &pose, this] {
              evaluator.evaluate_blocks(pose, std::span(blocks).first(48 * evaluator.block_count()));
            }};
  }
  Contender own_rows(const std::string& name, Evaluator& evaluator, const Pose& pose) {
    return {name, [&evaluator, &pose, this] { evaluator.evaluate(pose, rows); }};
  }
  Contender sgemv(const std::vector<float>& weights) {
    return {"OpenBLAS sgemv", [this, &weights] {
              std::memcpy(peer.data(), dense.neutral.data(), 4 * peer.size());
              const int rows_count = static_cast<int>(peer.size()), shapes = static_cast<int>(weights.size());
              blas().gemv(column_major, as_is, rows_count, shapes, 1, dense.deltas.data(), rows_count,
                          weights.data(), 1, 1, peer.data(), 1);
            }};
  }
  Contender eigen(const std::vector<float>& weights) {
    return {"Eigen", [this, &weights] {
              mien::bench::eigen_shapes(dense.neutral.data(), dense.deltas.data(), weights.data(),
                                        static_cast<int>(peer.size()), static_cast<int>(weights.size()),
                                        peer.data());
            }};
  }
  Contender scatter(const std::vector<float>& weights) {
    return {"sparse scatter", [this, &weights] {
              mien::bench::scatter_shapes(dense.neutral.data(), dense.sparse(), weights.data(),
                                          static_cast<int>(peer.size() / 3), peer.data());
            }};
  }
};

Contender reading(const std::string& name, const std::vector<float>& memory) {
  return {name, [&memory] {
            benchmark::DoNotOptimize(
                mien::bench::read_all(memory.data(), 4 * static_cast<std::int64_t>(memory.size())));
          }};
}

std::vector<float> floats(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

/// A pose with every `every`-th shape up.
Pose shape_pose(const Character& face, int every) {
  Pose pose = mien::rest_pose(face);
  for (Eigen::Index s = 0; s < pose.shape_weights.values.size(); s += every)
    pose.shape_weights.values[s] = 0.3 + 0.01 * static_cast<double>(s % 50);
  return pose;
}

void bench_all_sliders(const Character& face) {
  Bench bench(face);
  const Pose pose = shape_pose(face, 1);
  const std::vector<float> weights = floats(pose.shape_weights.values);
  // As many bytes as an evaluation touches, deltas, neutral and output: what the caches can hand over in that time.
  const auto memory_of = [&](const Evaluator& evaluator) {
    return std::vector<float>((evaluator.bytes() + 4 * 48 * evaluator.block_count()) / 512 * 128);
  };
  const std::vector<float> exact_bytes = memory_of(bench.exact), compact_bytes = memory_of(bench.compact);
  std::vector<Contender> contenders{bench.own("f32", bench.exact, pose),
                                    bench.own_rows("f32, rows", bench.exact, pose),
                                    bench.own("int16", bench.compact, pose),
                                    bench.own_rows("int16, rows", bench.compact, pose),
                                    bench.eigen(weights),
                                    bench.scatter(weights),
                                    reading("read f32", exact_bytes),
                                    reading("read int16", compact_bytes)};
  if (blas().gemv) contenders.push_back(bench.sgemv(weights));
  race(contenders, 4);
  const auto us = [&](const char* name) { return seconds_of(contenders, name); };
  print_title(fmt::format("All {} shapes on {} vertices ({:.1f} MB as f32, {:.1f} MB as int16)",
                          weights.size(), bench.exact.vertex_count(),
                          1e-6 * static_cast<double>(bench.exact.bytes()),
                          1e-6 * static_cast<double>(bench.compact.bytes())));
  print_row("OpenBLAS sgemv", us("OpenBLAS sgemv"), blas().core);
  print_row("Eigen", us("Eigen"), "");
  print_row("sparse scatter", us("sparse scatter"), "");
  print_row("f32", us("f32"), times(us("OpenBLAS sgemv"), us("f32"), 5.5));
  print_row("  reading as many bytes", us("read f32"),
            fmt::format("{:.0f} % (wanted 80)", 100 * us("read f32") / us("f32")));
  print_row("f32, in the order of the file", us("f32, rows"),
            times(us("OpenBLAS sgemv"), us("f32, rows"), 5.5));
  print_row("int16", us("int16"), times(us("OpenBLAS sgemv"), us("int16"), 10));
  print_row("  reading as many bytes", us("read int16"),
            fmt::format("{:.0f} % (wanted 80)", 100 * us("read int16") / us("int16")));
  print_row("int16, in the order of the file", us("int16, rows"),
            times(us("OpenBLAS sgemv"), us("int16, rows"), 10));
  double box = 0;
  for (const mien::Part& part : face.parts)
    box = std::max(box, mien::bounding_box(part.mesh.positions).diagonal());
  fmt::print("\nint16: no coordinate is off by more than {:.1e} of the box in this pose.\n",
             bench.compact.compact_error(pose.shape_weights) / box);
}

void bench_active(const Character& face) {
  Bench bench(face);
  const Pose pose = shape_pose(face, 8);
  const std::vector<float> weights = floats(pose.shape_weights.values);
  Pose moved = pose;
  Evaluator keeping = bench.compact;
  std::vector<float> kept(48 * keeping.block_count());
  std::vector<Contender> contenders{bench.own("f32", bench.exact, pose),
                                    bench.own("int16", bench.compact, pose),
                                    bench.own_rows("int16, rows", bench.compact, pose),
                                    bench.scatter(weights),
                                    {"one slider", [&] {
                                       moved.shape_weights.values[8] += 0.001;
                                       keeping.update_blocks(moved, kept);
                                     }}};
  if (blas().gemv) contenders.push_back(bench.sgemv(weights));
  race(contenders, 3);
  const auto us = [&](const char* name) { return seconds_of(contenders, name); };
  print_title(fmt::format("8 active of {}", weights.size()));
  print_row("OpenBLAS sgemv", us("OpenBLAS sgemv"), "");
  print_row("sparse scatter", us("sparse scatter"), "");
  for (const char* name : {"f32", "int16", "int16, rows"})
    print_row(name, us(name),
              times(us("OpenBLAS sgemv"), us(name), 25) + ", scatter " +
                  times(us("sparse scatter"), us(name), 3.3));
  print_row("one of them changes: update", us("one slider"), "");
}

void bench_many(const Character& face) {
  Bench bench(face);
  const Pose pose = shape_pose(face, 1);
  const std::vector<float> weights = floats(pose.shape_weights.values);
  std::vector<Contender> contenders{bench.own("f32", bench.exact, pose),
                                    bench.own("int16", bench.compact, pose), bench.scatter(weights)};
  if (blas().gemv) contenders.push_back(bench.sgemv(weights));
  race(contenders, 3);
  const auto us = [&](const char* name) { return seconds_of(contenders, name); };
  print_title(fmt::format("{} shapes, all active ({:.1f} MB as int16)", weights.size(),
                          1e-6 * static_cast<double>(bench.compact.bytes())));
  print_row("OpenBLAS sgemv", us("OpenBLAS sgemv"), "");
  print_row("sparse scatter", us("sparse scatter"), "");
  for (const char* name : {"f32", "int16"})
    print_row(name, us(name), times(us("OpenBLAS sgemv"), us(name), 12));
}

void bench_bake(const Character& face) {
  Bench bench(face);
  const int count = 250, shapes = static_cast<int>(face.shapes.size());
  std::vector<Pose> poses;
  std::vector<float> weights;  // shapes x frames
  for (int f = 0; f < count; ++f) {
    poses.push_back(shape_pose(face, 1));
    for (Eigen::Index s = 0; s < shapes; ++s)
      poses.back().shape_weights.values[s] *= std::cos(0.02 * f + static_cast<double>(s));
    for (const double w : poses.back().shape_weights.values) weights.push_back(static_cast<float>(w));
  }
  const std::size_t size = bench.rows.size();
  std::vector<float> frames(count * size), peer(count * size);
  const std::size_t block_frames = count * bench.blocks.size();
  std::vector<float> memory(block_frames + 16);
  void* line = memory.data();
  std::size_t space = 4 * memory.size();
  float* const blocks = static_cast<float*>(std::align(64, 4 * block_frames, line, space));
  const auto as_blocks = [&](const Evaluator& evaluator) {
    evaluator.bake_blocks(poses, {blocks, count * 48 * evaluator.block_count()});
  };
  std::vector<Contender> contenders{{"f32", [&] { as_blocks(bench.exact); }},
                                    {"int16", [&] { as_blocks(bench.compact); }},
                                    {"f32, rows", [&] { bench.exact.bake(poses, frames); }},
                                    {"int16, rows", [&] { bench.compact.bake(poses, frames); }}};
  if (blas().gemm)
    contenders.push_back({"OpenBLAS sgemm", [&] {
                            for (int f = 0; f < count; ++f)
                              std::memcpy(peer.data() + static_cast<std::size_t>(f) * size,
                                          bench.dense.neutral.data(), 4 * size);
                            const int rows = static_cast<int>(size);
                            blas().gemm(column_major, as_is, as_is, rows, count, shapes, 1,
                                        bench.dense.deltas.data(), rows, weights.data(), shapes, 1,
                                        peer.data(), rows);
                          }});
  race(contenders, 6);
  const auto us = [&](const char* name) { return seconds_of(contenders, name) / count; };
  print_title(fmt::format("Bake of {} frames, a frame, one thread", count));
  print_row("OpenBLAS sgemm", us("OpenBLAS sgemm"), "");
  for (const char* name : {"f32", "int16", "f32, rows", "int16, rows"})
    print_row(name, us(name), times(us("OpenBLAS sgemm"), us(name), 5.5));
}

void bench_skin(const Character& face, int influences) {
  Character skinned = mien::bench::with_skin(face, 60, influences);
  skinned.shapes.clear();
  skinned.sliders.clear();
  const Pose pose = mien::bench::joint_pose(skinned);
  Evaluator linear(skinned);
  for (mien::Skin& skin : skinned.skins) skin.method = mien::SkinningMethod::dual_quaternion;
  Evaluator dual(skinned);
  const mien::bench::PeerSkin peer(skinned, pose, influences);
  const int vertices = static_cast<int>(linear.vertex_count());
  std::vector<float> out(3 * linear.vertex_count()), blocks(48 * linear.block_count()),
      dual_blocks(48 * dual.block_count());
  const std::int64_t fmas =
      static_cast<std::int64_t>(vertices) * (12 * influences + 9) / mien::bench::lanes();
  std::vector<Contender> contenders{
      {"linear", [&] { linear.evaluate_blocks(pose, blocks); }},
      {"dual", [&] { dual.evaluate_blocks(pose, dual_blocks); }},
      {"linear rows", [&] { linear.evaluate(pose, out); }},
      {"Eigen",
       [&] {
         mien::bench::eigen_linear_skin(peer.points.data(), peer.influences(), peer.matrices.data(), vertices,
                                        out.data());
       }},
      {"Eigen dual",
       [&] {
         mien::bench::eigen_dual_quaternion_skin(peer.points.data(), peer.influences(),
                                                 peer.quaternions.data(), vertices, out.data());
       }},
      {"FMA", [&] { benchmark::DoNotOptimize(mien::bench::multiply_adds(fmas)); }}};
  race(contenders, 3);
  const auto us = [&](const char* name) { return seconds_of(contenders, name); };
  print_title(
      fmt::format("Skinning alone, 60 joints, {} influences a vertex, {} vertices", influences, vertices));
  print_row("Eigen, linear blend", us("Eigen"), "");
  print_row("linear blend", us("linear"),
            times(us("Eigen"), us("linear"), 2.5) +
                fmt::format(", {:.1f} of the FMA limit (wanted at most 2)", us("linear") / us("FMA")));
  print_row("linear blend, in the order of the file", us("linear rows"),
            times(us("Eigen"), us("linear rows"), 2.5));
  print_row("  as many fused multiply-adds", us("FMA"), "");
  print_row("Eigen, dual quaternions", us("Eigen dual"), "");
  print_row("dual quaternions", us("dual"), times(us("Eigen dual"), us("dual"), 7));
}

void bench_whole(const Character& face) {
  const Character skinned = mien::bench::with_skin(face, 60, 4);
  Pose pose = mien::bench::joint_pose(skinned);
  pose.shape_weights = shape_pose(skinned, 1).shape_weights;
  Bench bench(skinned);
  std::vector<Contender> contenders{bench.own("f32", bench.exact, pose),
                                    bench.own_rows("f32, rows", bench.exact, pose),
                                    bench.own("int16", bench.compact, pose)};
  race(contenders, 2);
  print_title("Shapes and linear skinning of 4 influences, one frame");
  for (const Contender& contender : contenders)
    print_row(contender.name, contender.seconds, "Blender: bench/blender/evaluate.py");
}

void bench_growth(const Character& face, const Character& many) {
  print_title("Growth, all shapes active, int16");
  const auto row = [](const Character& character, const std::string& what) {
    Evaluator evaluator(character, {DeltaPrecision::compact, mien::InstructionSet::best, {}});
    const Pose pose = shape_pose(character, 1);
    std::vector<float> blocks(48 * evaluator.block_count());
    std::vector<Contender> contenders{{"", [&] { evaluator.evaluate_blocks(pose, blocks); }}};
    race(contenders, 1);
    print_row(what, contenders[0].seconds,
              fmt::format("{:.2f} ns a vertex",
                          1e9 * contenders[0].seconds / static_cast<double>(evaluator.vertex_count())));
  };
  for (const int times : {1, 4, 16})
    row(mien::bench::refined(face, times), fmt::format("x{} vertices, {} shapes", times, face.shapes.size()));
  for (const std::size_t shapes : {std::size_t{300}, many.shapes.size()}) {
    Character some = many;
    some.shapes.resize(std::min(shapes, some.shapes.size()));
    some.sliders.clear();
    row(some, fmt::format("x1 vertices, {} shapes", some.shapes.size()));
  }
}

std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "this machine";
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  const auto wanted = [&](const char* row) { return only.empty() || only == row; };
  mien::set_thread_count(1);
  const Character face = mien::bench::face_of_shapes(62);
  const Character many =
      wanted("many") || wanted("growth") ? mien::bench::with_correctives(face, 946) : Character{};
  fmt::print("{}, {}, one thread; minimum of many short batches.\n", machine(),
             mien::name_of(Evaluator(face).instructions()));
  if (only == "write" && argc > 2)  // for bench/blender/evaluate.py
    mien::save(mien::bench::with_skin(face, 60, 4), argv[2]);
  if (wanted("all")) bench_all_sliders(face);
  if (wanted("active")) bench_active(face);
  if (wanted("many")) bench_many(many);
  if (wanted("bake")) bench_bake(face);
  if (wanted("skin")) bench_skin(face, 4);
  if (wanted("skin")) bench_skin(face, 8);
  if (wanted("whole")) bench_whole(face);
  if (wanted("growth")) bench_growth(face, many);
  return 0;
}
