#pragma once
/// Run times that the thesis reports (Orvalho 2007, Reusable Facial Rigging and Animation, tables 5.1 and 5.2), to print
/// beside one's own. Seconds; 2007's machines.

#include <array>
#include <span>
#include <string_view>

namespace mien {

struct ThesisCharacter {
  std::string_view name;
  int table = 1;      ///< 5.1 or 5.2
  int triangles = 0;  ///< of the target
};

struct ThesisStep {
  std::string_view name;            ///< as the thesis prints it
  std::string_view step;            ///< TransferReport's name of the same work, "" when there is none
  std::array<double, 6> seconds{};  ///< by thesis_characters
  bool each_shape = false;          ///< for one shape
};

std::span<const ThesisCharacter> thesis_characters();
std::span<const ThesisStep> thesis_steps();

}  // namespace mien
