#pragma once
/// Names with wildcards: * stands for any run of characters, ? for one; case does not matter.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mien {

/// What the wildcards of `pattern` stand for in `name`, in order, each * as short as it can be from the left; nothing: it does
/// not fit.
///   cost  lengths multiplied at most
std::optional<std::vector<std::string>> match_wildcards(std::string_view pattern, std::string_view name);

bool fits_wildcards(std::string_view pattern, std::string_view name);

/// `pattern` with its wildcards filled in, in order; those without a filling become nothing.
std::string fill_wildcards(std::string_view pattern, const std::vector<std::string>& fillings);

}  // namespace mien
