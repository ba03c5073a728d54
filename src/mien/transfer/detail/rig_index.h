#pragma once
/// Rigs whose elements are numbered alike, so that they can be compared number by number.

#include <array>
#include <string>
#include <vector>

#include "mien/character/character.h"

namespace mien::detail {

/// Kinds of elements that others refer to by number.
enum class Kind { node, shape, slider, wire, object };
constexpr std::size_t kind_count = 5;

/// Per kind, per element: its new number, -1: it goes, and what names it goes too (or names nothing then).
using RigNumbers = std::array<std::vector<int>, kind_count>;
/// Per kind the elements' names, made unique: the second node "head" is "head#2".
using RigNames = std::array<std::vector<std::string>, kind_count>;

RigNames names_of(const Character& character);

/// The names of three rigs in one list a kind: the order of `edited` where `after` kept that of `before`, else that of `after`
/// with the others' names behind.
RigNames joined(const RigNames& before, const RigNames& after, const RigNames& edited);

/// Where a rig's elements are in joined lists.
RigNumbers numbers_in(const RigNames& names, const RigNames& all);

/// The rig with its elements at their new numbers, `counts` of a kind; between them are empty elements. Skins keep their
/// joints' order; joints that go leave their skin, and their skin weights are spread over the others of the vertex.
Character renumbered(Character character, const RigNumbers& numbers,
                     const std::array<std::size_t, kind_count>& counts);

}  // namespace mien::detail
