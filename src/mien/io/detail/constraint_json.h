#pragma once
/// A constraint as JSON: the same in the file of a character, which numbers nodes, and in a small file, which names them.

#include <array>
#include <functional>
#include <string>

#include "mien/character/constraint.h"
#include "mien/io/detail/json.h"

namespace mien::detail {

/// The node that the member `key` says, or an error at its place.
using NodeReader = std::function<int(const JsonObject& source, const char* key)>;

/// {"x": [low, high], ...} under `key`, null for an end that is not there; axes without a limit are left out.
void write_ranges(const std::array<ValueRange, 3>& ranges, const char* key, Json& json);
///   throws  io: another form
void read_ranges(const JsonObject& source, const char* key, std::array<ValueRange, 3>& ranges);

/// Nodes by number. What is as Constraint has it by itself is left out.
Json constraint_json(const Constraint& constraint);

///   throws  io: another form, an unknown kind or member, numbers that are not finite, what `node_of` complains of
Constraint read_constraint(const JsonObject& source, const NodeReader& node_of);

}  // namespace mien::detail
