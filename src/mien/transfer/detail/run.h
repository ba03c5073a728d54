#pragma once
/// One transfer on its way: each step reads what the steps before left and adds its own. Where the source lies on the target
/// is found in run_guide.cpp, shapes are carried in transfer.cpp, what hangs on the skin in run_rig.cpp.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mien/geometry/laplacian.h"
#include "mien/geometry/thin_plate_spline.h"
#include "mien/transfer/carry_skeleton.h"
#include "mien/transfer/correspondence.h"
#include "mien/transfer/detail/inner_pieces.h"
#include "mien/transfer/detail/pool.h"
#include "mien/transfer/register_surfaces.h"
#include "mien/transfer/rig_map.h"
#include "mien/transfer/shared_uvs.h"
#include "mien/transfer/transfer.h"
#include "mien/transfer/twin.h"

namespace mien::detail {

class Run {
 public:
  Run(const Character& source, const Character& target, const TransferOptions& options)
      : source_(source), target_(target), options_(options) {}
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  TransferResult operator()();

 private:
  template <class Work>
  void step(const char* name, const Work& work);
  void warn(std::string what, std::string remedy) {
    report_.warnings.push_back({std::move(what), std::move(remedy)});
  }
  bool thesis() const { return options_.method == TransferMethod::thesis; }

  void check_request() const;
  void read_surfaces();
  void find_guide();
  bool register_twin(const PointsD& from, const PointsD& to);
  void keep_twin();
  bool register_by_uvs(const PointsD& from, const PointsD& to);
  std::vector<SourcePoint> find_points() const;
  std::vector<SourcePoint> points_by_uvs() const;
  std::vector<SourcePoint> points_on_guide() const;
  void warp_source();
  void place_pieces_by_uvs();
  void find_places();
  void place_joints();
  void find_scale();
  void carry_shapes();
  void carry_weights();
  void carry_texture_coordinates();
  void carry_rig();
  void carry_clips();

  Eigen::VectorXd trust_in(const std::vector<std::string>& landmarks) const;
  double exaggeration_of(const std::string& shape) const;
  PointsD pooled_delta(const Shape& shape) const;
  PieceInput piece_input() const;
  void report_maps();
  void count_flips(std::size_t shape, const PointsD& source_rows, const PointsD& target_rows);
  bool carries_nodes() const;
  bool has_control_points() const { return !source_.objects.empty() || !source_.wires.empty(); }
  std::vector<int> carried_sliders() const;
  Eigen::VectorXd guide_trust() const;
  SpaceMap space_map() const;
  RigMap rig_map() const;
  PointsD move(const PointsD& at, const PointsD& moves) const;
  WeightMatrix carry_rows(const WeightMatrix& rows) const;
  std::optional<SurfacePoint> carry_point(const SurfacePoint& point) const;
  void warn_of_dropped(const std::vector<std::string>& dropped, const std::string& what,
                       const std::string& remedy);

  const Character& source_;
  const Character& target_;
  const TransferOptions& options_;
  Character result_;
  TransferReport report_;

  Pool source_pool_, target_pool_;
  std::vector<char> source_skin_, target_skin_;  // per piece
  PoolSurface source_surface_, target_surface_;  // the skins
  std::optional<Twin> twin_;                     // of the pools: the target is the source with another mesh
  Twin twin_skin_;                               // the same of the skins
  std::vector<char> kept_;        // per vertex of the source's skin: the target has it where it was
  std::optional<SharedUvs> uvs_;  // of the skins, where they share a layout
  Registration registration_;
  DeltaMaps maps_;
  DeltaModel model_ = DeltaModel::automatic;
  std::unique_ptr<ThinPlateSpline> dense_, landmark_spline_;
  std::unique_ptr<AttributeCarrier> carrier_;
  std::optional<SparseMatrix> evening_;  // of displacements, where closest points say which place is which
  std::unique_ptr<SurfaceQuery> aligned_query_,
      target_query_;             // skins, for control points: aligned source, target
  PointsD warped_source_;        // pooled source vertices on the target
  WeightMatrix source_weights_;  // pooled source vertices x joints; empty without a skin
  std::vector<PieceMotion> piece_motions_;
  std::vector<PiecePlan> plans_;
  SpaceMap space_;
  CarriedSkeleton skeleton_;
};

}  // namespace mien::detail
