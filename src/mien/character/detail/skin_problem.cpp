#include "mien/character/detail/skin_problem.h"

#include <algorithm>
#include <cmath>

namespace mien::detail {

std::optional<Problem> skin_problem(const SkinWeights& skin, std::size_t count, std::size_t joint_count,
                                    const std::string& place, const std::string& row) {
  if (skin.offsets.size() != count + 1 || skin.offsets.front() != 0 ||
      static_cast<std::size_t>(skin.offsets.back()) != skin.joints.size() ||
      skin.weights.size() != skin.joints.size() || !std::is_sorted(skin.offsets.begin(), skin.offsets.end()))
    return Problem{place, "has skin weights whose counts do not fit together",
                   "give each " + row + " its influences"};
  for (std::size_t v = 0; v < count; ++v) {
    double sum = 0;
    const auto here = [&] { return place + ": " + row + " " + std::to_string(v); };
    for (int i = skin.offsets[v]; i < skin.offsets[v + 1]; ++i) {
      if (skin.joints[i] < 0 || skin.joints[i] >= static_cast<int>(joint_count))
        return Problem{here(), "names joint " + std::to_string(skin.joints[i]),
                       "there are " + std::to_string(joint_count)};
      if (!(skin.weights[i] >= 0) || !std::isfinite(skin.weights[i]))
        return Problem{here(), "has a skin weight that is negative or not finite", "give weights in [0, 1]"};
      sum += skin.weights[i];
    }
    if (std::abs(sum - 1) > 1e-3)
      return Problem{here(), "has skin weights that sum to " + std::to_string(sum), "they sum to 1"};
  }
  return {};
}

}  // namespace mien::detail
