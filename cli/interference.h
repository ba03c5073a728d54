#pragma once
/// What `mien inspect` says of sliders that disturb each other, and of rules that a clip breaks.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "mien/character/character.h"

namespace mien::cli {

/// {"overlap": [[...]], "pairs": [{"first", "second", "overlap", "alignment", "part", "vertex"}]}; with a path, the overlaps
/// as a matrix picture (.png) too.
nlohmann::json describe_interference(const Character& character, const std::filesystem::path& picture);
std::string interference_text(const nlohmann::json& interference);

/// What the clip (empty: the first) breaks of the rules in `file`: [{"rule", "seconds", "slider" or nothing, "vertex", "by"}].
nlohmann::json describe_rule_breaks(const Character& character, const std::filesystem::path& file,
                                    const std::string& clip);
std::string rule_breaks_text(const nlohmann::json& breaks);

}  // namespace mien::cli
