#pragma once
/// From what a control interface is made: what names mean, which region holds what, limits, mirrors, pads, the panel. Data only.
///
/// Patterns are names with wildcards: * stands for any run of characters, ? for one; case does not matter. A pattern holds for a
/// slider or a joint when it fits its own name, the name that a NameRule gives it, or the ARKit shape that it does.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mien/character/constraint.h"

namespace mien {

/// A name of the production's own: `M_*_L` is `*Left`, each wildcard as it was.
struct NameRule {
  std::string match, is;
  bool operator==(const NameRule&) const = default;
};

/// A region of the face. The first region with a pattern that fits takes a slider or joint.
struct ControlRegion {
  enum class Side { any, left, right };  ///< the character's
  std::string name;
  std::vector<std::string> match;
  Side side = Side::any;  ///< left, right: only what is of that side
  bool operator==(const ControlRegion&) const = default;
};

/// Ranges for what fits: a slider's minimum and maximum, or a limit on a joint counted from its rest.
struct ControlLimits {
  std::string match;
  std::optional<ValueRange> slider;
  std::array<ValueRange, 3> rotation, translation;  ///< radians; the character's unit
  bool operator==(const ControlLimits&) const = default;
};

/// Four sliders in one square. It is made when two or more of them are there; then they have no control besides it.
struct ControlPad {
  std::string name, label, region;
  std::array<std::string, 4> match;  ///< patterns for right, left, up, down on the panel; "": none
  bool operator==(const ControlPad&) const = default;
};

/// Where things lie: columns of regions from left to right, in rows.
struct ControlLayout {
  std::vector<std::vector<std::string>>
      columns;        ///< region names; regions that no column names come after them
  double width = 10;  ///< of a column
  double rows = 44;   ///< a longer column goes on in another beside it
  bool operator==(const ControlLayout&) const = default;
};

struct ControlConfig {
  std::vector<NameRule> names;
  std::vector<ControlRegion> regions;
  std::vector<ControlLimits> limits;  ///< the first that fits holds
  /// Pairs of patterns, `*_L` and `*_R`: names that fit both with the same wildcards are each other's mirror. Sides of usual names
  /// (Left, _L, .l) need none.
  std::vector<std::pair<std::string, std::string>> mirrors;
  std::vector<ControlPad> pads;
  std::vector<std::string> moves;  ///< joints that may be shifted, not only turned
  ControlLayout layout;
  std::string other = "other";  ///< the region of what fits nowhere
  bool operator==(const ControlConfig&) const = default;
};

}  // namespace mien
