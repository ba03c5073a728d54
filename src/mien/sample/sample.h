#pragma once
/// Built-in characters, made by code alone: a rigged human head and two bare heads to give its rig to.

#include <span>
#include <string>
#include <string_view>

#include "mien/character/character.h"

namespace mien {

struct SampleInfo {
  std::string_view name;
  std::string_view description;  ///< one line
  bool is_target = false;        ///< a bare head: no shapes, no joints
};

/// All built-in characters, the source first.
std::span<const SampleInfo> sample_list();

/// The built-in character of this name. All have landmarks `ibug_1` ... `ibug_68` and the curves `browLeft`,
/// `browRight`, `lipUpper`, `lipLower`; `human` looks along +Z with Y up, its left at +X, in metres.
/// Two calls give equal characters. Cost: below a second.
///   throws  invalid_input: an unknown name
Character make_sample(std::string_view name);

}  // namespace mien
