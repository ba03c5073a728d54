#pragma once
/// What an extraction of wires did, as one page to look at.

#include <string>

#include "mien/character/character.h"
#include "mien/core/progress.h"
#include "mien/extract/extract_wires.h"

namespace mien {

struct WireReportInput {
  const Character& original;       ///< as given to `extract_wires`
  const ExtractResult& result;     ///< what it returned
  std::string name = "character";  ///< shown, usually a file name
  double range_seconds = 0;        ///< spent on ranges before
  Progress progress = {};
};

/// How much smaller the wires are than the shapes: numbers kept by dense shapes (three a vertex on the pieces that carry a wire), by
/// sparse ones (three and a vertex number a moved vertex) and by wires (control points, scales and turns).
struct WireCompression {
  double dense = 0, sparse = 0;            ///< numbers of those over numbers of the wires
  double dense_kept = 0, sparse_kept = 0;  ///< the same with the residuals that are kept
};
WireCompression wire_compression(const Character& original, const ExtractResult& result);

/// One page, UTF-8, pictures inside: the numbers; the wires on the face; every shape with what the wires alone make of it and a
/// map of the error; features and shapes with their errors; seconds.
///   throws  invalid_input: a result of another character; cancelled
///   cost    three pictures a shape, 0.4 s on two cores
std::string make_wire_report(const WireReportInput& input);

/// The wires as lines to draw on the neutral, a colour a feature.
std::vector<std::vector<Eigen::Vector3d>> wire_lines(const Character& character);

/// The character's neutral moved as one shape's wires alone move it. Pieces without wires keep the shape's own displacements.
Character rebuilt_neutral(const Character& original, const ExtractResult& result, int shape);

}  // namespace mien
