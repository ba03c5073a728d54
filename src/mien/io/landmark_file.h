#pragma once
/// The landmark file: {"landmarks": {NAME: POINT}, "curves": {NAME: {"points": [POINT, ...], "count": N}}}.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

struct LandmarkSet {
  std::vector<Landmark> landmarks;    ///< by name, ascending
  std::vector<LandmarkCurve> curves;  ///< by name, ascending
  /// Where landmarks were found by themselves: how sure each is, in [0, 1]; the file's "confidence" member. Written
  /// where it is not empty, not read back.
  std::map<std::string, double> confidence;
};

/// POINT is {"vertex": 17}, {"part": "Skin", "vertex": 17}, {"face": 3, "barycentric": [a, b, c]} or
/// {"position": [x, y, z]} in model space (goes to the closest surface point of `character`).
///   throws  Error: not JSON, an unknown member, a part, vertex or face that `character` does not have,
///   weights that
///           are negative or do not sum to one, numbers that are not finite, a curve of fewer than two points
LandmarkSet read_landmarks(const std::filesystem::path& path, const Character& character);

void write_landmarks(const LandmarkSet& set, const Character& character, const std::filesystem::path& path);

}  // namespace mien
