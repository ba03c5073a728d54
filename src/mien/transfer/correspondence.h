#pragma once
/// For every target vertex a place on the source, and attributes carried along it.

#include <Eigen/Core>
#include <Eigen/Sparse>
#include <functional>
#include <memory>
#include <vector>

#include "mien/transfer/register_surfaces.h"

namespace mien {

/// A place on the source's triangles.
struct SourcePoint {
  int triangle = -1;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  double distance = 0;  ///< from the target vertex to the guide, target units
  bool accepted =
      false;  ///< false: the gates found no trustworthy place; attributes are filled in from around it
};

struct CorrespondenceOptions {
  double least_cosine = 0.2;  ///< between the target's and the guide's normal
  double normal_length =
      0.008;            ///< of the face's size: a normal's length beside places, see SurfaceQuery::most_alike
  double reach = 0.06;  ///< of the face's size: the guide further away is not the same place
};

/// Each target vertex's closest point on the guide, in place and normal together, if it faces the same way and belongs to
/// the same kind of surface (outer skin or cavity by openness), else the closest point that does; so a lip never takes its
/// motion from the other lip, nor a lid's rim from its side.
///   returns  #V of the target
///   cost     one gated closest point a vertex
std::vector<SourcePoint> find_correspondence(const Registration& registration, const Surface& source,
                                             const Surface& target,
                                             const CorrespondenceOptions& options = {});

/// Takes back the acceptance of vertices that have been caught by another part of the face that lies close in the neutral
/// (the inside of the other lip): those that some shape or joint would tear away from their neighbours. An edge is torn
/// when its ends' displacements differ by more than four times its length and 2 % of the face, or their skin weights by
/// more than 1.2 in all; a vertex is taken back when 40 % of its edges are torn, three times over.
///   delta(s)  #V source x 3, the displacements of shape s at the target's scale
///   weights   #V source x #J, or empty
///   cost      linear in shapes x edges
struct TearInput {
  std::size_t shapes = 0;
  std::function<PointsD(std::size_t)> delta;
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;
  double unit = 1;
};
void reject_torn(const TearInput& input, const Surface& source, const Surface& target,
                 std::vector<SourcePoint>& points);

/// Carries per-vertex attributes from the source's vertices to the target's: barycentric where the correspondence is
/// accepted, harmonic (cotangent Laplacian of the target) in between. Linear; constants stay constant, so skin weights
/// keep their sum. Components of the target without any accepted vertex take the plain closest point.
class AttributeCarrier {
 public:
  AttributeCarrier(std::vector<SourcePoint> correspondence, const Surface& source, const Surface& target);
  ~AttributeCarrier();
  AttributeCarrier(AttributeCarrier&&) noexcept;

  ///   values   #V source x K
  ///   returns  #V target x K
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& values) const;
  /// The same for sparse values (skin weights): zeros stay away from where nothing brings them.
  Eigen::SparseMatrix<double, Eigen::RowMajor> operator()(
      const Eigen::SparseMatrix<double, Eigen::RowMajor>& values) const;
  /// Target vertices filled in harmonically.
  const std::vector<int>& filled() const;
  const std::vector<SourcePoint>& correspondence() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mien
