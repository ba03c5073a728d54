#pragma once
/// What a configuration must be before a panel is made from it.

#include "mien/character/control_config.h"

namespace mien::detail {

///   throws  invalid_input: as make_controls
void check_config(const ControlConfig& config);

}  // namespace mien::detail
