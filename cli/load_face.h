#pragma once
/// Faces as the transfer commands need them: with landmarks, those given or those found.

#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/transfer/find_landmarks.h"
#include "mien/transfer/transfer.h"

namespace mien::cli {

/// A character with the landmarks of its landmark file in place of its own, when one is given.
///   throws  Error naming the file
Character load_face(const std::string& path, const std::string& landmarks);

/// A side of a transfer and the file it came from.
struct Side {
  std::string file;
  Character& face;
};

/// One side whose landmarks were found, for the report.
struct FoundSide {
  std::string file;
  FoundLandmarks found;
};

/// Sees to it that both sides have landmarks of the same names: a side that has few or none gets the other's, and where
/// neither has enough, the source gets the built-in human's first. What was given stays; `transfer`
/// is told what was found.
///   throws  Error naming the file: no face is found
std::vector<FoundSide> find_missing(const Side& source, const Side& target, TransferOptions& options);

}  // namespace mien::cli
