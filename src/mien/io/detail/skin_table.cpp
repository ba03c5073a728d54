#include "mien/io/detail/skin_table.h"

#include <algorithm>
#include <cmath>

namespace mien::detail {

void tidy_influences(std::vector<Influence>& influences) {
  std::erase_if(influences, [](const Influence& i) { return !(i.weight > 0); });
  std::stable_sort(influences.begin(), influences.end(),
                   [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < influences.size(); ++i) {
    if (kept > 0 && influences[kept - 1].joint == influences[i].joint)
      influences[kept - 1].weight += influences[i].weight;
    else
      influences[kept++] = influences[i];
  }
  influences.resize(kept);
  std::stable_sort(influences.begin(), influences.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  if (influences.empty()) influences.push_back({0, 1.f});
  double sum = 0;
  for (const Influence& i : influences) sum += i.weight;
  // Sums that are one within float rounding are left alone, so that reading and writing again changes
  // nothing.
  if (std::abs(sum - 1) > 1e-7 * static_cast<double>(influences.size()))
    for (Influence& i : influences) i.weight = static_cast<float>(i.weight / sum);
  std::erase_if(influences, [](const Influence& i) { return !(i.weight > 0); });
}

void append_influences(SkinWeights& skin, const std::vector<Influence>& influences) {
  if (skin.offsets.empty()) skin.offsets.push_back(0);
  for (const Influence& i : influences) {
    skin.joints.push_back(i.joint);
    skin.weights.push_back(i.weight);
  }
  skin.offsets.push_back(static_cast<int>(skin.joints.size()));
}

}  // namespace mien::detail
