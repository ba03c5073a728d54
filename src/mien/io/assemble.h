#pragma once
/// Whole-face files of one topology into a character with shapes.

#include <filesystem>
#include <span>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/progress.h"

namespace mien {

struct AssembleOptions {
  /// Displacements below this part of the neutral's box diagonal are noise and left out.
  double threshold = 1e-5;
  Progress progress;
};

/// The neutral with one shape a file, named after the file: the file's vertices minus the neutral's.
///   neutral  a file with one part
///   shapes   files of the same number of vertices in the same order; faces and UVs are the neutral's
///   throws   Error naming the file: another number of vertices, vertices in another order (most of them would move by
///            a quarter of the face), two files of one name
///   cost     linear; files are read on all cores
Character assemble(const std::filesystem::path& neutral, std::span<const std::filesystem::path> shapes,
                   const AssembleOptions& options = {});

}  // namespace mien
