#pragma once
/// What a piece of a head is, by its name and its form.

#include <string>
#include <string_view>

#include "mien/transfer/detail/pool.h"

namespace mien::detail {

enum class PieceKind { skin, eye, teeth, tongue, lash, other };

/// Reads the kind from a name ("l-eye", "upper-teeth", "Head: Lashes"); `other` when it says nothing.
PieceKind kind_from_name(const std::string& name);

/// By the name or, where that says nothing, by the form: a ball is an eye.
PieceKind kind_of(const Pool& pool, int piece, double unit);

/// +1 upper, -1 lower, 0 not said.
int row_from_name(const std::string& name);

/// Of what is worn on the skin (PieceKind::lash) what stands off it; brows lie on it.
bool is_lash(const std::string& name);

std::string_view name_of(PieceKind kind);

}  // namespace mien::detail
