#include "mien/texture/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mien/core/error.h"

namespace mien {
namespace {

using Json = nlohmann::json;

/// Carried text as an object; an empty text is an empty one.
Json object_of(const std::string& text, const std::string& place) {
  if (text.empty()) return Json::object();
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw invalid_input(place, "is not a JSON object", "carry a glTF material");
  return json;
}

/// The member when it is an object, else an empty one.
Json member(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? *found : Json::object();
}

double number(const Json& json, const char* key, double fallback) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : fallback;
}

int index_of(const Json& json, const char* key, std::size_t count, const std::string& place) {
  const auto found = json.find(key);
  if (found == json.end()) return -1;
  if (!found->is_number_integer() || found->get<std::int64_t>() < 0 || found->get<std::uint64_t>() >= count)
    throw invalid_input(place, std::string("names ") + key + " " + found->dump().substr(0, 20),
                        "there are " + std::to_string(count));
  return found->get<int>();
}

Eigen::Vector2d pair(const Json& json, const char* key, const Eigen::Vector2d& fallback) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->size() != 2 || !(*found)[0].is_number() ||
      !(*found)[1].is_number())
    return fallback;
  return {(*found)[0].get<double>(), (*found)[1].get<double>()};
}

Wrap wrap_of(double code) {
  return code == 33071 ? Wrap::clamp : code == 33648 ? Wrap::mirror : Wrap::repeat;
}

int wrapped(int i, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == Wrap::mirror ? 2 * size : size;
  const int inside = ((i % period) + period) % period;
  return inside < size ? inside : period - 1 - inside;
}

/// sRGB bytes as linear light.
const std::array<float, 256>& linear_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
      const double s = static_cast<double>(i) / 255;
      made[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return made;
  }();
  return table;
}

const Material* material_at(const Character& character, int material) {
  const auto& all = character.appearance.materials;
  return material >= 0 && material < static_cast<int>(all.size()) ? &all[static_cast<std::size_t>(material)]
                                                                  : nullptr;
}

}  // namespace

std::string_view name_of(TextureSlot slot) {
  constexpr std::array<std::string_view, 5> names{"baseColorTexture", "metallicRoughnessTexture",
                                                  "normalTexture", "occlusionTexture", "emissiveTexture"};
  return names[static_cast<std::size_t>(slot)];
}

std::optional<TextureUse> texture_of(const Character& character, int index, TextureSlot slot) {
  const Material* material = material_at(character, index);
  if (!material) return std::nullopt;
  const std::string place = "material " + material->name;
  const Json json = object_of(material->carried, place);
  const bool inside = slot == TextureSlot::base_color || slot == TextureSlot::metallic_roughness;
  const Json info =
      member(inside ? member(json, "pbrMetallicRoughness") : json, std::string(name_of(slot)).c_str());
  if (info.empty()) return std::nullopt;
  const Appearance& looks = character.appearance;
  TextureUse use;
  use.texture = index_of(info, "index", looks.textures.size(), place);
  if (use.texture < 0) return std::nullopt;
  const Json transform = member(member(info, "extensions"), "KHR_texture_transform");
  use.uv_set =
      static_cast<int>(std::clamp(number(transform, "texCoord", number(info, "texCoord", 0)), 0.0, 1e6));
  use.offset = pair(transform, "offset", use.offset);
  use.scale = pair(transform, "scale", use.scale);
  use.rotation = number(transform, "rotation", 0);
  const Json texture = object_of(looks.textures[static_cast<std::size_t>(use.texture)],
                                 "texture " + std::to_string(use.texture));
  use.image = index_of(texture, "source", looks.images.size(), place);
  if (use.image < 0) return std::nullopt;
  const int sampler_index = index_of(texture, "sampler", looks.samplers.size(), place);
  if (sampler_index < 0) return use;
  const Json sampler = object_of(looks.samplers[static_cast<std::size_t>(sampler_index)],
                                 "sampler " + std::to_string(sampler_index));
  use.wrap_u = wrap_of(number(sampler, "wrapS", 0));
  use.wrap_v = wrap_of(number(sampler, "wrapT", 0));
  use.smooth = number(sampler, "magFilter", 9729) != 9728;
  return use;
}

AlphaUse alpha_of(const Character& character, int index) {
  AlphaUse use;
  const Material* material = material_at(character, index);
  if (!material) return use;
  const Json json = object_of(material->carried, "material " + material->name);
  const auto mode = json.find("alphaMode");
  if (mode != json.end() && *mode == "MASK") use.mode = AlphaMode::mask;
  if (mode != json.end() && *mode == "BLEND") use.mode = AlphaMode::blend;
  use.cutoff = static_cast<float>(number(json, "alphaCutoff", 0.5));
  return use;
}

Texture::Texture(const Character& character, const TextureUse& use) : use_(use) {
  const Image& image = character.appearance.images.at(static_cast<std::size_t>(use.image));
  const std::string name = !image.name.empty()  ? image.name
                           : !image.uri.empty() ? image.uri
                                                : std::to_string(use.image);
  if (image.bytes.empty())
    throw io_error("image " + name, "is not there", "put its file beside the character's");
  try {
    pixels_ = decode_pixels(image.bytes);
  } catch (const Error& error) {
    throw io_error("image " + name, error.what());
  }
}

template <typename Decode>
Eigen::Vector4f Texture::at(const Eigen::Vector2f& uv, const Decode& decode) const {
  // glTF's transform acts with v down: scale, then rotation, then offset.
  const Eigen::Vector2d down(use_.scale[0] * uv[0], use_.scale[1] * (1.0 - uv[1]));
  const double c = std::cos(use_.rotation), s = std::sin(use_.rotation);
  const double u = c * down[0] + s * down[1] + use_.offset[0],
               v = -s * down[0] + c * down[1] + use_.offset[1];
  if (!(std::abs(u) < 1e6) || !(std::abs(v) < 1e6)) return Eigen::Vector4f::Ones();
  const auto pixel = [&](int x, int y) {
    x = wrapped(x, pixels_.width, use_.wrap_u);
    y = wrapped(y, pixels_.height, use_.wrap_v);
    return decode(pixels_.rgba.data() + 4 * (static_cast<std::size_t>(y) * pixels_.width + x));
  };
  // Wrapped before it is multiplied, so that far tiles are as fine as the first.
  const auto near = [](double t, Wrap wrap) {
    return wrap == Wrap::clamp ? std::clamp(t, -1.0, 2.0) : t - 2 * std::floor(t / 2);
  };
  const double x = near(u, use_.wrap_u) * pixels_.width - 0.5,
               y = near(v, use_.wrap_v) * pixels_.height - 0.5;
  if (!use_.smooth) return pixel(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const float right = static_cast<float>(x - left), below = static_cast<float>(y - top);
  return (1 - below) * ((1 - right) * pixel(left, top) + right * pixel(left + 1, top)) +
         below * ((1 - right) * pixel(left, top + 1) + right * pixel(left + 1, top + 1));
}

Eigen::Vector4f Texture::stored(const Eigen::Vector2f& uv) const {
  return at(uv, [](const std::uint8_t* p) {
    return Eigen::Vector4f(Eigen::Vector4f(p[0], p[1], p[2], p[3]) / 255.f);
  });
}

Eigen::Vector4f Texture::linear(const Eigen::Vector2f& uv) const {
  const auto& table = linear_table();
  return at(uv, [&](const std::uint8_t* p) {
    return Eigen::Vector4f(table[p[0]], table[p[1]], table[p[2]], static_cast<float>(p[3]) / 255.f);
  });
}

bool corner_uvs(const Mesh& mesh, int uv_set, int face, std::vector<Eigen::Vector2f>& uvs) {
  uvs.clear();
  if (uv_set < 0 || uv_set >= static_cast<int>(mesh.uvs.size())) return false;
  const UvSet& set = mesh.uvs[static_cast<std::size_t>(uv_set)];
  const auto corners = mesh.faces[static_cast<std::size_t>(face)];
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const int row =
        set.corners.empty()
            ? corners[c]
            : set.corners[static_cast<std::size_t>(mesh.faces.offset(static_cast<std::size_t>(face))) + c];
    if (row < 0 || row >= set.coordinates.rows()) return false;
    uvs.emplace_back(set.coordinates.row(row).transpose());
  }
  return true;
}

}  // namespace mien
