// Uses rooms from the bottom to the top of the installed library: builds a face, poses it, writes and reads it.
#include <cstdio>
#include <filesystem>

#include "mien/character/character.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/load.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  mien::Character face;
  face.name = "face";
  face.parts.emplace_back();
  mien::Mesh& mesh = face.parts[0].mesh;
  face.parts[0].name = "Skin";
  mesh.positions.resize(3, 3);
  mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  mesh.faces.push_back({0, 1, 2});
  mien::Shape smile{"smile", {{0, {1}, mien::Points::Constant(1, 3, 0.5f), {}, {}}}};
  face.shapes.push_back(smile);

  const std::filesystem::path file = argv[1];
  mien::save(face, file);
  const mien::Character read = mien::load(file);
  mien::Pose pose = mien::rest_pose(read);
  pose.shape_weights.values[0] = 1;
  const float moved = mien::evaluate(read, pose)[0](1, 0);
  std::printf("%s moves vertex 1 to x = %g\n", read.shapes[0].name.c_str(), moved);
  return moved == 1.5f ? 0 : 1;
}
