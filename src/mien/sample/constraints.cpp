// What jaw and eyes do not go beyond in life: the jaw opens to about two fingers, the eyes turn by some forty degrees.
#include <numbers>

#include "mien/sample/detail/character_form.h"

namespace mien::sample {
namespace {

constexpr double degree = std::numbers::pi / 180;

void limit(Character& character, const char* joint, const std::array<ValueRange, 3>& degrees) {
  Constraint constraint;
  constraint.name = std::string(joint) + " limits";
  constraint.node = find_node(character, joint);
  for (std::size_t a = 0; a < 3; ++a)
    constraint.rotation[a] = {degrees[a].low * degree, degrees[a].high * degree};
  character.constraints.push_back(std::move(constraint));
}

}  // namespace

void add_constraints(Character& character) {
  limit(character, "jaw", {ValueRange{-2, 32}, ValueRange{-8, 8}, ValueRange{-6, 6}});
  for (const char* eye : {"eyeLeft_joint", "eyeRight_joint"})
    limit(character, eye, {ValueRange{-30, 30}, ValueRange{-40, 40}, ValueRange{-10, 10}});
}

}  // namespace mien::sample
