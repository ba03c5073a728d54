// The extension rides as data that a glTF carries; only the numbers of nodes and morph targets have to be those of the file.
#include "mien/io/vrm.h"

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/io/detail/gltf_write.h"
#include "mien/io/detail/json_file.h"
#include "mien/io/detail/vrm_rules.h"
#include "mien/io/gltf.h"

namespace mien {
namespace {

using detail::Json;

Json meta_json(const VrmMeta& meta) {
  Json json = {{"name", meta.name}, {"authors", meta.authors}, {"licenseUrl", meta.license_url}};
  const std::pair<const char*, const std::string*> texts[] = {
      {"version", &meta.version},
      {"copyrightInformation", &meta.copyright_information},
      {"contactInformation", &meta.contact_information},
      {"thirdPartyLicenses", &meta.third_party_licenses},
      {"otherLicenseUrl", &meta.other_license_url}};
  for (const auto& [key, text] : texts)
    if (!text->empty()) json[key] = *text;
  if (!meta.references.empty()) json["references"] = meta.references;
  return json;
}

/// The shape on every mesh that lists it.
void add_binds(const Character& character, const std::vector<int>& node_of_part, const VrmBind& bind,
               Json& binds) {
  const Shape& shape = character.shapes[static_cast<std::size_t>(bind.shape)];
  for (const PartDelta& delta : shape.parts) {
    const int node = node_of_part[static_cast<std::size_t>(delta.part)];
    if (node < 0) continue;  // the file only carries the part
    int index = 0;
    for (int s = 0; s < bind.shape; ++s)
      for (const PartDelta& other : character.shapes[static_cast<std::size_t>(s)].parts)
        index += other.part == delta.part;
    binds.push_back({{"node", node}, {"index", index}, {"weight", bind.weight}});
  }
}

Json expression_json(const Character& character, const std::vector<int>& node_of_part,
                     const VrmExpression& expression) {
  constexpr const char* names[] = {"none", "block", "blend"};
  Json json = {{"isBinary", expression.is_binary},
               {"overrideMouth", names[static_cast<int>(expression.mouth)]},
               {"overrideBlink", names[static_cast<int>(expression.blink)]},
               {"overrideLookAt", names[static_cast<int>(expression.look_at)]}};
  Json binds = Json::array();
  for (const VrmBind& bind : expression.binds) add_binds(character, node_of_part, bind, binds);
  if (!binds.empty()) json["morphTargetBinds"] = std::move(binds);
  return json;
}

Json look_at_json(const VrmLookAt& look_at) {
  const Json range = {{"inputMaxValue", look_at.input_max}, {"outputScale", look_at.output_scale}};
  const Eigen::Vector3d& offset = look_at.offset_from_head;
  return {{"type", look_at.by_bones ? "bone" : "expression"},
          {"offsetFromHeadBone", {offset.x(), offset.y(), offset.z()}},
          {"rangeMapHorizontalInner", range},
          {"rangeMapHorizontalOuter", range},
          {"rangeMapVerticalDown", range},
          {"rangeMapVerticalUp", range}};
}

Json vrm_json(const Character& character, const VrmAvatar& avatar) {
  const std::vector<int> node_of_part = detail::written_nodes_of_parts(character);
  Json vrm = {{"specVersion", "1.0"}, {"meta", meta_json(avatar.meta)}};
  for (const VrmBone& bone : avatar.bones) vrm["humanoid"]["humanBones"][bone.name] = {{"node", bone.node}};
  for (const VrmExpression& expression : avatar.expressions)
    vrm["expressions"][expression.is_preset ? "preset" : "custom"][expression.name] =
        expression_json(character, node_of_part, expression);
  if (avatar.look_at) vrm["lookAt"] = look_at_json(*avatar.look_at);
  return vrm;
}

}  // namespace

VrmMeta read_vrm_meta(const std::filesystem::path& path) {
  return detail::read_json_file(path, [](const detail::JsonObject& root) {
    root.expect_only({"name", "authors", "licenseUrl", "version", "copyrightInformation",
                      "contactInformation", "references", "thirdPartyLicenses", "otherLicenseUrl"});
    VrmMeta meta;
    meta.name = root.text_or("name", "");
    meta.authors = root.texts("authors");
    meta.license_url = root.text_or("licenseUrl", meta.license_url);
    meta.version = root.text_or("version", "");
    meta.copyright_information = root.text_or("copyrightInformation", "");
    meta.contact_information = root.text_or("contactInformation", "");
    meta.references = root.texts("references");
    meta.third_party_licenses = root.text_or("thirdPartyLicenses", "");
    meta.other_license_url = root.text_or("otherLicenseUrl", "");
    return meta;
  });
}

void write_vrm(const Character& character, const VrmAvatar& avatar, const std::filesystem::path& path) {
  try {
    require_valid(character);
    detail::check_vrm(character, avatar);
    Character file = character;
    Json carried = detail::carried_json(character.carried, "carried");
    carried["extensions"]["VRMC_vrm"] = vrm_json(character, avatar);
    Json& used = carried["extensionsUsed"];
    if (!used.is_array()) used = Json::array();
    used.push_back("VRMC_vrm");
    file.carried = detail::json_text(carried);
    write_gltf(file, path);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
