#pragma once
/// The controls file: from what a control interface is made.

#include <filesystem>
#include <string>

#include "mien/character/control_config.h"

namespace mien {

/// {"names": [{"match": PATTERN, "is": PATTERN}], "regions": [{"name": NAME, "match": [PATTERN, ...], "side": "left"}], "limits":
/// [{"match": PATTERN, "slider": [low, high], "rotation": {"x": [low, high]}, "translation": {...}}], "mirrors": [[PATTERN, PATTERN]],
/// "pads": [{"name": NAME, "label": TEXT, "region": NAME, "right": PATTERN, "left": ..., "up": ..., "down": ...}], "moves": [PATTERN],
/// "layout": {"columns": [[REGION, ...], ...], "width": 10, "rows": 44}, "other": NAME}. What is left out is `usual`'s.
///   throws  Error naming the file and the place: another form, an unknown member, numbers that are not finite
ControlConfig read_control_config(const std::filesystem::path& path, const ControlConfig& usual);

/// The same form, whole: reading it gives the configuration back.
std::string control_config_text(const ControlConfig& config);

}  // namespace mien
