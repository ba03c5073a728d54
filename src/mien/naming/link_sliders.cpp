#include "mien/naming/link_sliders.h"

#include <algorithm>
#include <set>

#include "mien/character/sliders.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

/// The streams of each action, with the action's share in them. A stream that mixes actions gives each its share.
std::vector<std::vector<SliderLink>> streams_of_actions(const std::vector<std::string>& streams,
                                                        const std::set<std::string>& taken) {
  std::vector<std::vector<SliderLink>> links(action_names().size());
  for (const std::string& stream : streams)
    if (!taken.contains(stream))
      for (const ActionShare& share : actions_of(stream))
        links[static_cast<std::size_t>(share.action)].push_back({stream, {}, share.share});
  return links;
}

/// A slider that stands for whole actions alone, so that an action's value is the slider's.
bool is_whole(const std::vector<ActionShare>& shares) {
  return !shares.empty() &&
         std::all_of(shares.begin(), shares.end(), [](const ActionShare& share) { return share.share == 1; });
}

}  // namespace

std::vector<SliderLink> link_sliders(const std::vector<std::string>& streams, const Character& character) {
  std::vector<SliderLink> links;
  std::set<std::string> taken;
  for (const Slider& slider : character.sliders)
    if (std::find(streams.begin(), streams.end(), slider.name) != streams.end()) {
      links.push_back({slider.name, slider.name, 1});
      taken.insert(slider.name);
    }
  const auto by_action = streams_of_actions(streams, taken);
  for (const Slider& slider : character.sliders) {
    const std::vector<ActionShare> shares = actions_of(slider.name);
    if (taken.contains(slider.name) || !is_whole(shares)) continue;
    for (const ActionShare& share : shares)
      for (const SliderLink& stream : by_action[static_cast<std::size_t>(share.action)]) {
        const double gain = stream.gain / static_cast<double>(shares.size());
        const auto known = std::find_if(links.begin(), links.end(), [&](const SliderLink& link) {
          return link.from == stream.from && link.to == slider.name;
        });
        if (known == links.end())
          links.push_back({stream.from, slider.name, gain});
        else
          known->gain += gain;
      }
  }
  return links;
}

}  // namespace mien
