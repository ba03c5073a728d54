#pragma once
// Faces to drag: ICT-FaceKit's (the environment variable MIEN_ICT names the unpacked folder FaceXModel) or the built-in human;
// many sliders by splitting shapes into local ones; correctives of pairs.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "mien/character/sliders.h"
#include "mien/io/assemble.h"
#include "mien/sample/sample.h"

namespace mien {

inline Character dragged_face() {
  const char* folder = std::getenv("MIEN_ICT");
  if (!folder) return make_sample("human");
  std::vector<std::filesystem::path> shapes;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".obj" && name.rfind("identity", 0) != 0 && name.rfind("generic", 0) != 0)
      shapes.push_back(entry.path());
  }
  std::sort(shapes.begin(), shapes.end());
  return assemble(std::filesystem::path(folder) / "generic_neutral_mesh.obj", shapes);
}

/// Splits shapes into smooth local pieces that sum to them, until there are `count`.
inline Character split_shapes(Character face, int count) {
  std::mt19937 random(5);
  const auto whole = face.shapes;
  for (int s = 0; static_cast<int>(face.shapes.size()) < count; ++s) {
    const std::size_t from = static_cast<std::size_t>(s) % whole.size();
    Shape& rest = face.shapes[from];
    if (rest.parts.empty() || rest.parts[0].vertices.empty()) continue;
    Shape piece = rest;
    piece.name += "_" + std::to_string(face.shapes.size());
    const Points& at = face.parts[rest.parts[0].part].mesh.positions;
    // The centre is a vertex that moves much; the piece falls off over a sixth of the face.
    const PartDelta& delta = rest.parts[0];
    std::size_t centre = random() % delta.vertices.size();
    for (int tries = 0; tries < 20; ++tries) {
      const std::size_t other = random() % delta.vertices.size();
      const auto row = [&](std::size_t i) { return delta.deltas.row(static_cast<Eigen::Index>(i)).norm(); };
      if (row(other) > row(centre)) centre = other;
    }
    const float radius = static_cast<float>(bounding_box(at).diagonal()) / 12;
    for (std::size_t i = 0; i < delta.vertices.size(); ++i) {
      const float far = (at.row(delta.vertices[i]) - at.row(delta.vertices[centre])).norm() / radius;
      const float share = std::exp(-far * far);
      piece.parts[0].deltas.row(static_cast<Eigen::Index>(i)) *= share;
      rest.parts[0].deltas.row(static_cast<Eigen::Index>(i)) *= 1 - share;
    }
    PartDelta local;
    local.part = piece.parts[0].part;
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < delta.vertices.size(); ++i)
      if (piece.parts[0].deltas.row(static_cast<Eigen::Index>(i)).norm() > 1e-5f * radius)
        kept.push_back(static_cast<Eigen::Index>(i));
    for (const Eigen::Index i : kept) local.vertices.push_back(delta.vertices[static_cast<std::size_t>(i)]);
    local.deltas = piece.parts[0].deltas(kept, Eigen::all);
    piece.parts = {local};
    face.shapes.push_back(piece);
  }
  face.sliders.clear();
  complete_sliders(face);
  return face;
}

/// `count` correctives: each a tenth of the difference that two shapes make, of the first one's vertices.
inline Character with_correctives(Character face, int count) {
  std::mt19937 random(6);
  const int sliders = static_cast<int>(face.sliders.size());
  for (int c = 0; c < count; ++c) {
    const int a = static_cast<int>(random() % static_cast<unsigned>(sliders)),
              b = (a + 1 + static_cast<int>(random() % static_cast<unsigned>(sliders - 1))) % sliders;
    Shape shape = face.shapes[static_cast<std::size_t>(face.sliders[a].stops[0].shape)];
    shape.name = "corrective" + std::to_string(c);
    for (PartDelta& delta : shape.parts) delta.deltas *= -0.3f;
    face.shapes.push_back(shape);
    face.correctives.push_back(
        {static_cast<int>(face.shapes.size()) - 1, CorrectiveRule::product, {{a, 1}, {b, 1}}});
  }
  return face;
}

}  // namespace mien
