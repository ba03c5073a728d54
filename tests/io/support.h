#pragma once
/// What the tests of io share: a folder that goes away, small characters and glTF texts made in code, comparison.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/core/error.h"
#include "mien/io/file.h"

namespace mien::test {

/// A folder of its own for one test, removed at its end.
class Folder {
 public:
  Folder() {
    static int counter = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("mien_io_" + std::to_string(::getpid()) + "_" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    write_file_atomically(path_ / name, text);
    return path_ / name;
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path path_;
};

/// The text of the Error that `action` throws, without the file's folder; empty when it throws none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    std::string text = error.what();
    const std::size_t slash = text.find_last_of('/', text.find(": "));
    return slash == text.npos ? text : text.substr(slash + 1);
  }
  return {};
}

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A .gltf in the making: numbers go into one data: URI.
class GltfText {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> bytes;

  template <typename Number>
  int view(const std::vector<Number>& numbers, int stride = 0) {
    while (bytes.size() % 4) bytes.push_back(0);
    nlohmann::json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", numbers.size() * sizeof(Number)}};
    if (stride > 0) view["byteStride"] = stride;
    const auto* first = reinterpret_cast<const std::uint8_t*>(numbers.data());
    bytes.insert(bytes.end(), first, first + numbers.size() * sizeof(Number));
    root["bufferViews"].push_back(view);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  int accessor(int view, int component, const char* type, std::size_t count) {
    nlohmann::json accessor = {{"componentType", component}, {"type", type}, {"count", count}};
    if (view >= 0) accessor["bufferView"] = view;
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }
  int floats(const std::vector<float>& numbers, const char* type, int columns) {
    return accessor(view(numbers), 5126, type, numbers.size() / columns);
  }
  int shorts(const std::vector<std::uint16_t>& numbers) {
    return accessor(view(numbers), 5123, "SCALAR", numbers.size());
  }
  /// One triangle mesh in one node: a quad of four vertices in the plane z = 0.
  void add_quad() {
    const int positions = floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
    const int indices = shorts({0, 1, 2, 0, 2, 3});
    root["meshes"] = {{{"name", "quad"},
                       {"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
    root["nodes"] = {{{"name", "face"}, {"mesh", 0}}};
  }
  nlohmann::json& primitive(int mesh = 0) { return root["meshes"][mesh]["primitives"][0]; }
  std::string text() const {
    nlohmann::json all = root;
    all["buffers"] = {
        {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return all.dump();
  }
};

/// glTF counts v from above: 1 - v, which rounds at 2^-25 for small v.
inline void expect_same_uvs(const std::vector<UvSet>& a, const std::vector<UvSet>& b, float tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t set = 0; set < a.size(); ++set) {
    EXPECT_EQ(a[set].corners, b[set].corners);
    ASSERT_EQ(a[set].coordinates.rows(), b[set].coordinates.rows());
    EXPECT_LE((a[set].coordinates - b[set].coordinates).cwiseAbs().maxCoeff(), tolerance);
  }
}

inline void expect_same_mesh(const Mesh& a, const Mesh& b, float uv_tolerance = 0) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_TRUE(a.normals.rows() == b.normals.rows() && a.normals == b.normals) << "normals";
  EXPECT_TRUE(a.tangents.rows() == b.tangents.rows() && a.tangents == b.tangents) << "tangents";
  expect_same_uvs(a.uvs, b.uvs, uv_tolerance);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.groups, b.groups);
  EXPECT_EQ(a.attributes, b.attributes);
  EXPECT_EQ(a.loose, b.loose);
}

inline void expect_same_shapes(const Character& a, const Character& b) {
  EXPECT_EQ(a.sliders, b.sliders);
  EXPECT_EQ(a.correctives, b.correctives);
  EXPECT_EQ(a.expressions, b.expressions);
  ASSERT_EQ(a.shapes.size(), b.shapes.size());
  for (std::size_t s = 0; s < a.shapes.size(); ++s) {
    SCOPED_TRACE("shape " + a.shapes[s].name);
    EXPECT_EQ(a.shapes[s].name, b.shapes[s].name);
    ASSERT_EQ(a.shapes[s].parts.size(), b.shapes[s].parts.size());
    for (std::size_t p = 0; p < a.shapes[s].parts.size(); ++p) {
      const PartDelta &da = a.shapes[s].parts[p], &db = b.shapes[s].parts[p];
      EXPECT_EQ(da.part, db.part);
      EXPECT_EQ(da.vertices, db.vertices);
      EXPECT_EQ(da.deltas, db.deltas);
      EXPECT_EQ(da.normal_deltas.rows(), db.normal_deltas.rows());
      EXPECT_TRUE(da.normal_deltas.rows() != db.normal_deltas.rows() || da.normal_deltas == db.normal_deltas);
    }
  }
}

inline void expect_same_clips(const Character& a, const Character& b) {
  ASSERT_EQ(a.clips.size(), b.clips.size());
  for (std::size_t c = 0; c < a.clips.size(); ++c) {
    EXPECT_EQ(a.clips[c].name, b.clips[c].name);
    EXPECT_EQ(a.clips[c].carried, b.clips[c].carried);
    ASSERT_EQ(a.clips[c].channels.size(), b.clips[c].channels.size());
    for (std::size_t k = 0; k < a.clips[c].channels.size(); ++k) {
      const Channel &ca = a.clips[c].channels[k], &cb = b.clips[c].channels[k];
      EXPECT_EQ(ca.property, cb.property);
      EXPECT_EQ(ca.node, cb.node);
      EXPECT_EQ(ca.shape, cb.shape);
      EXPECT_EQ(ca.part, cb.part);
      EXPECT_EQ(ca.slider, cb.slider);
      EXPECT_EQ(ca.interpolation, cb.interpolation);
      EXPECT_EQ(ca.times, cb.times);
      EXPECT_EQ(ca.values, cb.values);
    }
  }
}

inline void expect_same_point(const SurfacePoint& a, const SurfacePoint& b) {
  EXPECT_EQ(a.part, b.part);
  EXPECT_EQ(a.face, b.face);
  EXPECT_EQ(a.vertex, b.vertex);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.barycentric, b.barycentric);
}

/// Everything but what a file adds by itself.
inline void expect_same(const Character& a, const Character& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t n = 0; n < a.nodes.size(); ++n) {
    EXPECT_EQ(a.nodes[n].name, b.nodes[n].name);
    EXPECT_EQ(a.nodes[n].parent, b.nodes[n].parent);
    EXPECT_EQ(a.nodes[n].rest.matrix(), b.nodes[n].rest.matrix());
    EXPECT_EQ(a.nodes[n].has_matrix, b.nodes[n].has_matrix);
    EXPECT_EQ(a.nodes[n].carried, b.nodes[n].carried);
  }
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t p = 0; p < a.parts.size(); ++p) {
    SCOPED_TRACE("part " + a.parts[p].name);
    EXPECT_EQ(a.parts[p].name, b.parts[p].name);
    EXPECT_EQ(a.parts[p].mesh_name, b.parts[p].mesh_name);
    EXPECT_EQ(a.parts[p].node, b.parts[p].node);
    EXPECT_EQ(a.parts[p].skin, b.parts[p].skin);
    EXPECT_EQ(a.parts[p].shown, b.parts[p].shown);
    EXPECT_EQ(a.parts[p].carried, b.parts[p].carried);
    EXPECT_EQ(a.parts[p].skin_weights, b.parts[p].skin_weights);
    expect_same_mesh(a.parts[p].mesh, b.parts[p].mesh);
  }
  ASSERT_EQ(a.skins.size(), b.skins.size());
  for (std::size_t s = 0; s < a.skins.size(); ++s) {
    EXPECT_EQ(a.skins[s].joints, b.skins[s].joints);
    EXPECT_EQ(a.skins[s].inverse_bind, b.skins[s].inverse_bind);
    EXPECT_EQ(a.skins[s].method, b.skins[s].method);
    EXPECT_EQ(a.skins[s].has_inverse_bind, b.skins[s].has_inverse_bind);
    EXPECT_EQ(a.skins[s].skeleton, b.skins[s].skeleton);
  }
  expect_same_shapes(a, b);
  expect_same_clips(a, b);
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t l = 0; l < a.landmarks.size(); ++l) {
    EXPECT_EQ(a.landmarks[l].name, b.landmarks[l].name);
    expect_same_point(a.landmarks[l].at, b.landmarks[l].at);
  }
  ASSERT_EQ(a.curves.size(), b.curves.size());
  for (std::size_t c = 0; c < a.curves.size(); ++c) {
    EXPECT_EQ(a.curves[c].name, b.curves[c].name);
    EXPECT_EQ(a.curves[c].count, b.curves[c].count);
    ASSERT_EQ(a.curves[c].points.size(), b.curves[c].points.size());
    for (std::size_t k = 0; k < a.curves[c].points.size(); ++k)
      expect_same_point(a.curves[c].points[k], b.curves[c].points[k]);
  }
  ASSERT_EQ(a.appearance.materials.size(), b.appearance.materials.size());
  for (std::size_t m = 0; m < a.appearance.materials.size(); ++m)
    EXPECT_EQ(a.appearance.materials[m].name, b.appearance.materials[m].name);
  ASSERT_EQ(a.appearance.images.size(), b.appearance.images.size());
  for (std::size_t i = 0; i < a.appearance.images.size(); ++i)
    EXPECT_EQ(a.appearance.images[i].bytes, b.appearance.images[i].bytes);
  EXPECT_EQ(a.appearance.textures, b.appearance.textures);
  EXPECT_EQ(a.appearance.samplers, b.appearance.samplers);
}

inline GltfText one_quad() {
  GltfText gltf;
  gltf.add_quad();
  return gltf;
}

}  // namespace mien::test
