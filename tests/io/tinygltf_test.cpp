// Another reader's word on the files: tinygltf, where it is installed.

#include <gtest/gtest.h>

#ifdef MIEN_TINYGLTF
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "full_character.h"
#include "mien/io/load.h"
#include "support.h"

namespace mien {
namespace {

/// Numbers of an accessor; tinygltf leaves the sparse ones to its caller.
class Numbers {
 public:
  explicit Numbers(const tinygltf::Model& model) : model_(model) {}

  std::vector<double> operator()(int index) const {
    const tinygltf::Accessor& accessor = model_.accessors.at(static_cast<std::size_t>(index));
    const int columns = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    std::vector<double> values(accessor.count * static_cast<std::size_t>(columns), 0.0);
    if (accessor.bufferView >= 0)
      for (std::size_t r = 0; r < accessor.count; ++r)
        read(accessor.bufferView, accessor.byteOffset, r, accessor.componentType, columns,
             accessor.normalized, values.data() + r * columns);
    const auto& sparse = accessor.sparse;
    for (int k = 0; accessor.sparse.isSparse && k < sparse.count; ++k) {
      double row = 0;
      const auto at = static_cast<std::size_t>(k);
      read(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), at,
           sparse.indices.componentType, 1, false, &row);
      read(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), at,
           accessor.componentType, columns, accessor.normalized,
           values.data() + static_cast<std::size_t>(row) * columns);
    }
    return values;
  }

 private:
  void read(int view_index, std::size_t offset, std::size_t row, int type, int columns, bool normalized,
            double* to) const {
    const tinygltf::BufferView& view = model_.bufferViews.at(static_cast<std::size_t>(view_index));
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    const std::size_t stride = view.byteStride ? view.byteStride : static_cast<std::size_t>(size * columns);
    const unsigned char* from = model_.buffers.at(static_cast<std::size_t>(view.buffer)).data.data() +
                                view.byteOffset + offset + row * stride;
    for (int c = 0; c < columns; ++c, from += size) to[c] = number(from, type, normalized);
  }

  template <typename Stored>
  static double stored(const unsigned char* from, bool normalized) {
    Stored value;
    std::memcpy(&value, from, sizeof value);
    const double whole = static_cast<double>(value);
    return normalized ? std::max(whole / static_cast<double>(std::numeric_limits<Stored>::max()), -1.0)
                      : whole;
  }
  static double number(const unsigned char* from, int type, bool normalized) {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return stored<std::int8_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return stored<std::uint8_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return stored<std::int16_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return stored<std::uint16_t>(from, normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return stored<std::uint32_t>(from, normalized);
      default:
        return stored<float>(from, false);
    }
  }

  const tinygltf::Model& model_;
};

tinygltf::Model read_by_tinygltf(const std::filesystem::path& path) {
  tinygltf::TinyGLTF reader;
  // Images are not its concern here.
  reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*,
                           int, void*) { return true; },
                        nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const bool binary = path.extension() == ".glb";
  const bool read = binary ? reader.LoadBinaryFromFile(&model, &error, &warning, path.string())
                           : reader.LoadASCIIFromFile(&model, &error, &warning, path.string());
  EXPECT_TRUE(read) << error;
  return model;
}

template <typename Rows>
void expect_rows(const std::vector<double>& theirs, const Rows& ours, const char* what) {
  ASSERT_EQ(theirs.size(), static_cast<std::size_t>(ours.size())) << what;
  for (std::size_t i = 0; i < theirs.size(); ++i)
    ASSERT_EQ(static_cast<float>(theirs[i]), static_cast<float>(ours.data()[i])) << what << " " << i;
}

/// Vertices, faces and targets of a mesh whose primitives follow one another.
void expect_same_mesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh, const Character& c,
                      int part) {
  const Numbers numbers(model);
  std::map<int, int> first_of;  // by POSITION accessor
  std::vector<double> positions, corners;
  std::vector<std::vector<double>> targets;
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    const int accessor = primitive.attributes.at("POSITION");
    const auto [first, is_new] = first_of.emplace(accessor, static_cast<int>(positions.size() / 3));
    if (is_new) {
      const std::vector<double> rows = numbers(accessor);
      positions.insert(positions.end(), rows.begin(), rows.end());
      targets.resize(primitive.targets.size());
      for (std::size_t t = 0; t < targets.size(); ++t) {
        const std::vector<double> deltas = numbers(primitive.targets[t].at("POSITION"));
        targets[t].insert(targets[t].end(), deltas.begin(), deltas.end());
      }
    }
    for (const double index : numbers(primitive.indices)) corners.push_back(index + first->second);
  }
  const Mesh& ours = c.parts[static_cast<std::size_t>(part)].mesh;
  expect_rows(positions, ours.positions, "positions");
  expect_rows(corners, triangulate(ours.faces), "corners");
  std::size_t t = 0;
  for (const Shape& shape : c.shapes)
    for (const PartDelta& delta : shape.parts) {
      if (delta.part != part) continue;
      Points whole = Points::Zero(ours.positions.rows(), 3);
      for (std::size_t k = 0; k < delta.vertices.size(); ++k)
        whole.row(delta.vertices[k]) = delta.deltas.row(static_cast<Eigen::Index>(k));
      ASSERT_LT(t, targets.size());
      expect_rows(targets[t++], whole, shape.name.c_str());
    }
  EXPECT_EQ(t, targets.size());
}

void expect_same_skins(const tinygltf::Model& model, const Character& c) {
  ASSERT_EQ(model.skins.size(), c.skins.size());
  for (std::size_t s = 0; s < c.skins.size(); ++s) {
    EXPECT_EQ(model.skins[s].joints, c.skins[s].joints);
    if (model.skins[s].inverseBindMatrices < 0) continue;
    const std::vector<double> matrices = Numbers(model)(model.skins[s].inverseBindMatrices);
    for (std::size_t j = 0; j < c.skins[s].joints.size(); ++j)
      for (std::size_t k = 0; k < 16; ++k)
        ASSERT_EQ(static_cast<float>(matrices[16 * j + k]),
                  static_cast<float>(c.skins[s].inverse_bind[j].data()[k]));
  }
}

/// Keys of every channel that moves a node.
void expect_same_clips(const tinygltf::Model& model, const Character& c) {
  ASSERT_EQ(model.animations.size(), c.clips.size());
  const Numbers numbers(model);
  for (std::size_t a = 0; a < c.clips.size(); ++a) {
    EXPECT_EQ(model.animations[a].name, c.clips[a].name);
    std::size_t k = 0;
    std::vector<const Channel*> moving;
    for (const Channel& channel : c.clips[a].channels)
      if (channel.node >= 0) moving.push_back(&channel);
    for (const tinygltf::AnimationChannel& channel : model.animations[a].channels) {
      if (channel.target_path == "weights") continue;
      ASSERT_LT(k, moving.size());
      EXPECT_EQ(channel.target_node, moving[k]->node);
      const auto& sampler = model.animations[a].samplers[static_cast<std::size_t>(channel.sampler)];
      expect_rows(numbers(sampler.input), moving[k]->times, "times");
      expect_rows(numbers(sampler.output), moving[k]->values, "values");
      ++k;
    }
    EXPECT_EQ(k, moving.size());
  }
}

void expect_same_file(const std::filesystem::path& path, const Character& c) {
  SCOPED_TRACE(path.filename());
  const tinygltf::Model model = read_by_tinygltf(path);
  ASSERT_EQ(model.meshes.size(), c.parts.size());
  for (std::size_t m = 0; m < c.parts.size(); ++m)
    expect_same_mesh(model, model.meshes[m], c, static_cast<int>(m));
  expect_same_skins(model, c);
  expect_same_clips(model, c);
}

TEST(tinygltf, reads_what_we_write) {
  const test::Folder folder;
  for (const char* name : {"full.glb", "full.gltf"}) {
    save(test::full_character(), folder / name);
    expect_same_file(folder / name, test::full_character());
  }
}

TEST(tinygltf, reads_in_real_files_what_we_read) {
  const std::filesystem::path data(MIEN_SHARED_DATA);
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data";
  const test::Folder folder;
  for (const char* name : {"makehuman/caucasian_male_young.glb", "cases/C_mhrig_afr/source.glb",
                           "cases/A1_ict_id1.0/source.glb"}) {
    const Character c = load(data / name);
    expect_same_file(data / name, c);
    save(c, folder / "again.glb");
    expect_same_file(folder / "again.glb", c);
  }
}

}  // namespace
}  // namespace mien

#else
TEST(tinygltf, reads_what_we_write) {
  GTEST_SKIP() << "libtinygltf-dev is not installed";
}
#endif
