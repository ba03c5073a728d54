#pragma once
/// What touches in the source's shapes should touch in the target's: lids that close, lips that meet. Contacts say whether
/// displacements should follow the warp, and make a blink close.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mien/transfer/delta_models.h"
#include "mien/transfer/register_surfaces.h"

namespace mien {

/// Why displacements are carried as they are.
struct DeltaDecision {
  DeltaModel model = DeltaModel::local;  ///< as asked for
  double warp_share = 0;                 ///< t: 0 is all local, 1 all warp
  double contact_ratio =
      1;                   ///< rho: how far a local Jacobian misses the source's contacts, against raw deltas
  double stretch = 0;      ///< sigma: rms log stretch of the map, about its mean, where the face moves
  int contact_shapes = 0;  ///< shapes of the source that close a gap
  std::string reason;      ///< one sentence
};

/// Two vertices of the source that a shape brings together across open air.
struct ContactPair {
  int a = 0, b = 0;   ///< rows of the source's skin
  double closed = 0;  ///< fraction of the neutral gap, along it, that the shape closes
};

/// Contacts of all shapes and what follows from them. Lengths are relative to the face's size.
class ContactModel {
 public:
  ContactModel(const Surface& source, const Registration& registration, const DeltaMaps& maps);
  ~ContactModel();

  /// Finds each shape's contact pairs: vertices that move at least a quarter of the shape's largest displacement, whose
  /// neutral gap is above 0.017 and shrinks below 0.4 of itself, with air in the middle of the gap.
  ///   names   #S; delta(s) gives shape s's displacements at the skin's vertices, #V x 3, source model space
  ///   cost    about 2 ms a shape at 14,000 vertices
  void look_at_shapes(const std::vector<std::string>& names,
                      const std::function<PointsD(std::size_t)>& delta);

  const std::vector<ContactPair>& pairs(std::size_t shape) const;

  /// The switch between local and warp: t = clamp((0.62 - rho) / 0.15) clamp((sigma - 0.03) / 0.015), 0 with fewer than
  /// 5 shapes that touch. Where a smooth Jacobian keeps contacts that raw displacements lose, the target's proportions
  /// are a warp of the source's and motion should be warped too. Needs look_at_shapes first unless a model is asked for
  /// by name.
  DeltaDecision decide(DeltaModel wanted) const;

  /// Whether the shape closes a lid: it has contacts and its name speaks of a blink, a lid or closing an eye.
  bool closes_lid(std::size_t shape) const;

  /// How much of a lid's motion has to follow the warp instead of `moved` (#V x 3, displacements on the guide): 0 while it
  /// closes at least 0.8 of what it closes on the source, 1 at 0.6. Eyes much larger than the source's need it: a lid
  /// cannot cross them in the source's direction. 0 on other shapes.
  double lid_warp_share(std::size_t shape, const PointsD& moved) const;

  /// Scales `moved` (#V x 3, displacements on the guide) by a smooth factor in [0.5, 2] so that the lid's gaps close at
  /// least as far as on the source and lids do not run through each other; directions stay. The factor is 1 + h, h
  /// minimising int h^2 + l^2 |grad h|^2 + 100 mean (closed' - closed)^2 with l = 0.12, around the lid alone. Does
  /// nothing on other shapes. Cost: one sparse factorisation of that surface.
  void close_lids(std::size_t shape, PointsD& moved) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mien
