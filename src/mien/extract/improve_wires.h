#pragma once
/// What a designer would otherwise try out: where each wire lies and how far it reaches, which vertices count, where another
/// wire would help.

#include <span>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/progress.h"
#include "mien/extract/draw_wires.h"
#include "mien/extract/extract_wires.h"

namespace mien {

/// One #V a part: 1 where the surface can be seen from outside or lies close to a wire, 0.02 in the cavities behind lips,
/// lids and nostrils, whose vertices would otherwise pull the wires of the face towards what nobody sees.
///   cost  32 rays a vertex (geometry/openness.h), 0.3 s on a face of 14,000 vertices (one core)
std::vector<Eigen::VectorXf> outer_vertex_weights(const Character& character, std::span<const Wire> wires);

struct ImproveOptions {
  WireSolverOptions solver;
  int sweeps = 2;        ///< over all wires, by ever smaller steps; ranges as often as that gains something
  bool varying = false;  ///< then let ranges vary along the curve: four values a wire
  bool alike =
      true;  ///< expressions count by the cube root of their size, nearly alike; false: by their size
  std::vector<std::string> fixed;  ///< wires whose ranges, or places, stay
  Progress progress;
};

struct ImproveResult {
  std::vector<Wire> wires;
  double before = 0,
         after = 0;  ///< what the wires leave of the displacements, of 1, on the sample that was used
};

/// The same wires with the ranges that rebuild the character's shapes best. Twins (`brow_L`, `brow_R`; `Left`, `Right`) keep
/// equal ranges.
///   throws  as WireSolver; no shape that moves what the wires reach
///   cost    about 500 fits to a sample of 3,000 vertices and the principal shapes: 5 s for 22 wires and 55 shapes
///   method  coordinate descent: every candidate is bound, solved and measured by what its normal equations leave over
ImproveResult improve_wires(const Character& character, std::span<const Wire> wires,
                            const ImproveOptions& options = {});

/// The same wires with their reference curves where they rebuild the character's shapes best, near where they were drawn: as a whole
/// moved across their direction or along it, tilted, bent, lengthened or shortened by at most a quarter of their range. Points
/// stay on the surface; twins move as mirror images; ranges stay (`improve_wires` comes after). Wires that were not drawn
/// through points stay.
///   throws  as improve_wires
///   cost    about 300 tries like those of improve_wires, each with a curve to draw
ImproveResult move_curves(const Character& character, std::span<const Wire> wires,
                          const ImproveOptions& options = {});

/// A wire where an extraction left most over of what counts: through the vertex with the largest error around it, along the direction in which
/// that error spreads.
///   throws  invalid_input: nothing is left over
WireSketch propose_wire(const Character& character, const ExtractResult& result);

}  // namespace mien
