#include "mien/sample/detail/paint_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mien/sample/detail/smooth_step.h"
#include "mien/texture/retexture.h"
#include "mien/texture/texel_grid.h"

// Colours are painted in space, at the point of the skin under each pixel, so that seams of the layout do not show. The image
// holds factors of at most one of the materials' base colours: whoever draws no images sees the plain colours.

namespace mien::sample {
namespace {

constexpr int image_size = 512;

/// A number in [0, 1) for a cell of space.
double hash(const Eigen::Vector3i& cell) {
  std::uint32_t h = 2166136261u;
  for (int k = 0; k < 3; ++k) h = (h ^ static_cast<std::uint32_t>(cell[k] + 1000)) * 16777619u;
  h ^= h >> 15;
  h *= 2246822519u;
  return static_cast<double>((h ^ (h >> 13)) >> 8) / (1 << 24);
}

double distance_to(const Eigen::Vector3d& p, const std::vector<Eigen::Vector3d>& line) {
  double least = 1e30;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector3d along = line[i + 1] - line[i];
    const double t = std::clamp(along.dot(p - line[i]) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
    least = std::min(least, (line[i] + t * along - p).norm());
  }
  return least;
}

class SkinPainter {
 public:
  SkinPainter(const BuiltCharacter& built, const CharacterForm& form)
      : face_(built.character.parts[face_part].mesh), form_(form) {
    for (int i = 0; i < 5; ++i) {
      brow_right_.push_back(landmark(built.character, 18 + i));
      brow_left_.push_back(landmark(built.character, 23 + i));
    }
    for (int i = 0; i < 12; ++i) lips_.push_back(landmark(built.character, 49 + i));
    lips_.push_back(lips_.front());
    nose_ = landmark(built.character, 31);
    const auto& materials = built.character.appearance.materials;
    for (int k = 0; k < 3; ++k)
      lip_of_skin_[k] = std::min(
          1.0, double(materials[lip_material].base_color[k]) / materials[skin_material].base_color[k]);
  }

  /// Factors of the base colour at a point of a group's face, linear.
  Eigen::Vector3d color(const Eigen::Vector3d& p, int material) const {
    if (material != skin_material) return Eigen::Vector3d::Ones();
    const Eigen::Vector3d& eye = form_.head.eye.centre;
    const MouthForm& mouth = form_.head.mouth;
    const Eigen::Vector3d left(std::abs(p.x()), p.y(), p.z());
    Eigen::Vector3d result = Eigen::Vector3d::Ones();
    const auto mix = [&](const Eigen::Vector3d& factor, double share) {
      result = result.cwiseProduct(Eigen::Vector3d::Ones() + share * (factor - Eigen::Vector3d::Ones()));
    };
    const Eigen::Vector3d cheek(1.35 * eye.x(), 0.45 * eye.y() + 0.55 * mouth.line, mouth.front - 2);
    mix({1, 0.62, 0.58}, 0.5 * soft(left, cheek, {3.2, 2.6, 5}));
    mix({1, 0.68, 0.64}, 0.7 * soft(p, nose_, {1.6, 1.4, 2}));
    const double brow = std::min(distance_to(p, brow_left_), distance_to(p, brow_right_));
    mix({0.22, 0.16, 0.13}, 0.85 * (1 - smooth_step(0.12, 0.5, brow)));
    mix(lip_of_skin_, 1 - smooth_step(0.02, 0.3, distance_to(p, lips_)));
    const double hairline = p.y() - (brow_left_[2].y() + 4.6) + 0.55 * std::max(0.0, 4 - p.z());
    mix({0.3, 0.24, 0.2},
        0.75 * smooth_step(-0.3, 0.9, hairline + 0.5 * hash((p * 9).array().floor().cast<int>())));
    mix({0.72, 0.55, 0.45}, freckle(p) * soft(left, cheek, {4, 3, 6}));
    return result;
  }

 private:
  Eigen::Vector3d landmark(const Character& character, int number) const {
    const std::string name = "ibug_" + std::to_string(number);
    for (const Landmark& one : character.landmarks)
      if (one.name == name) return position_of(face_, face_.positions, one.at);
    return Eigen::Vector3d::Zero();
  }

  /// Dots of a millimetre in some cells of a grid.
  static double freckle(const Eigen::Vector3d& p) {
    constexpr double cell = 0.45;
    const Eigen::Vector3i at = (p / cell).array().floor().cast<int>();
    double most = 0;
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i c = at + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (hash(c) > 0.3) continue;
      const Eigen::Vector3d centre =
          cell * (c.cast<double>() + Eigen::Vector3d(hash(c + Eigen::Vector3i(7, 0, 0)),
                                                     hash(c + Eigen::Vector3i(0, 7, 0)),
                                                     hash(c + Eigen::Vector3i(0, 0, 7))));
      most = std::max(most, 1 - smooth_step(0.04, 0.11, (p - centre).norm()));
    }
    return most;
  }

  const Mesh& face_;
  const CharacterForm& form_;
  std::vector<Eigen::Vector3d> brow_left_, brow_right_, lips_;
  Eigen::Vector3d nose_ = Eigen::Vector3d::Zero(), lip_of_skin_ = Eigen::Vector3d::Ones();
};

std::uint8_t srgb_byte(double linear) {
  const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
}

/// The fan triangles of the face: layout, corners and material.
struct SkinTriangles {
  std::vector<LayoutTriangle> layout;
  std::vector<std::array<int, 3>> vertices;
  std::vector<int> material;
};

SkinTriangles skin_triangles(const Mesh& mesh) {
  SkinTriangles result;
  std::vector<Eigen::Vector2f> uvs;
  for (const FaceGroup& group : mesh.groups)
    for (int f = group.face_begin; f < group.face_end; ++f) {
      if (!corner_uvs(mesh, 0, f, uvs)) continue;
      const auto face = mesh.faces[f];
      for (std::size_t c = 2; c < face.size(); ++c) {
        result.layout.push_back({{uvs[0].cast<double>(), uvs[c - 1].cast<double>(), uvs[c].cast<double>()}});
        result.vertices.push_back({face[0], face[c - 1], face[c]});
        result.material.push_back(group.material);
      }
    }
  return result;
}

}  // namespace

void paint_skin(BuiltCharacter& built, const CharacterForm& form) {
  const Mesh& mesh = built.character.parts[face_part].mesh;
  const SkinTriangles triangles = skin_triangles(mesh);
  const TexelGrid grid = rasterize(triangles.layout, image_size);
  const SkinPainter painter(built, form);
  Pixels image{image_size, image_size, std::vector<std::uint8_t>(4 * grid.triangle.size(), 255)};
  std::vector<char> known(grid.triangle.size(), 0);
  for (std::size_t i = 0; i < grid.triangle.size(); ++i) {
    const int t = grid.triangle[i];
    known[i] = t >= 0;
    if (t < 0) continue;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      p += grid.barycentric[i][k] * mesh.positions.row(triangles.vertices[t][k]).transpose().cast<double>();
    const Eigen::Vector3d color = painter.color(p, triangles.material[t]);
    for (int k = 0; k < 3; ++k) image.rgba[4 * i + k] = srgb_byte(color[k]);
  }
  grow_colors(image, std::move(known), image_size / 32);
  Appearance& looks = built.character.appearance;
  const int texture = add_texture(looks, "face", encode_pixels(image), Wrap::clamp);
  for (const int material : {skin_material, lip_material, mouth_material})
    looks.materials[material] =
        with_textures(looks.materials[material], {{TextureSlot::base_color, texture}});
}

}  // namespace mien::sample
