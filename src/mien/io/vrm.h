#pragma once
/// VRM 1.0 files: a binary glTF with the extension VRMC_vrm.

#include <filesystem>

#include "mien/character/character.h"
#include "mien/character/vrm_avatar.h"

namespace mien {

/// {"name": NAME, "authors": [NAME, ...], "licenseUrl": URL, "version", "copyrightInformation", "contactInformation", "references":
/// [TEXT, ...], "thirdPartyLicenses", "otherLicenseUrl"}; all may be left out.
///   throws  Error naming the file and the place: another form, an unknown member
VrmMeta read_vrm_meta(const std::filesystem::path& path);

/// Writes `character` as .vrm: bones by node, expressions by node and morph target. A part's shapes are bound on every mesh that has
/// them. `load` reads the file back like a .glb; what VRM says rides along as carried data.
///   throws  invalid_input: what `validate` finds; a meta without name, author or licence; a required bone that is missing, a bone that is
///           named twice, unknown or not below its parent bone, or has a scale that is not above 0; two expressions of one name,
///           a preset that VRM does not have, a custom one named like a preset, a bind out of range; io: cannot be written
void write_vrm(const Character& character, const VrmAvatar& avatar, const std::filesystem::path& path);

}  // namespace mien
