#pragma once
/// Motion attenuation: sliders move, and what is tagged stays as still as the shapes allow (Lewis, Mooser, Deng and
/// Neumann 2005).

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/pose.h"

namespace mien {

/// How alpha is chosen where it is not given by hand.
enum class AlphaRule {
  coordinates,  ///< unselected over selected coordinates: the paper's
  motion,       ///< tr P / tr Q, the shapes' motion instead of counts: the same on a finer mesh
};

struct AttenuateOptions {
  std::optional<double> alpha;  ///< >= 0; 0 attenuates nothing
  AlphaRule rule = AlphaRule::coordinates;
  bool within_limits =
      true;  ///< results stay within the sliders' ranges (or at their values at tagging, if outside)
};

/// w2 = w_t + (P + alpha Q)^-1 P (w1 - w_t): the tagged coordinates are drawn to where they were at tagging, w_t, the others
/// to where the sliders w1 put them. Q = S'S over the tagged coordinates' rows, P = G - Q over all others, G = D'D once.
///
/// With G = L L' kept, a tag costs its own rows alone: with Z = G^-1 S' and K = S Z the map is
/// T = I - alpha Z (I + (alpha - 1) K)^-1 S, so that adding or removing one never touches G again. Sliders that move nothing,
/// or together nothing, leave G singular; each gets 1e-10 of its own diagonal, which keeps it where the user put it.
///
/// Slopes are those of the rig at tagging: exact for plain sliders, to first order for in-betweens and correctives.
/// The character must live as long as the attenuator. One thread at a time.
class Attenuator {
 public:
  ///   tagging  the pose that tagged coordinates keep
  ///   throws   invalid_input: no sliders, sizes of the pose that differ from the character's
  ///   cost     D'D: linear in vertices x (shapes that move each)^2, then #sliders^3 / 6
  Attenuator(const Character& character, const RigPose& tagging, const AttenuateOptions& options = {});
  ~Attenuator();
  Attenuator(Attenuator&&) noexcept;
  Attenuator& operator=(Attenuator&&) noexcept;

  ///   returns  the tag's number, for `remove_tag`
  ///   throws   invalid_input: a point off the surface
  ///   cost     #sliders^2 a coordinate, and the map anew: #sliders^2 x tagged coordinates
  int add_tag(const Tag& tag);
  /// Others keep their numbers.
  ///   throws  invalid_input: no such tag
  void remove_tag(int number);
  ///   throws  invalid_input: negative or not finite
  void set_alpha(std::optional<double> alpha);
  /// alpha as it counts now; 0 without tags.
  double alpha() const;
  /// T, #sliders x #sliders.
  const Eigen::MatrixXd& map() const;
  /// w2 for what the sliders say now. Exactly the pose at tagging if `sliders` is.
  ///   throws  invalid_input: a number of values other than the sliders', one that is not finite
  ///   cost    #sliders^2; more where limits hold sliders
  SliderValues attenuate(const SliderValues& sliders);
  /// `sliders` w1 with one slider moved by `change`: adds T's column to `attenuated`. Limits are not looked at.
  void move_slider(int slider, double change, SliderValues& attenuated) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct AttenuateResult {
  SliderValues sliders;
  double alpha = 0;
  double drift = 0,
         unattenuated_drift = 0;  ///< root mean square over the tagged coordinates, the character's unit
};

/// The same for one use.
AttenuateResult attenuate(const Character& character, const std::vector<Tag>& tags, const RigPose& tagging,
                          const SliderValues& sliders, const AttenuateOptions& options = {});

/// Tags as pins that hold the points where they are: for dragging while attenuation is on.
std::vector<Pin> held_by_tags(const std::vector<Tag>& tags, double weight = 1);

}  // namespace mien
