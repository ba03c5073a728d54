#pragma once
/// What `mien inspect` says of constraints and controls.

#include <nlohmann/json.hpp>
#include <string>

#include "mien/character/character.h"

namespace mien::cli {

/// Arrays of objects: `{"name", "kind", "node", "sources", ...}`, `{"name", "region", "kind", "sliders" or "node", "mirror"}`. Names
/// stand for numbers; a number that is out of range is said to be one.
nlohmann::json describe_constraints(const Character& character);
nlohmann::json describe_controls(const Character& character);

/// A line a constraint; a line a region of the controls. Nothing when there are none.
std::string constraint_rows(const nlohmann::json& constraints);
std::string control_rows(const nlohmann::json& controls);

}  // namespace mien::cli
