// Uses rooms from the bottom to the top of the installed library: builds a face and poses it.
#include <cstdio>

#include "mien/character/character.h"
#include "mien/evaluate/evaluate.h"

int main() {
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

  mien::Pose pose = mien::rest_pose(face);
  pose.shape_weights.values[0] = 1;
  const float moved = mien::evaluate(face, pose)[0](1, 0);
  std::printf("%s moves vertex 1 to x = %g\n", face.shapes[0].name.c_str(), moved);
  return moved == 1.5f ? 0 : 1;
}
