#pragma once
/// What `validate` finds wrong with what a mesh only carries: custom attributes, loose points and lines.

#include <string>
#include <vector>

#include "mien/character/validate.h"

namespace mien::detail {

/// Adds the problems of `mesh.attributes` and `mesh.loose`. `materials`: how many the character has.
void check_carried(const Mesh& mesh, std::size_t materials, const std::string& place,
                   std::vector<Problem>& problems);

}  // namespace mien::detail
