#include "mien/texture/retexture.h"

#include <nlohmann/json.hpp>

#include "mien/core/error.h"

namespace mien {
namespace {

using Json = nlohmann::json;

Json members_of(const std::string& text, const std::string& place) {
  const Json json = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
  if (!json.is_object()) throw invalid_input(place, "is not a JSON object", "carry glTF's members");
  return json;
}

/// A texture reference of any slot or extension: an object with an integer "index".
bool is_texture_info(const std::string& key, const Json& value) {
  return key.ends_with("Texture") && value.is_object() && value.contains("index") &&
         value["index"].is_number_integer();
}

void drop_textures(Json& json) {
  for (auto member = json.begin(); member != json.end();) {
    if (is_texture_info(member.key(), *member)) {
      member = json.erase(member);
      continue;
    }
    if (member->is_object()) drop_textures(*member);
    ++member;
  }
}

/// Copies textures as they are met, each with its image and sampler.
class TextureCopier {
 public:
  TextureCopier(const Appearance& from, Appearance& to) : from_(from), to_(to) {}

  void renumber(Json& json) {
    for (auto& [key, value] : json.items()) {
      if (is_texture_info(key, value))
        value["index"] = texture(value["index"].get<std::int64_t>());
      else if (value.is_object())
        renumber(value);
    }
  }

 private:
  template <typename Elements>
  int copy(const Elements& from, Elements& to, const Json& index, const char* what) {
    if (!index.is_number_integer() || index < 0 || index >= from.size())
      throw invalid_input("material", std::string("names ") + what + " " + index.dump().substr(0, 20),
                          "there are " + std::to_string(from.size()));
    to.push_back(from[index.get<std::size_t>()]);
    return static_cast<int>(to.size()) - 1;
  }

  int texture(std::int64_t index) {
    const int copied = copy(from_.textures, to_.textures, index, "texture");
    Json json =
        members_of(from_.textures[static_cast<std::size_t>(index)], "texture " + std::to_string(index));
    if (json.contains("source")) json["source"] = copy(from_.images, to_.images, json["source"], "image");
    if (json.contains("sampler"))
      json["sampler"] = copy(from_.samplers, to_.samplers, json["sampler"], "sampler");
    to_.textures[static_cast<std::size_t>(copied)] = json.dump();
    return copied;
  }

  const Appearance& from_;
  Appearance& to_;
};

}  // namespace

Material with_textures(const Material& material, const std::vector<std::pair<TextureSlot, int>>& textures) {
  Material result = material;
  Json json = members_of(material.carried, "material " + material.name);
  if (material.carried.empty())  // as such a material is written
    json["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}};
  drop_textures(json);
  for (const auto& [slot, texture] : textures) {
    const bool inside = slot == TextureSlot::base_color || slot == TextureSlot::metallic_roughness;
    (inside ? json["pbrMetallicRoughness"] : json)[std::string(name_of(slot))] = {{"index", texture}};
  }
  result.carried = json.dump();
  return result;
}

int add_texture(Appearance& looks, std::string name, std::vector<unsigned char> png, Wrap wrap) {
  Image image;
  image.name = std::move(name);
  image.mime_type = "image/png";
  image.bytes = std::move(png);
  looks.images.push_back(std::move(image));
  const int code = wrap == Wrap::clamp ? 33071 : wrap == Wrap::mirror ? 33648 : 10497;
  looks.samplers.push_back(
      Json{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", code}, {"wrapT", code}}.dump());
  looks.textures.push_back(
      Json{{"sampler", looks.samplers.size() - 1}, {"source", looks.images.size() - 1}}.dump());
  return static_cast<int>(looks.textures.size()) - 1;
}

int copy_material(const Character& from, int material, Appearance& to) {
  const auto& materials = from.appearance.materials;
  if (material < 0 || material >= static_cast<int>(materials.size()))
    throw invalid_input("material " + std::to_string(material), "does not exist",
                        "there are " + std::to_string(materials.size()));
  Material copied = materials[static_cast<std::size_t>(material)];
  if (!copied.carried.empty()) {
    Json json = members_of(copied.carried, "material " + copied.name);
    TextureCopier(from.appearance, to).renumber(json);
    copied.carried = json.dump();
  }
  to.materials.push_back(std::move(copied));
  return static_cast<int>(to.materials.size()) - 1;
}

}  // namespace mien
