#pragma once
/// An image for the skin: what no vertex shows.

#include "mien/sample/detail/character_form.h"

namespace mien::sample {

/// Gives the skin's materials one image in the face's UVs that darkens their base colours: flushed cheeks and nose, brows,
/// freckles, cropped hair, lips that fade into the skin. To be called before the character is placed.
void paint_skin(BuiltCharacter& built, const CharacterForm& form);

}  // namespace mien::sample
