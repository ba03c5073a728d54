#pragma once
/// The conventions' names as data.

#include <array>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "mien/naming/action.h"

namespace mien::detail {

/// An action and how much of it; an action without a side stands for both.
struct Ingredient {
  std::string_view action;
  double share = 1;
};

/// A name that is not an action's own, written without a side where the same holds for each side.
struct Recipe {
  Convention convention;
  std::string_view name;
  std::vector<Ingredient> ingredients;
};

/// Names beside ARKit's own and those that differ from them in case, separators and sides alone.
const std::vector<Recipe>& recipes();

/// A name without its case, separators and side.
struct PlainName {
  std::string base;
  char side = 0;  ///< 'L', 'R' or 0
  bool operator==(const PlainName&) const = default;
};
PlainName plain_name(std::string_view name);

}  // namespace mien::detail
