#pragma once
/// The wires behind expressions: which control points, scales and turns rebuild each shape of a character.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/progress.h"

namespace mien {

struct WireSolverOptions {
  /// Pulls all unknowns towards rest, in units of the mean diagonal entry of their normal equations. 1e-4 costs a hundredth
  /// of the accuracy and keeps control points that the shapes say little about near their wire.
  double ridge = 1e-4;
  /// One #V a part, 0 or more: how much each vertex counts. None, or a part's without entries: all count 1.
  std::vector<Eigen::VectorXf> vertex_weights;
};

/// Fits wires to any number of shapes; the system is made and factored once.
class WireSolver {
 public:
  ///   wires   with bindings (`draw_wires`, `bind_wires`)
  ///   throws  invalid_input: no wires; a wire without bindings; a ridge that is not positive and finite; vertex weights of another
  ///           number or negative
  ///   cost    20 ms for 22 wires of 10 control points that turn and reach 13,000 vertices (one core)
  ///   method  Pyun, Shin and Shin 2001, section 4, with sigma = s - 1 and the control points' displacements as unknowns:
  ///           then no constant remains (the printed c_i has the wrong sign). Cholesky of the regularised normal equations,
  ///           the scales eliminated (Schur)
  WireSolver(const Character& character, std::span<const Wire> wires, const WireSolverOptions& options = {});
  ~WireSolver();
  WireSolver(WireSolver&&) noexcept;
  WireSolver& operator=(WireSolver&&) noexcept;

  /// The moves of all wires that rebuild the shape best, ascending by wire; none for a shape that moves no vertex in reach.
  ///   cost  0.4 ms for the system above
  std::vector<WireMove> solve(const Shape& shape) const;
  /// The same for many: the factors are read once for all.
  std::vector<std::vector<WireMove>> solve(std::span<const Shape> shapes) const;

  /// What moves do: one entry a part that wires reach, one row a vertex in reach; part space.
  std::vector<PartDelta> apply(std::span<const WireMove> moves) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct ExtractOptions {
  WireSolverOptions solver;
  bool exact =
      false;  ///< keep the shapes as they are beside their wires; false: replace them by what is kept of them
  /// What the wires leave over is kept where it exceeds this part of the face's box: nothing of it there, all of it from twice that on, so
  /// that the surface stays smooth. The rest is then nowhere off by more.
  double residual = 0.002;
  /// And at most on this share of the vertices of the pieces that carry a wire, a shape on average: where it counts most, over all
  /// shapes, error times the root of the vertex weight. 1: wherever it exceeds `residual`.
  double residual_vertices = 1;
  Progress progress;
};

/// How well wires rebuild one shape. Lengths are in model units; the pieces of surface that carry a wire alone are measured.
struct WireFit {
  std::string shape;
  std::vector<WireMove> moves;
  std::vector<PartDelta> rebuilt;   ///< by the wires alone, on the pieces that carry a wire
  std::vector<PartDelta> residual;  ///< what is kept of the shape less that, vertices ascending
  double displacement = 0;          ///< root of the sum of squares of the shape's displacements
  double error = 0;                 ///< the same of shape less rebuilt
  double kept_error = 0;            ///< the same of shape less rebuilt less residual
  double largest = 0;               ///< the largest of shape less rebuilt
  int part = -1, vertex = -1;       ///< where that is
  /// The first, second and fourth over the vertices of half a vertex weight or more: what can be seen.
  double seen_displacement = 0, seen_error = 0, seen_largest = 0;
};

struct FeatureError {
  std::string feature;                 ///< vertices go by the wire that moves them most; empty: out of reach
  double displacement = 0, error = 0;  ///< of what can be seen, over all shapes
};

struct ExtractResult {
  Character character;          ///< with the wires, and their moves in each shape
  std::vector<WireFit> shapes;  ///< by Character::shapes
  std::vector<FeatureError> features;
  double displacement = 0, error = 0, kept_error = 0, largest = 0;  ///< over all shapes
  double seen_displacement = 0, seen_error = 0, seen_largest = 0;   ///< as in WireFit, over all shapes
  double box = 0;                               ///< diagonal of the box around what wires reach
  std::size_t skin_vertices = 0;                ///< on the pieces that carry a wire
  std::vector<Eigen::VectorXf> vertex_weights;  ///< as they counted; empty: all 1
  std::vector<std::vector<char>> skin;          ///< per part, #V: whether the vertex is on such a piece
  bool is_skin(int part, int vertex) const { return skin[part][vertex]; }
  double setup_seconds = 0, solve_seconds = 0;
};

/// Every shape of the character by wires. Pieces that carry no wire (eyeballs, teeth, tongue) keep their displacements.
///   throws  as WireSolver; two wires of one name; a residual that is negative or not finite
///   cost    the solver's, and about 1 ms a shape
ExtractResult extract_wires(const Character& character, std::span<const Wire> wires,
                            const ExtractOptions& options = {});

}  // namespace mien
