#pragma once
/// Which of a character's sliders do what a name says.

#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien {

/// One stream driving one slider.
struct SliderLink {
  std::string from;  ///< a stream of the take
  std::string to;    ///< a slider of the character
  double gain = 1;   ///< slider value = sum over the links to it of gain x stream
};

/// Which streams drive which sliders: equal names first, then what both do (naming/action.h): a slider that does one
/// action, or the same action on both sides, takes the mean of the streams of these actions. Sliders that mix actions,
/// such as visemes, are driven by a stream of their own name alone.
std::vector<SliderLink> link_sliders(const std::vector<std::string>& streams, const Character& character);

}  // namespace mien
