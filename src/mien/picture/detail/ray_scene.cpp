#include "mien/picture/detail/ray_scene.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "mien/character/weld.h"
#include "mien/core/error.h"

namespace mien::detail {
namespace {

std::uint16_t index_of(const Look& look, std::vector<Look>& looks) {
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (looks[i] == look) return static_cast<std::uint16_t>(i);
  if (looks.size() >= std::numeric_limits<std::uint16_t>::max()) return 0;
  looks.push_back(look);
  return static_cast<std::uint16_t>(looks.size() - 1);
}

/// Sides of fan triangle `c` (corners 0, c - 1, c) that are edges of the polygon and not its diagonals.
std::uint8_t polygon_sides(std::size_t c, std::size_t corners) {
  return static_cast<std::uint8_t>(1 | (c + 1 == corners ? 2 : 0) | (c == 2 ? 4 : 0));
}

void check_face(std::span<const int> face, const Part& part) {
  for (const int v : face)
    if (v < 0 || static_cast<std::size_t>(v) >= part.mesh.vertex_count())
      throw invalid_input(
          "part " + part.name, "has a face that names vertex " + std::to_string(v),
          "vertices from 0 to " + std::to_string(static_cast<int>(part.mesh.vertex_count()) - 1));
}

/// Whether light passes somewhere on a triangle, as far as its corners and a few points inside show.
bool is_cut_out(const Texture& texture, const CornerUvs& uvs) {
  static const std::array<Eigen::Vector3f, 7> places{
      Eigen::Vector3f(1, 0, 0),          Eigen::Vector3f(0, 1, 0),       Eigen::Vector3f(0, 0, 1),
      Eigen::Vector3f(.34f, .33f, .33f), Eigen::Vector3f(.6f, .2f, .2f), Eigen::Vector3f(.2f, .6f, .2f),
      Eigen::Vector3f(.2f, .2f, .6f)};
  return std::any_of(places.begin(), places.end(), [&](const Eigen::Vector3f& at) {
    return texture.linear(at[0] * uvs[0] + at[1] * uvs[1] + at[2] * uvs[2])[3] < 0.98f;
  });
}

/// The look of one triangle: what its image cuts out of it casts no shadow; a corner without a UV has no image.
Look look_of_triangle(Look look, const Paint& paint, const CornerUvs* uvs) {
  if (look.texture < 0) return look;
  if (!uvs) look.texture = -1;
  if (uvs && look.alpha.mode != AlphaMode::opaque) {
    look.thin = is_cut_out(paint.textures[look.texture], *uvs);
    look.two_sided = look.two_sided || look.thin;
    if (!look.thin) look.alpha = {};
  }
  return look;
}

SoupPart make_part(const Character& character, int p, bool painted, Soup& soup) {
  const Part& part = character.parts[p];
  const Faces& faces = part.mesh.faces;
  const Weld weld = weld_seams(character, p);
  const std::vector<Look> look_of_face = looks_of_part(character, part, painted ? &soup.paint : nullptr);
  SoupPart made{weld.of, weld.representative, triangulate(weld_faces(faces, weld)), {}, {}, {}, {}, {}};
  if (painted && !part.mesh.colors.empty()) made.colors = part.mesh.colors[0].leftCols<3>();
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Eigen::Vector3i> drawn;
  for (std::size_t f = 0; part.shown && f < faces.size(); ++f) {
    const auto face = faces[f];
    check_face(face, part);
    const Look& look = look_of_face[f];
    if (!look.visible) continue;
    const bool has_uvs =
        look.texture >= 0 &&
        corner_uvs(part.mesh, soup.paint.textures[look.texture].use().uv_set, static_cast<int>(f), uvs);
    for (std::size_t c = 2; c < face.size(); ++c) {
      drawn.emplace_back(face[0], face[c - 1], face[c]);
      const CornerUvs at =
          has_uvs ? CornerUvs{uvs[0], uvs[c - 1], uvs[c]}
                  : CornerUvs{Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()};
      made.looks.push_back(index_of(look_of_triangle(look, soup.paint, has_uvs ? &at : nullptr), soup.looks));
      made.edges.push_back(polygon_sides(c, face.size()));
      made.uvs.push_back(at);
    }
  }
  made.triangles.resize(static_cast<Eigen::Index>(drawn.size()), 3);
  for (std::size_t t = 0; t < drawn.size(); ++t) made.triangles.row(static_cast<Eigen::Index>(t)) = drawn[t];
  return made;
}

/// Smooth over seams: the copies of a vertex share one normal.
Points smooth_normals(const SoupPart& part, const Points& posed) {
  Points welded(static_cast<Eigen::Index>(part.first.size()), 3);
  for (std::size_t w = 0; w < part.first.size(); ++w)
    welded.row(static_cast<Eigen::Index>(w)) = posed.row(part.first[w]);
  const Points normals = vertex_normals(welded, part.welded_triangles);
  return normals(part.welded, Eigen::all);
}

bool has_values(const VertexMap* map, std::size_t part) {
  return map && part < map->values.size() && map->values[part].size() > 0;
}

}  // namespace

Soup make_soup(const Character& character, bool painted) {
  Soup soup;
  for (std::size_t p = 0; p < character.parts.size(); ++p)
    soup.parts.push_back(make_part(character, static_cast<int>(p), painted, soup));
  return soup;
}

RayScene::RayScene(const Soup& soup, const std::vector<Points>& posed, const VertexMap* map) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (std::size_t p = 0; p < posed.size(); ++p) {
    if (soup.parts[p].triangles.rows() == 0) continue;
    const Box box = bounding_box(posed[p]);
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }
  if (!(low.x() <= high.x())) throw invalid_input("picture", "shows no faces", "a part with visible faces");
  centre = (low + high) / 2;
  size = std::max((high - low).norm(), 1e-30);
  for (std::size_t p = 0; p < posed.size(); ++p)
    add_vertices(soup.parts[p], posed[p], has_values(map, p) ? &map->values[p] : nullptr);
  add_triangles(soup, map, false);
  solid_count_ = static_cast<int>(triangles.size());
  add_triangles(soup, map, true);
  build();
}

RayScene::~RayScene() {
  if (all_) rtcReleaseScene(all_);
  if (solid_) rtcReleaseScene(solid_);
  if (device_) rtcReleaseDevice(device_);
}

void RayScene::add_vertices(const SoupPart& part, const Points& posed, const Eigen::VectorXf* part_values) {
  const Points part_normals = smooth_normals(part, posed);
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    positions.emplace_back(((posed.row(v).cast<double>().transpose() - centre) / size).cast<float>());
    normals.emplace_back(part_normals.row(v));
    values.push_back(part_values ? (*part_values)[v] : 0.f);
    colors.push_back(v < part.colors.rows() ? Eigen::Vector3f(part.colors.row(v)) : Eigen::Vector3f::Ones());
  }
}

void RayScene::add_triangles(const Soup& soup, const VertexMap* map, bool thin) {
  int base = 0;
  for (std::size_t p = 0; p < soup.parts.size(); ++p) {
    const SoupPart& part = soup.parts[p];
    for (std::size_t t = 0; t < part.looks.size(); ++t) {
      if (soup.looks[part.looks[t]].thin != thin) continue;
      triangles.emplace_back(part.triangles.row(static_cast<Eigen::Index>(t)).array() + base);
      looks.push_back(part.looks[t]);
      edges.push_back(part.edges[t]);
      uvs.push_back(part.uvs[t]);
      mapped.push_back(has_values(map, p));
    }
    base += static_cast<int>(part.welded.size());
  }
}

RTCGeometry RayScene::make_geometry(std::size_t begin, std::size_t end) const {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), end - begin));
  if (!vertices || !indices) throw invalid_input("picture", "has too many faces to fit into memory");
  for (std::size_t v = 0; v < positions.size(); ++v)
    for (int k = 0; k < 3; ++k) vertices[3 * v + k] = positions[v][k];
  for (std::size_t t = begin; t < end; ++t)
    for (int k = 0; k < 3; ++k) indices[3 * (t - begin) + k] = static_cast<unsigned>(triangles[t][k]);
  rtcCommitGeometry(geometry);
  return geometry;
}

void RayScene::build() {
  device_ = rtcNewDevice(nullptr);
  all_ = rtcNewScene(device_);
  solid_ = rtcNewScene(device_);
  const auto solid_count = static_cast<std::size_t>(solid_count_);
  const auto attach = [&](std::size_t begin, std::size_t end, unsigned id,
                          std::initializer_list<RTCScene> scenes) {
    if (begin == end) return;
    RTCGeometry geometry = make_geometry(begin, end);
    for (RTCScene scene : scenes) rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  };
  attach(0, solid_count, 0, {solid_, all_});
  attach(solid_count, triangles.size(), 1, {all_});
  for (RTCScene scene : {solid_, all_}) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
  }
}

}  // namespace mien::detail
