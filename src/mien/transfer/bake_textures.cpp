#include "mien/transfer/bake_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "mien/character/shown_parts.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/texture/retexture.h"
#include "mien/texture/texel_grid.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/bake_places.h"

// The other way round, painting the source's pixels onto the target, leaves holes where the target's layout is finer. Looking
// each pixel up costs a closest point a pixel and leaves none. Colours are mixed in linear light.

namespace mien {
namespace {

using detail::at;
using detail::BakeSurface;
using detail::Place;

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.f, 1.f) * 255));
}

std::uint8_t srgb_byte(float linear) {
  return byte_of(linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f);
}

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

/// Faces of the target that share one image.
struct Sheet {
  int material = -1;  ///< the target's; -1: `part` alone
  int part = -1;
  std::vector<int> triangles;  ///< of the target's surface, all with UVs
  std::vector<LayoutTriangle> layout;
};

class Baker {
 public:
  Baker(const Character& source, const std::vector<Points>& guide, const Character& target,
        const BakeOptions& options)
      : source_(source),
        target_(target),
        options_(options),
        guide_(detail::bake_surface(source, guide)),
        surface_(detail::bake_surface(target, detail::in_model_space(target))),
        finder_(guide_, surface_) {
    result_.character = target;
  }
  BakeResult operator()();

 private:
  std::vector<Sheet> sheets();
  void bake(const Sheet& sheet);
  int most_frequent_material(const std::vector<Place>& places) const;
  const std::optional<Texture>& texture(int material, TextureSlot slot, double density);
  std::optional<Eigen::Vector2f> uv_at(const Place& place, int set) const;
  Pixels paint(const std::vector<Place>& places, TextureSlot slot, double density);
  Eigen::Vector4f color_at(const Place& place, TextureSlot slot, const std::optional<Texture>* texture) const;
  double source_density(int material, const Texture& texture) const;
  void hang(const Sheet& sheet, int material, BakedImage& image,
            const std::vector<std::pair<TextureSlot, int>>& made);
  void warn(std::string what, std::string remedy) {
    result_.warnings.push_back({std::move(what), std::move(remedy)});
  }

  const Character& source_;
  const Character& target_;
  const BakeOptions& options_;
  BakeSurface guide_, surface_;
  detail::PlaceFinder finder_;
  BakeResult result_;
  /// By material, slot and how far they are averaged down.
  std::map<std::tuple<int, TextureSlot, int>, std::optional<Texture>> textures_;
};

/// Groups the target's faces by image, parts without UVs left out.
std::vector<Sheet> Baker::sheets() {
  std::map<std::pair<int, int>, Sheet> found;
  std::vector<char> lacks(target_.parts.size(), 0);
  std::vector<Eigen::Vector2f> uvs;
  for (std::size_t t = 0; t < surface_.part.size(); ++t) {
    const int part = surface_.part[t], material = surface_.material[t];
    if (!corner_uvs(target_.parts[at(part)].mesh, 0, surface_.face[t], uvs)) {
      lacks[at(part)] = 1;
      continue;
    }
    Sheet& sheet = found[{material, material < 0 ? part : -1}];
    sheet.material = material;
    sheet.part = material < 0 ? part : -1;
    sheet.triangles.push_back(static_cast<int>(t));
    LayoutTriangle layout;
    for (std::size_t k = 0; k < 3; ++k) layout.uv[k] = uvs[at(surface_.corners[t][k])].cast<double>();
    sheet.layout.push_back(layout);
  }
  if (found.empty())
    throw invalid_input("target", "has no UVs of its own",
                        "without baking, it takes the source's UVs and image");
  for (std::size_t p = 0; p < lacks.size(); ++p)
    if (lacks[p])
      warn("part " + target_.parts[p].name + " has faces without UVs, which get no image",
           "unwrap them, or let the transfer replace the target's UVs");
  std::vector<Sheet> sheets;
  for (auto& [key, sheet] : found) sheets.push_back(std::move(sheet));
  return sheets;
}

/// Of the source's materials with an image the one that most pixels lie on; -1 when most pixels lie on what has none: eyes
/// over plain eyes keep their own looks, however much skin is near.
int Baker::most_frequent_material(const std::vector<Place>& places) const {
  std::map<int, std::size_t> count;
  std::size_t all = 0, with_image = 0, most = 0;
  for (const Place& place : places) {
    all += place.triangle >= 0;
    if (place.triangle >= 0 && place.facing) ++count[guide_.material[at(place.triangle)]];
  }
  int best = -1;
  for (const auto& [material, pixels] : count) {
    if (!texture_of(source_, material, TextureSlot::base_color)) continue;
    with_image += pixels;
    if (pixels > most) best = material, most = pixels;
  }
  return 2 * with_image > all ? best : -1;
}

std::optional<Eigen::Vector2f> Baker::uv_at(const Place& place, int set) const {
  std::vector<Eigen::Vector2f> uvs;
  const std::size_t t = at(place.triangle);
  if (!corner_uvs(source_.parts[at(guide_.part[t])].mesh, set, guide_.face[t], uvs)) return std::nullopt;
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    uv += place.barycentric[static_cast<int>(k)] * uvs[at(guide_.corners[t][k])];
  return uv;
}

/// Pixels of the source's image along a unit of length on the target.
double Baker::source_density(int material, const Texture& texture) const {
  double pixels = 0, area = 0;
  std::vector<Eigen::Vector2f> uvs;
  for (std::size_t t = 0; t < guide_.material.size(); ++t) {
    if (guide_.material[t] != material ||
        !corner_uvs(source_.parts[at(guide_.part[t])].mesh, texture.use().uv_set, guide_.face[t], uvs))
      continue;
    const auto& c = guide_.corners[t];
    const Eigen::Vector2f a = uvs[at(c[1])] - uvs[at(c[0])], b = uvs[at(c[2])] - uvs[at(c[0])];
    pixels += std::abs(a.x() * b.y() - a.y() * b.x()) * texture.pixels().width * texture.pixels().height;
    const auto corner = [&](int k) {
      return Eigen::Vector3d(guide_.positions.row(guide_.triangles(static_cast<Eigen::Index>(t), k)));
    };
    area += (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  pixels *= std::abs(texture.use().scale[0] * texture.use().scale[1]);
  return area > 0 ? std::sqrt(pixels / area) : 0;
}

/// A source image, averaged down to about `density` pixels a unit of length.
const std::optional<Texture>& Baker::texture(int material, TextureSlot slot, double density) {
  auto& whole = textures_[{material, slot, 0}];
  if (!whole) {
    const auto use = texture_of(source_, material, slot);
    if (!use) return whole;
    whole.emplace(source_, *use);
  }
  const double finer = density > 0 ? source_density(material, *whole) / density : 1;
  if (finer < 1.5) return whole;
  const Pixels& pixels = whole->pixels();
  const int width = std::max(1, static_cast<int>(std::lround(pixels.width / finer)));
  const int height = std::max(1, static_cast<int>(std::lround(pixels.height / finer)));
  auto& small = textures_[{material, slot, width}];
  if (!small) small.emplace(resize_pixels(pixels, width, height), whole->use());
  return small;
}

/// The source's numbers at a place: linear colour with its factor, or stored numbers of other slots.
Eigen::Vector4f Baker::color_at(const Place& place, TextureSlot slot,
                                const std::optional<Texture>* texture) const {
  const int material = guide_.material[at(place.triangle)];
  const bool color = slot == TextureSlot::base_color;
  Eigen::Vector4f value =
      slot == TextureSlot::emissive ? Eigen::Vector4f(0, 0, 0, 1) : Eigen::Vector4f(Eigen::Vector4f::Ones());
  if (texture && *texture)
    if (const auto uv = uv_at(place, (*texture)->use().uv_set))
      value = color ? (*texture)->linear(*uv) : (*texture)->stored(*uv);
  if (color && material >= 0)
    value = value.cwiseProduct(source_.appearance.materials[at(material)].base_color);
  return value;
}

Pixels Baker::paint(const std::vector<Place>& places, TextureSlot slot, double density) {
  std::map<int, const std::optional<Texture>*>
      of_material;  // decoded here, because the loop below runs on all cores
  std::vector<char> known(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    known[i] = places[i].triangle >= 0;
    if (!known[i]) continue;
    const auto [entry, is_new] = of_material.emplace(guide_.material[at(places[i].triangle)], nullptr);
    if (is_new && entry->first >= 0) entry->second = &texture(entry->first, slot, density);
  }
  Pixels pixels{options_.size, options_.size, std::vector<std::uint8_t>(4 * places.size(), 0)};
  for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) pixels.rgba[i] = 255;
  parallel_for(places.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!known[i]) continue;
      const Eigen::Vector4f value =
          color_at(places[i], slot, of_material.at(guide_.material[at(places[i].triangle)]));
      for (int k = 0; k < 3; ++k)
        pixels.rgba[4 * i + k] = slot == TextureSlot::base_color ? srgb_byte(value[k]) : byte_of(value[k]);
      pixels.rgba[4 * i + 3] = byte_of(value[3]);
    }
  });
  grow_colors(pixels, std::move(known), options_.padding);
  return pixels;
}

void Baker::bake(const Sheet& sheet) {
  const TexelGrid grid = rasterize(sheet.layout, options_.size);
  if (grid.covered == 0) return;
  const std::vector<Place> places = finder_.find(grid, sheet.triangles);
  const int material = most_frequent_material(places);
  if (material < 0) return;  // lies on what has no image: keeps its own looks
  double area = 0;
  for (const int t : sheet.triangles) {
    const auto corner = [&](int k) {
      return Eigen::Vector3d(surface_.positions.row(surface_.triangles(t, k)));
    };
    area += (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
  }
  const double density = area > 0 ? std::sqrt(static_cast<double>(grid.covered) / area) : 0;
  BakedImage image;
  image.material = source_.appearance.materials[at(material)].name;
  image.covered = static_cast<double>(grid.covered) / static_cast<double>(places.size());
  image.overlap = static_cast<double>(grid.overlapping) / static_cast<double>(grid.covered);
  const auto doubtful = std::count_if(places.begin(), places.end(),
                                      [](const Place& p) { return p.triangle >= 0 && !p.facing; });
  image.doubtful = static_cast<double>(doubtful) / static_cast<double>(grid.covered);
  std::vector<std::pair<TextureSlot, int>> made;
  for (const TextureSlot slot : {TextureSlot::base_color, TextureSlot::metallic_roughness,
                                 TextureSlot::occlusion, TextureSlot::emissive}) {
    if (!texture_of(source_, material, slot)) continue;
    const std::string name =
        (image.material.empty() ? "baked" : image.material) + "." + std::string(name_of(slot));
    made.emplace_back(slot, add_texture(result_.character.appearance, name,
                                        encode_pixels(paint(places, slot, density)), Wrap::clamp));
    image.slots.emplace_back(name_of(slot));
  }
  hang(sheet, material, image, made);
}

/// Puts a copy of the source's material with the new images on the sheet's faces.
void Baker::hang(const Sheet& sheet, int material, BakedImage& image,
                 const std::vector<std::pair<TextureSlot, int>>& made) {
  Character& character = result_.character;
  Material copied = with_textures(source_.appearance.materials[at(material)], made);
  copied.base_color = Eigen::Vector4f::Ones();
  const int number = static_cast<int>(character.appearance.materials.size());
  character.appearance.materials.push_back(std::move(copied));
  for (std::size_t p = 0; p < shown_part_count(target_); ++p) {
    if (sheet.part >= 0 && sheet.part != static_cast<int>(p)) continue;
    Mesh& mesh = character.parts[p].mesh;
    if (mesh.groups.empty() && sheet.part >= 0)
      mesh.groups.push_back(
          {"", -1, 0, static_cast<int>(mesh.faces.size()), 0, static_cast<int>(mesh.vertex_count())});
    bool any = false;
    for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
      const bool here = g < target_.parts[p].mesh.groups.size()
                            ? target_.parts[p].mesh.groups[g].material == sheet.material
                            : true;
      if (!here || mesh.groups[g].face_begin == mesh.groups[g].face_end) continue;
      mesh.groups[g].material = number;
      any = true;
    }
    if (any) image.parts.push_back(target_.parts[p].name);
  }
  const std::string where =
      "the UVs of " + (sheet.material >= 0
                           ? "material " + target_.appearance.materials[at(sheet.material)].name
                           : "part " + target_.parts[at(sheet.part)].name);
  if (image.overlap > 0.01)
    warn(where + " overlap in " + percent(image.overlap) +
             " of what they cover: there one face paints for all",
         "lay them out side by side, or mirror what looks alike on purpose");
  if (image.doubtful > 0.05)
    warn("for " + percent(image.doubtful) + " of what " + where +
             " cover, nothing of the source faces the same way",
         "look at the picture there; more landmarks help");
  if (texture_of(source_, material, TextureSlot::normal))
    warn("the normal map of material " + image.material +
             " is left behind: its directions belong to the source's own UVs",
         "bake one from a detailed surface of the target");
  result_.images.push_back(std::move(image));
}

BakeResult Baker::operator()() {
  for (const Sheet& sheet : sheets()) bake(sheet);
  if (result_.images.empty())
    throw invalid_input("source", "has no base-colour image where the target has UVs",
                        "give a source whose materials have images");
  return std::move(result_);
}

void check(const Character& source, const std::vector<Points>& guide, const BakeOptions& options) {
  if (guide.size() != source.parts.size())
    throw invalid_input("guide", "has " + std::to_string(guide.size()) + " parts",
                        "the source has " + std::to_string(source.parts.size()));
  for (std::size_t p = 0; p < guide.size(); ++p)
    if (guide[p].rows() != source.parts[p].mesh.positions.rows())
      throw invalid_input("guide of part " + source.parts[p].name,
                          "has " + std::to_string(guide[p].rows()) + " positions",
                          "one a vertex: " + std::to_string(source.parts[p].mesh.positions.rows()));
  if (options.size < 16 || options.size > max_image_side / 2)
    throw invalid_input("size", "is " + std::to_string(options.size),
                        "give 16 to " + std::to_string(max_image_side / 2) + " pixels");
  if (options.padding < 0 || options.padding > options.size)
    throw invalid_input("padding", "is " + std::to_string(options.padding), "give 0 to the image's size");
  const int materials = static_cast<int>(source.appearance.materials.size());
  for (int m = 0; m < materials; ++m)
    if (texture_of(source, m, TextureSlot::base_color)) return;
  throw invalid_input("source", "has no base-colour image", "give a source whose materials have images");
}

}  // namespace

BakeResult bake_textures(const Character& source, const std::vector<Points>& guide, const Character& target,
                         const BakeOptions& options) {
  check(source, guide, options);
  return Baker(source, guide, target, options)();
}

}  // namespace mien
