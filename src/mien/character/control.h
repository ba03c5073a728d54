#pragma once
/// The control interface: what an animator sees and takes hold of, by regions of the face. Data only.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace mien {

/// One control on the panel.
struct Control {
  enum class Kind {
    slider,  ///< one slider
    pad,     ///< a point in a square: `sliders` are right, left, up and down of it, -1 where there is none
    joint,   ///< a node's rotation (and translation, when `moves`)
  };
  std::string name;    ///< unique
  std::string label;   ///< what the panel shows; none: the name
  std::string region;  ///< "mouth", "eye left"
  Kind kind = Kind::slider;
  std::vector<int> sliders;  ///< one for a slider, four for a pad, none for a joint
  int node = -1;             ///< for a joint
  bool moves = false;        ///< a joint may be shifted too
  int mirror = -1;           ///< the control of the other side, -1: none. Both name each other
  Eigen::Vector2d position =
      Eigen::Vector2d::Zero();  ///< upper left corner on the panel, units of a row's height, y down
  Eigen::Vector2d size = Eigen::Vector2d(4, 1);
  bool operator==(const Control&) const = default;
};

}  // namespace mien
