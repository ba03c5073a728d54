#include "mien/naming/action.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <utility>

#include "mien/core/error.h"
#include "mien/naming/detail/tables.h"

namespace mien {
namespace {

using detail::plain_name;
using detail::PlainName;
using detail::Recipe;

constexpr std::array<const char*, convention_count> convention_names{
    "arkit", "live-link", "ict", "face-cap", "makehuman", "facs", "vrm", "visemes"};

using NameKey = std::pair<std::string, char>;

NameKey key_of(const PlainName& name) {
  return {name.base, name.side};
}

/// The actions that an ingredient's name stands for on one side, or on both: `mouthSmile`, `jawOpen`.
std::vector<int> actions_named(const PlainName& name) {
  std::vector<int> found;
  for (std::size_t a = 0; a < action_names().size(); ++a) {
    const PlainName action = plain_name(action_names()[a]);
    if (action.base == name.base && (action.side == name.side || name.side == 0 || action.side == 0))
      found.push_back(static_cast<int>(a));
  }
  return found;
}

using NameTable = std::map<NameKey, std::vector<ActionShare>>;

/// A sideless recipe holds for each side too: AU12, AU12_L.
void add_recipe(const Recipe& recipe, NameTable& table) {
  const PlainName own = plain_name(recipe.name);
  for (const char side : {char{0}, 'L', 'R'}) {
    if (own.side != 0 && side != own.side) continue;
    std::vector<ActionShare> shares;
    for (const detail::Ingredient& ingredient : recipe.ingredients) {
      PlainName action = plain_name(ingredient.action);
      if (side != 0 && own.side == 0) {
        if (action.side != 0 && action.side != side) continue;  // AU61_L is the left eye's share of the look
        action.side = side;
      }
      for (const int a : actions_named(action)) shares.push_back({a, ingredient.share});
    }
    table.emplace(NameKey{own.base, side}, std::move(shares));
  }
}

const NameTable& name_table() {
  static const NameTable table = [] {
    NameTable names;
    for (const std::string& action : action_names()) {
      const PlainName plain = plain_name(action);
      for (const char side : {char{0}, 'L', 'R'}) {
        // jawLeft and mouthLeft are directions, not sides of "jaw".
        const bool direction = plain.base == "jaw" || plain.base == "mouth";
        if ((direction || (plain.side != 0 && side != 0)) && side != plain.side) continue;
        std::vector<ActionShare> shares;
        for (const int a : actions_named({plain.base, side})) shares.push_back({a, 1});
        names.emplace(NameKey{plain.base, side}, std::move(shares));
      }
    }
    for (const Recipe& recipe : detail::recipes()) add_recipe(recipe, names);
    return names;
  }();
  return table;
}

std::string with_side(std::string_view action, std::string_view left, std::string_view right) {
  std::string name(action);
  for (const auto& [word, token] :
       {std::pair(std::string_view("Left"), left), std::pair(std::string_view("Right"), right)})
    if (name.ends_with(word) && name != "jawLeft" && name != "jawRight" && name != "mouthLeft" &&
        name != "mouthRight")
      return name.substr(0, name.size() - word.size()) + std::string(token);
  return name;
}

std::string capitalised(std::string name) {
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  return name;
}

/// The convention's name whose only full share, side for side, is this action.
std::string recipe_name(Convention convention, int action) {
  const PlainName plain = plain_name(action_names()[static_cast<std::size_t>(action)]);
  for (const Recipe& recipe : detail::recipes()) {
    if (recipe.convention != convention || recipe.ingredients.size() != 1 || recipe.ingredients[0].share != 1)
      continue;
    const PlainName wanted = plain_name(recipe.ingredients[0].action);
    if (wanted.base != plain.base || (wanted.side != 0 && wanted.side != plain.side)) continue;
    std::string name(recipe.name);
    if (plain.side == 0 || convention == Convention::facs || convention == Convention::vrm) return name;
    // MakeHuman writes eye-left-closure, but mouth shapes for both sides at once.
    if (const std::size_t dash = name.find('-'); dash != name.npos && !name.starts_with("mouth"))
      name.insert(dash, plain.side == 'L' ? "-left" : "-right");
    return name;
  }
  return {};
}

}  // namespace

std::vector<ActionShare> actions_of(std::string_view name) {
  const auto found = name_table().find(key_of(plain_name(name)));
  if (found != name_table().end()) return found->second;
  // "Head.jawOpen", "blendShape1:jawOpen"
  const std::size_t separator = name.find_last_of(".:/|");
  if (separator == name.npos || separator + 2 >= name.size()) return {};
  return actions_of(name.substr(separator + 1));
}

std::vector<std::string> names_in(Convention convention) {
  std::vector<std::string> names;
  for (std::size_t a = 0; a < action_names().size(); ++a) {
    const std::string& action = action_names()[a];
    switch (convention) {
      case Convention::arkit:
        names.push_back(action);
        break;
      case Convention::live_link:
        names.push_back(capitalised(action));
        break;
      case Convention::ict:
      case Convention::face_cap:
        names.push_back(with_side(action, "_L", "_R"));
        break;
      default:
        names.push_back(recipe_name(convention, static_cast<int>(a)));
    }
  }
  return names;
}

FoundConvention find_convention(const std::vector<std::string>& names) {
  FoundConvention best;
  for (int c = 0; c < convention_count; ++c) {
    const auto convention = static_cast<Convention>(c);
    std::vector<std::string> known = names_in(convention);
    for (const Recipe& recipe : detail::recipes())
      if (recipe.convention == convention) known.emplace_back(recipe.name);
    std::sort(known.begin(), known.end());
    const auto count = std::count_if(names.begin(), names.end(), [&](const std::string& name) {
      return !name.empty() && std::binary_search(known.begin(), known.end(), name);
    });
    if (count > best.known) best = {convention, static_cast<int>(count)};
  }
  return best;
}

std::string_view name_of(Convention convention) {
  return convention_names[static_cast<std::size_t>(convention)];
}

Convention convention_of_name(std::string_view name) {
  std::string known;
  for (std::size_t c = 0; c < convention_names.size(); ++c) {
    if (name == convention_names[c]) return static_cast<Convention>(c);
    known += (known.empty() ? "" : ", ") + std::string(convention_names[c]);
  }
  throw invalid_input("convention " + std::string(name.substr(0, 40)), "is not known", "one of: " + known);
}

}  // namespace mien
