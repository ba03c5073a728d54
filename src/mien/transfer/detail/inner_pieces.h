#pragma once
/// What is in or on the head without being its skin: eyes, teeth, tongue, lashes. Each piece of the target is joined to
/// pieces of the source by name or by where they lie, or follows the skin around it; none is dragged onto the skin.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mien/geometry/similarity.h"
#include "mien/transfer/carry_skin_weights.h"
#include "mien/transfer/correspondence.h"
#include "mien/transfer/detail/piece_kinds.h"
#include "mien/transfer/detail/pool.h"

namespace mien::detail {

/// Per vertex of a piece a place on some triangles.
struct PiecePlaces {
  std::vector<int> triangle;
  std::vector<Eigen::Vector3d> barycentric;
};

/// How one target piece gets its motion.
struct PiecePlan {
  enum class Way {
    donors,    ///< from the source's pieces at the same place
    attached,  ///< from the target's own skin beneath it
    jaw,       ///< as a rigid body with the skin around it, where that moves rigidly
    still,     ///< not moved by shapes; bound to the head
  };
  int piece = 0;
  PieceKind kind = PieceKind::other;
  Way way = Way::still;
  std::vector<int> vertices;  ///< pooled target vertices
  PiecePlaces places;         ///< donors: in the source pool; attached and jaw: on the target skin's surface
  /// attached: where the source's own lashes tell which joints move a lash, in the source pool; empty: the skin beneath does
  PiecePlaces weight_donors;
  std::vector<double> fade;  ///< attached: 1 on the skin, falling with distance
  /// attached, of a sheet that hangs on the skin and stands off it: carries from the skin over the sheet; null: each vertex
  /// goes with its own place
  std::shared_ptr<const AttributeCarrier> film;
  bool same_kind = false;  ///< donors: they are what the piece is (a tongue for a tongue), by name or form
  bool from_skin = false;  ///< donors: the source's skin is among them
  bool solid = false;      ///< its surface encloses its inside
  bool rigid = false;      ///< solid and as small as a tooth: moves as a body, whatever its donors do
  std::vector<int> donor_vertices;  ///< donors: pooled source vertices whose motion is looked at as a whole
  double growth = 1;                ///< how lengths grow there, source to target
};

/// How a source piece moves over all shapes and with all joints.
struct PieceMotion {
  Eigen::VectorXd
      signature;    ///< mean displacement a shape (3 #S), then mean skin weight a joint times the face's size
  double bend = 0;  ///< what of its motion is not rigid: root of squares over root of squares of the motion
};

/// A piece that bends less moves as a rigid body.
constexpr double rigid_bend = 0.12;

/// Of the pieces that are not skin; skin counts as bending.
///   deltas(s)  pooled source vertices x 3 of shape s; weights: pooled source vertices x #J, or empty
std::vector<PieceMotion> piece_motions(const Pool& source, const std::vector<char>& skin, std::size_t shapes,
                                       const std::function<PointsD(std::size_t)>& deltas,
                                       const WeightMatrix& weights, double unit);

struct PieceInput {
  const Pool& source;
  const Pool& target;
  const std::vector<char>& source_skin;  ///< per piece
  const std::vector<char>& target_skin;
  const PoolSurface& target_surface;
  const PointsD& warped_source;  ///< pooled source positions brought to the target by the dense spline
  const Similarity& similarity;
  const std::vector<PieceMotion>& source_motion;  ///< per source piece
  double unit = 1;
};

/// The head's principal axes, as columns: boxes along them turn with it.
Eigen::Matrix3d head_axes(const PieceInput& input);

/// One plan a target piece that is not skin, in piece order.
std::vector<PiecePlan> plan_pieces(const PieceInput& input);

/// Points of pieces that are the same thing on both sides, for maps of space to go through: the middles of each piece's
/// box and of its sides (along the head's principal axes), source (after the similarity) to target. They tell where joints go inside the head, where the
/// skin says little.
struct PiecePoints {
  PointsD aligned, target;
};
PiecePoints piece_points(const PieceInput& input, const std::vector<PiecePlan>& plans);

/// The displacement (#vertices of the plan x 3, target model space) of one shape.
///   source_delta  pooled source vertices x 3, source model space
///   skin_delta    rows of the target's skin surface x 3, target model space: what was carried already
PointsD carry_piece(const PieceInput& input, const PiecePlan& plan, const PointsD& source_delta,
                    const PointsD& skin_delta);

/// Skin weights (#vertices of the plan x #J).
///   source_weights  pooled source vertices x #J; skin_weights: rows of the target's skin surface x #J
///   head_joint      the joint that carries most of the skin: what still pieces are bound to
WeightMatrix carry_piece_weights(const PieceInput& input, const PiecePlan& plan,
                                 const WeightMatrix& source_weights, const WeightMatrix& skin_weights,
                                 int head_joint);

/// Other per-vertex attributes (#vertices of the plan x K) the same way, none on still pieces.
WeightMatrix carry_piece_rows(const PieceInput& input, const PiecePlan& plan, const WeightMatrix& source_rows,
                              const WeightMatrix& skin_rows);

std::string_view name_of(PiecePlan::Way way);

}  // namespace mien::detail
