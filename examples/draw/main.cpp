// Poses a built-in face by the names of its shapes and draws it: draw OUT.png [SHAPE=WEIGHT]...

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/picture/render.h"
#include "mien/sample/sample.h"

namespace {

void set_shape(const mien::Character& face, const std::string& argument, mien::Pose& pose) {
  const std::string name = argument.substr(0, argument.find('='));
  const int shape = mien::find_shape(face, name);
  if (shape < 0)
    throw mien::invalid_input("shape " + name, "the face has none of that name", "one like jawOpen");
  const bool has_weight = name.size() < argument.size();
  pose.shape_weights.values[shape] = has_weight ? std::atof(argument.c_str() + name.size() + 1) : 1.0;
}

void draw(const std::string& file, char** shapes, int count) {
  const mien::Character face = mien::make_sample("human");
  mien::Pose pose = mien::rest_pose(face);
  for (int i = 0; i < count; ++i) set_shape(face, shapes[i], pose);

  mien::RenderOptions options;
  options.view = mien::View::three_quarter;
  const mien::Picture picture = mien::render(face, mien::evaluate(face, pose), options);

  const std::vector<unsigned char> png = mien::encode_png(picture);
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  if (!out.flush()) throw mien::io_error(file, "cannot be written", "a place that exists");
  std::printf("%s: %d x %d pixels\n", file.c_str(), picture.width, picture.height);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: draw OUT.png [SHAPE=WEIGHT]...\n");
    return 2;
  }
  try {
    draw(argv[1], argv + 2, argc - 2);
    return 0;
  } catch (const mien::Error& error) {
    std::fprintf(stderr, "draw: %s\n", error.what());
    return 1;
  }
}
