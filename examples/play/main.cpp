// Plays a clip as a contact sheet: play FACE.glb CLIP OUT.png [FRAMES].

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/evaluate/evaluator.h"
#include "mien/io/load.h"
#include "mien/picture/camera.h"
#include "mien/picture/render.h"
#include "mien/picture/sheet.h"

namespace {

const mien::Clip& find_clip(const mien::Character& face, const std::string& name) {
  for (const mien::Clip& clip : face.clips)
    if (clip.name == name) return clip;
  throw mien::invalid_input("clip " + name, "the face has none of that name", "mien inspect lists its clips");
}

/// One frame of a bake as the picture room takes it: one block of rows a part.
std::vector<mien::Points> parts_of(const mien::Character& face, const float* frame) {
  std::vector<mien::Points> parts;
  for (const mien::Part& part : face.parts) {
    parts.emplace_back(Eigen::Map<const mien::Points>(frame, part.mesh.positions.rows(), 3));
    frame += part.mesh.positions.size();
  }
  return parts;
}

void play(const std::string& file, const std::string& name, const std::string& out, int count) {
  const mien::Character face = mien::load(file);
  const mien::Clip& clip = find_clip(face, name);
  std::vector<mien::Pose> poses;
  std::vector<double> times;
  for (int f = 0; f < count; ++f) {
    times.push_back(clip.duration() * f / std::max(1, count - 1));
    poses.push_back(mien::sample_clip(face, clip, times.back()));
  }

  const mien::Evaluator evaluator(face);  // compiled once, then every frame on every core
  const std::size_t size = 3 * evaluator.vertex_count();
  std::vector<float> frames(poses.size() * size);
  evaluator.bake(poses, frames);

  const mien::Renderer renderer(face);
  mien::RenderOptions options;
  options.width = 160;
  options.height = 200;
  mien::FrameOptions frame;
  frame.aspect = 0.8;
  options.camera = mien::frame_head(face, parts_of(face, frames.data()), frame);
  std::vector<mien::SheetCell> cells;
  for (std::size_t f = 0; f < poses.size(); ++f) {
    char label[32];
    std::snprintf(label, sizeof label, "%.2f s", times[f]);
    cells.push_back({label, renderer.render(parts_of(face, frames.data() + f * size), options), {}});
  }
  mien::SheetOptions sheet;
  sheet.title = name;
  const std::vector<unsigned char> png = mien::encode_png(mien::contact_sheet(cells, sheet));
  std::ofstream stream(out, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  if (!stream.flush()) throw mien::io_error(out, "cannot be written", "a place that exists");
  std::printf("%s: %d frames of %s, %.2f s\n", out.c_str(), count, name.c_str(), clip.duration());
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 4 ? std::atoi(argv[4]) : 12;
  if (argc < 4 || argc > 5 || count < 1 || count > 1000) {
    std::fprintf(stderr, "usage: play FACE.glb CLIP OUT.png [FRAMES, 1 to 1000]\n");
    return 2;
  }
  try {
    play(argv[1], argv[2], argv[3], count);
    return 0;
  } catch (const mien::Error& error) {
    std::fprintf(stderr, "play: %s\n", error.what());
    return 1;
  }
}
