#include "mien/naming/rename.h"

#include <algorithm>
#include <map>
#include <set>

#include "mien/core/error.h"

namespace mien {
namespace {

/// The convention's one name for all of these actions, or "".
std::string common_name(const std::vector<std::string>& names, const std::vector<ActionShare>& shares) {
  std::string common;
  for (const ActionShare& share : shares) {
    const std::string& name = names[static_cast<std::size_t>(share.action)];
    if (share.share != 1 || name.empty() || (!common.empty() && name != common)) return {};
    common = name;
  }
  return common;
}

template <typename Elements>
void check_unique(const Elements& elements, const char* kind) {
  std::set<std::string> seen;
  for (const auto& element : elements)
    if (!seen.insert(element.name).second)
      throw invalid_input(std::string(kind) + " " + element.name, "would be the name of two",
                          "give each its own new name");
}

template <typename Elements>
void give_names(const std::map<std::string, std::string>& names, Elements& elements,
                std::set<std::string>& used) {
  for (auto& element : elements)
    if (const auto found = names.find(element.name); found != names.end()) {
      used.insert(found->first);
      element.name = found->second;
    }
}

}  // namespace

NamePairs names_for(const Character& character, Convention convention) {
  const std::vector<std::string> names = names_in(convention);
  NamePairs pairs;
  std::map<std::string, int> wanted;
  for (const Slider& slider : character.sliders) {
    std::string name = common_name(names, actions_of(slider.name));
    if (name.empty()) continue;
    ++wanted[name];
    pairs.emplace_back(slider.name, std::move(name));
  }
  std::erase_if(pairs, [&](const auto& pair) { return wanted[pair.second] > 1; });
  return pairs;
}

Character rename(const Character& character, const NamePairs& names) {
  const std::map<std::string, std::string> table(names.begin(), names.end());
  Character renamed = character;
  std::set<std::string> used;
  give_names(table, renamed.sliders, used);
  give_names(table, renamed.shapes, used);
  for (const auto& [from, to] : names)
    if (!used.contains(from))
      throw invalid_input(from, "is neither a slider nor a shape", "name one that `mien inspect` lists");
  check_unique(renamed.sliders, "slider");
  check_unique(renamed.shapes, "shape");
  return renamed;
}

Character rename_joints(const Character& character, const NamePairs& names) {
  Character renamed = character;
  const std::map<std::string, std::string> table(names.begin(), names.end());
  std::set<std::string> used;
  give_names(table, renamed.nodes, used);
  for (const auto& [from, to] : table) {
    if (!used.contains(from)) throw invalid_input(from, "is no joint", "name one that `mien inspect` lists");
    const auto has_name = [&](const Node& node) { return node.name == to; };
    if (std::count_if(renamed.nodes.begin(), renamed.nodes.end(), has_name) > 1)
      throw invalid_input("joint " + to, "would be the name of two", "give each its own new name");
  }
  return renamed;
}

}  // namespace mien
