#pragma once
/// Which pieces of the source a piece of the target moves with, and where on them its vertices are.

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "mien/geometry/surface_query.h"
#include "mien/transfer/detail/inner_pieces.h"

namespace mien::detail {

/// Many target pieces ask the same donors: what was built for one is kept for the others.
class DonorFinder {
 public:
  ///   kinds  per source piece
  DonorFinder(const PieceInput& input, std::vector<PieceKind> kinds)
      : in_(input), kinds_(std::move(kinds)), axes_(head_axes(input)) {}

  /// Fills in `places`, `donor_vertices` and `same_kind` of a plan that knows its piece, kind and vertices; false when
  /// nothing of the source lies near. A tongue is laid on a tongue, a lash on a lash, before its places are looked for.
  bool find(PiecePlan& plan);

 private:
  struct Donors {
    PoolSurface pieces;
    std::unique_ptr<SurfaceQuery> query;
  };
  const Donors& of(const std::vector<char>& pieces);
  std::map<int, int> closest_on(const Donors& donors, const PointsD& positions, PiecePlan& plan,
                                double& median_distance) const;
  bool moves(const std::vector<char>& group) const;
  std::vector<char> moving_bodies() const;
  double mean_distance(const std::vector<char>& pieces, const PointsD& positions);
  void keep_bodies(const std::map<int, int>& votes, double count, std::vector<char>& pieces) const;
  std::vector<char> group_of_unnamed(const std::map<int, int>& votes, const PointsD& positions, bool rigid);
  PointsD box_onto_box(const PointsD& points, const PointsD& others) const;
  PointsD lay_on_donors(const SurfaceQuery& donors, const PointsD& positions, const PiecePlan& plan) const;

  const PieceInput& in_;
  const std::vector<PieceKind> kinds_;
  const Eigen::Matrix3d axes_;  // the head's
  std::map<std::vector<char>, Donors> known_;
};

}  // namespace mien::detail
