#pragma once
/// What the tests of the built-in characters share.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "mien/sample/sample.h"

namespace mien::test {

/// The built-in character, made once.
inline const Character& made(const std::string& name) {
  static std::map<std::string, Character> cache;
  const auto known = cache.find(name);
  return known != cache.end() ? known->second : cache[name] = make_sample(name);
}

/// Neutral positions of a part with shapes added.
inline PointsD shaped(const Character& character, int part, const std::map<std::string, double>& weights) {
  PointsD positions = character.parts[part].mesh.positions.cast<double>();
  for (const auto& [name, weight] : weights) {
    const int shape = find_shape(character, name);
    EXPECT_GE(shape, 0) << name;
    for (const PartDelta& delta : character.shapes[shape].parts)
      if (delta.part == part)
        for (std::size_t i = 0; i < delta.vertices.size(); ++i)
          positions.row(delta.vertices[i]) += weight * delta.deltas.row(i).cast<double>();
  }
  return positions;
}

/// The skin vertex of landmark ibug_NUMBER.
inline int landmark_vertex(const Character& character, int number) {
  for (const Landmark& landmark : character.landmarks)
    if (landmark.name == "ibug_" + std::to_string(number)) return landmark.at.vertex;
  ADD_FAILURE() << "no ibug_" << number;
  return 0;
}

}  // namespace mien::test
