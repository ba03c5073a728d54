#pragma once
/// Real heads with the landmarks that lie beside them.

#include <filesystem>
#include <utility>

#include "mien/io/landmark_file.h"
#include "mien/io/load.h"

namespace mien::test {

inline Character load_marked(const std::filesystem::path& mesh, const std::filesystem::path& landmarks) {
  Character character = load(mesh);
  LandmarkSet set = read_landmarks(landmarks, character);
  character.landmarks = std::move(set.landmarks);
  character.curves = std::move(set.curves);
  return character;
}

}  // namespace mien::test
