#pragma once
/// Small characters made in code for the tests of this room.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// A sphere of unit radius: `rings` x `2 rings` quads, triangles at the poles (+-Y). With `seam`, the
/// meridian at angle 0 has two copies of its vertices, as a UV seam in glTF.
inline Part make_sphere(const std::string& name, int rings, bool seam = false) {
  Part part;
  part.name = name;
  const int around = 2 * rings, columns = seam ? around + 1 : around;
  std::vector<Eigen::Vector3f> rows;
  for (int r = 1; r < rings; ++r)
    for (int c = 0; c < columns; ++c) {
      const double polar = std::numbers::pi * r / rings, turn = std::numbers::pi * (c % around) / rings;
      rows.emplace_back(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn));
    }
  const int north = static_cast<int>(rows.size()), south = north + 1;
  rows.emplace_back(0, 1, 0);
  rows.emplace_back(0, -1, 0);
  const auto at = [&](int r, int c) { return (r - 1) * columns + c % columns; };
  for (int c = 0; c < around; ++c) {
    part.mesh.faces.push_back({north, at(1, c), at(1, c + 1)});
    part.mesh.faces.push_back({south, at(rings - 1, c + 1), at(rings - 1, c)});
    for (int r = 1; r + 1 < rings; ++r)
      part.mesh.faces.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c + 1)});
  }
  part.mesh.positions.resize(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t v = 0; v < rows.size(); ++v)
    part.mesh.positions.row(static_cast<Eigen::Index>(v)) = rows[v];
  return part;
}

inline Character character_of(std::vector<Part> parts) {
  Character character;
  character.parts = std::move(parts);
  return character;
}

inline std::vector<Points> positions_of(const Character& character, float scale = 1) {
  std::vector<Points> posed;
  for (const Part& part : character.parts) posed.push_back(part.mesh.positions * scale);
  return posed;
}

}  // namespace mien
