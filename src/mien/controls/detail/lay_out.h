#pragma once
/// Places of controls on the panel.

#include <vector>

#include "mien/character/control.h"
#include "mien/character/control_config.h"

namespace mien::detail {

/// Rows above a region's first control, for its name.
constexpr double heading_rows = 1.2;

/// Gives each control its place and size: columns as the configuration has them, in each its regions one below the other,
/// in each of these pads, then sliders, then joints, in their order. No two overlap.
void lay_out(const ControlConfig& config, std::vector<Control>& controls);

}  // namespace mien::detail
