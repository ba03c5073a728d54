#include "mien/picture/detail/looks.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

enum class Stuff { hidden, lash, hair, skin, iris, eye, teeth, gum };

struct Token {
  const char* text;
  Stuff stuff;
};

/// Looked for in this order: "eyelash" is hair before "eye" is an eye.
constexpr std::array<Token, 22> tokens{
    {{"occlusion", Stuff::hidden}, {"lacrimal", Stuff::hidden}, {"tearline", Stuff::hidden},
     {"eyeblend", Stuff::hidden},  {"cornea", Stuff::hidden},   {"lash", Stuff::lash},
     {"brow", Stuff::hair},        {"hair", Stuff::hair},       {"eyelid", Stuff::skin},
     {"socket", Stuff::skin},      {"iris", Stuff::iris},       {"pupil", Stuff::iris},
     {"sclera", Stuff::eye},       {"eye", Stuff::eye},         {"teeth", Stuff::teeth},
     {"tooth", Stuff::teeth},      {"gum", Stuff::gum},         {"tongue", Stuff::gum},
     {"cavity", Stuff::gum},       {"skin", Stuff::skin},       {"face", Stuff::skin},
     {"head", Stuff::skin}}};

std::optional<Stuff> stuff_of_name(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const Token& token : tokens)
    if (name.find(token.text) != std::string::npos) return token.stuff;
  return std::nullopt;
}

/// The first name that says something; but lashes named so anywhere are lashes, of whatever material.
Stuff stuff_of_names(const std::array<std::string, 4>& names) {
  Stuff first = Stuff::skin;
  bool found = false;
  for (const std::string& name : names) {
    const auto stuff = stuff_of_name(name);
    if (stuff == Stuff::lash) return Stuff::lash;
    if (stuff && !found) first = *stuff;
    found = found || stuff;
  }
  return first;
}

Look look_of(Stuff stuff) {
  switch (stuff) {
    case Stuff::hidden:
      return {.visible = false};
    case Stuff::lash:
      return {.albedo = {0.035f, 0.025f, 0.02f}, .gloss = 0, .thin = true, .two_sided = true};
    case Stuff::hair:
      return {.albedo = {0.05f, 0.035f, 0.025f}, .gloss = 0.04f, .two_sided = true};
    case Stuff::iris:
      return {.albedo = {0.05f, 0.035f, 0.025f}, .gloss = 0.5f, .sharpness = 250};
    case Stuff::eye:
      return {.albedo = {0.74f, 0.72f, 0.70f}, .gloss = 0.45f, .sharpness = 250};
    case Stuff::teeth:
      return {.albedo = {0.72f, 0.66f, 0.55f}, .gloss = 0.2f, .sharpness = 60};
    case Stuff::gum:
      return {.albedo = {0.45f, 0.12f, 0.11f}, .gloss = 0.15f, .sharpness = 40};
    case Stuff::skin:
      break;
  }
  return {};
}

/// A colour that says nothing: the default grey, or white under a texture that is not drawn.
bool says_nothing(const Eigen::Vector4f& color) {
  const float spread = color.head<3>().maxCoeff() - color.head<3>().minCoeff();
  return spread < 1e-4f && color[0] > 0.4f;
}

/// The base-colour image of a material, decoded when it is first asked for; -1: none, or a broken one.
int texture_of_material(const Character& character, int material, Paint& paint) {
  const auto known = paint.texture_of_material.find(material);
  if (known != paint.texture_of_material.end()) return known->second;
  int& texture = paint.texture_of_material[material] = -1;
  try {
    if (const auto use = texture_of(character, material, TextureSlot::base_color)) {
      paint.textures.emplace_back(character, *use);
      texture = static_cast<int>(paint.textures.size()) - 1;
    }
  } catch (const Error& error) {
    paint.warnings.push_back(std::string(error.what()) + "; its material keeps its base colour");
  }
  return texture;
}

/// Turns a look by names into one by images and vertex colours where the character has them.
void apply_paint(const Character& character, const Part& part, int material, Paint& paint, Look& look) {
  const int texture = material >= 0 ? texture_of_material(character, material, paint) : -1;
  const bool has_uvs =
      texture >= 0 && paint.textures[texture].use().uv_set < static_cast<int>(part.mesh.uvs.size());
  look.painted = !part.mesh.colors.empty() && part.mesh.colors[0].rows() == part.mesh.positions.rows();
  if (!has_uvs && !look.painted) return;
  look.albedo = Eigen::Vector3f::Ones();
  if (material >= 0) {
    const Eigen::Vector4f& factor = character.appearance.materials[material].base_color;
    if (factor.allFinite()) look.albedo = factor.head<3>().cwiseMax(0.f).cwiseMin(1.f);
  }
  if (!has_uvs) return;
  look.texture = texture;
  look.alpha = alpha_of(character, material);
}

Look look_of_group(const Character& character, const Part& part, const FaceGroup& group, Paint* paint) {
  const auto& materials = character.appearance.materials;
  const bool has_material = group.material >= 0 && group.material < static_cast<int>(materials.size());
  const std::string material = has_material ? materials[group.material].name : std::string();
  Look look = look_of(stuff_of_names({material, group.name, part.name, part.mesh_name}));
  if (has_material && look.visible) {
    const Eigen::Vector4f& color = materials[group.material].base_color;
    if (color[3] < 0.1f) look.visible = false;
    if (!says_nothing(color) && color.allFinite()) look.albedo = color.head<3>().cwiseMax(0.f).cwiseMin(1.f);
  }
  if (paint && look.visible) apply_paint(character, part, has_material ? group.material : -1, *paint, look);
  return look;
}

float linear(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

std::vector<Look> looks_of_part(const Character& character, const Part& part, Paint* paint) {
  const Look whole = look_of_group(character, part, {}, paint);
  std::vector<Look> looks(part.mesh.faces.size(), whole);
  for (const FaceGroup& group : part.mesh.groups) {
    const Look look = look_of_group(character, part, group, paint);
    const int end = std::min(group.face_end, static_cast<int>(looks.size()));
    for (int f = std::max(group.face_begin, 0); f < end; ++f) looks[f] = look;
  }
  return looks;
}

Eigen::Vector3f linear_of(Color color) {
  return {linear(color.r), linear(color.g), linear(color.b)};
}

}  // namespace mien::detail
