#include "mien/evaluate/detail/compile_blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "mien/core/error.h"
#include "mien/evaluate/detail/gray_order.h"

namespace mien::detail {
namespace {

constexpr int index_limit = 65535;
constexpr int identity = index_limit;  // until the number of carriers is known

struct Entry {
  int index = 0;          // shape, or carrier
  Eigen::Vector3f value;  // delta, or skin weight in x
};

/// The shapes and the influences of one part's chosen vertices.
struct Lists {
  std::vector<int> begin{0};
  std::vector<Entry> entries;
};

/// What moves the vertices of one part.
struct PartLists {
  std::vector<int> vertices;  // chosen, in the order wanted
  Lists shapes, joints;
  BlockSkin skin = BlockSkin::none;
};

std::vector<int> chosen_vertices(const Character& character, std::size_t part,
                                 const std::vector<std::vector<int>>& vertices) {
  const std::size_t count = character.parts[part].mesh.vertex_count();
  if (vertices.empty()) {
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const std::string place = "part " + character.parts[part].name;
  std::vector<char> is_chosen(count, 0);
  for (const int v : vertices[part]) {
    if (v < 0 || static_cast<std::size_t>(v) >= count)
      throw invalid_input(place, "is asked for vertex " + std::to_string(v), "one that it has");
    if (is_chosen[v]++)
      throw invalid_input(place, "is asked for vertex " + std::to_string(v) + " twice", "once");
  }
  return vertices[part];
}

std::vector<float> largest_deltas(const Character& character) {
  std::vector<float> largest;
  for (const Shape& shape : character.shapes) {
    float most = 0;
    for (const PartDelta& delta : shape.parts)
      if (delta.deltas.size()) most = std::max(most, delta.deltas.cwiseAbs().maxCoeff());
    largest.push_back(most);
  }
  return largest;
}

/// Whether the delta is there at all once it is stored.
bool is_stored(const Eigen::Vector3f& delta, const std::vector<float>& scales, std::size_t shape) {
  if (scales.empty() || scales[shape] == 0) return !delta.isZero(0);
  return (delta / scales[shape]).array().round().abs().maxCoeff() > 0;
}

Lists shape_lists(const Character& character, std::size_t part, const std::vector<int>& vertices,
                  const std::vector<float>& scales) {
  std::vector<int> local(character.parts[part].mesh.vertex_count(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) local[vertices[i]] = static_cast<int>(i);
  const auto each = [&](auto&& take) {
    for (std::size_t s = 0; s < character.shapes.size(); ++s)
      for (const PartDelta& delta : character.shapes[s].parts)
        for (std::size_t r = 0; static_cast<std::size_t>(delta.part) == part && r < delta.vertices.size();
             ++r) {
          const Eigen::Vector3f move = delta.deltas.row(static_cast<Eigen::Index>(r));
          const int at = local[delta.vertices[r]];
          if (at >= 0 && is_stored(move, scales, s)) take(at, Entry{static_cast<int>(s), move});
        }
  };
  Lists lists;
  lists.begin.assign(vertices.size() + 1, 0);
  each([&](int at, const Entry&) { ++lists.begin[static_cast<std::size_t>(at) + 1]; });
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.entries.resize(static_cast<std::size_t>(lists.begin.back()));
  std::vector<int> next = lists.begin;
  each([&](int at, const Entry& entry) { lists.entries[next[at]++] = entry; });
  return lists;
}

/// The influences of one vertex, divided by their sum; one on the identity when there are none.
void add_influences(const Character& character, const Part& part, int vertex, JointChain& chain,
                    Lists& lists) {
  const SkinWeights& weights = part.skin_weights;
  float total = 0;
  for (int i = weights.offsets[vertex]; i < weights.offsets[vertex + 1]; ++i) total += weights.weights[i];
  for (int i = weights.offsets[vertex]; i < weights.offsets[vertex + 1] && total > 0; ++i)
    lists.entries.push_back({chain.add_joint(character, part.skin, weights.joints[i]),
                             Eigen::Vector3f(weights.weights[i] / total, 0, 0)});
  if (!(total > 0)) lists.entries.push_back({identity, Eigen::Vector3f(1, 0, 0)});
}

PartLists part_lists(const Character& character, std::size_t p, std::vector<int> vertices,
                     const std::vector<float>& scales, JointChain& chain) {
  const Part& part = character.parts[p];
  PartLists lists{std::move(vertices), {}, {}, BlockSkin::none};
  lists.shapes = shape_lists(character, p, lists.vertices, scales);
  const bool is_carried = part.skin < 0 && part.node >= 0;
  const bool is_skinned = part.skin >= 0 && !part.skin_weights.empty();
  if (is_carried || is_skinned) lists.skin = BlockSkin::linear;
  if (is_skinned && character.skins[part.skin].method == SkinningMethod::dual_quaternion)
    lists.skin = BlockSkin::dual_quaternion;
  for (const int v : lists.vertices) {
    if (is_carried)
      lists.joints.entries.push_back({chain.add_node(character, part.node), Eigen::Vector3f(1, 0, 0)});
    if (is_skinned) add_influences(character, part, v, chain, lists.joints);
    lists.joints.begin.push_back(static_cast<int>(lists.joints.entries.size()));
  }
  return lists;
}

/// Order of the part's chosen vertices in the blocks.
std::vector<int> block_order(const PartLists& lists, const WirePacker& wires, const ObjectPacker& objects,
                             std::size_t part, std::size_t shape_count, std::size_t carrier_count) {
  const std::size_t first_row = shape_count + carrier_count + 1;
  const std::size_t first_object = first_row + static_cast<std::size_t>(wires.layout().row_count());
  const std::size_t bits = first_object + static_cast<std::size_t>(objects.object_count());
  BitSets sets(lists.vertices.size(), bits);
  for (std::size_t i = 0; i < lists.vertices.size(); ++i) {
    for (int e = lists.shapes.begin[i]; e < lists.shapes.begin[i + 1]; ++e)
      sets.set(i, static_cast<std::size_t>(lists.shapes.entries[e].index));
    for (int e = lists.joints.begin[i]; e < lists.joints.begin[i + 1]; ++e)
      sets.set(
          i, shape_count + std::min(static_cast<std::size_t>(lists.joints.entries[e].index), carrier_count));
    for (const WireField::Entry& entry : wires.entries_of(part, lists.vertices[i]))
      for (int a = 0; a < 4; ++a)
        sets.set(i, first_row +
                        static_cast<std::size_t>(wires.layout().control_begin(entry.wire) + entry.first + a));
    for (const int object : objects.objects_of(part, lists.vertices[i]))
      sets.set(i, first_object + static_cast<std::size_t>(object));
  }
  return gray_order(sets, bits, lane_count);
}

/// Writes the blocks of one part after the other.
class Packer {
 public:
  Packer(const Character& character, WirePacker& wires, ObjectPacker& objects, Blocks& blocks)
      : character_(character), wires_(wires), objects_(objects), blocks_(blocks) {
    blocks_.words = (character.shapes.size() + 63) / 64;
  }

  void add_part(std::size_t part, const PartLists& lists, const std::vector<int>& order) {
    const std::size_t begin = blocks_.count(), rows = lists.vertices.size();
    for (std::size_t first = 0; first < rows; first += lane_count) {
      std::array<int, lane_count> lanes{};
      for (std::size_t l = 0; l < lane_count; ++l) lanes[l] = order[std::min(first + l, rows - 1)];
      add_rows(lanes, std::min(lane_count, rows - first));
      add_neutral(character_.parts[part].mesh, lists, lanes);
      add_shapes(lists.shapes, lanes);
      add_joints(lists, lanes);
      for (int& lane : lanes) lane = lists.vertices[lane];
      wires_.add_block(part, lanes);
      objects_.add_block(part, lanes);
    }
    blocks_.parts.push_back({begin, blocks_.count(), lists.skin});
    blocks_.vertex_count += rows;
    blocks_.first_row.push_back(blocks_.vertex_count);
  }

 private:
  using LaneVertices = std::array<int, lane_count>;  // padding repeats the last vertex

  void add_rows(const LaneVertices& lanes, std::size_t used) {
    const int first = static_cast<int>(blocks_.vertex_count);
    bool in_a_row = used == lane_count;
    for (std::size_t l = 0; l < lane_count; ++l) {
      blocks_.row.push_back(l < used ? first + lanes[l] : -1);
      in_a_row = in_a_row && lanes[l] == lanes[0] + static_cast<int>(l);
    }
    blocks_.in_a_row.push_back(in_a_row);
  }

  void add_neutral(const Mesh& mesh, const PartLists& lists, const LaneVertices& lanes) {
    for (int axis = 0; axis < 3; ++axis)
      for (const int lane : lanes) blocks_.neutral.push_back(mesh.positions(lists.vertices[lane], axis));
  }

  std::vector<int> united(const Lists& lists, const LaneVertices& lanes) const {
    std::vector<int> all;
    for (const int lane : lanes)
      for (int e = lists.begin[lane]; e < lists.begin[lane + 1]; ++e) all.push_back(lists.entries[e].index);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  static std::size_t rank_of(int index, const std::vector<int>& ascending) {
    return static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), index) -
                                    ascending.begin());
  }

  void add_shapes(const Lists& lists, const LaneVertices& lanes) {
    const std::vector<int> all = united(lists, lanes);
    const std::size_t first_word = blocks_.shape_bits.size(), base = blocks_.shapes.size();
    blocks_.shape_bits.resize(first_word + blocks_.words, 0);
    for (const int s : all) {
      blocks_.shape_bits[first_word + static_cast<std::size_t>(s) / 64] |= std::uint64_t{1} << (s % 64);
      blocks_.shapes.push_back(static_cast<std::uint16_t>(s));
    }
    blocks_.shape_begin.push_back(static_cast<std::uint32_t>(blocks_.shapes.size()));
    const bool is_exact = blocks_.scales.empty();
    (is_exact ? blocks_.deltas.resize(block_floats * blocks_.shapes.size())
              : blocks_.compact.resize(block_floats * blocks_.shapes.size()));
    for (std::size_t l = 0; l < lane_count; ++l)
      for (int e = lists.begin[lanes[l]]; e < lists.begin[lanes[l] + 1]; ++e) {
        const Entry& entry = lists.entries[e];
        put_delta(block_floats * (base + rank_of(entry.index, all)) + l, entry);
      }
  }

  void put_delta(std::size_t at, const Entry& entry) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float move = entry.value[static_cast<Eigen::Index>(axis)];
      if (blocks_.scales.empty())
        blocks_.deltas[at + axis * lane_count] = move;
      else
        blocks_.compact[at + axis * lane_count] =
            static_cast<std::int16_t>(std::lround(move / blocks_.scales[entry.index]));
    }
  }

  void add_joints(const PartLists& lists, const LaneVertices& lanes) {
    std::vector<int> all = lists.skin == BlockSkin::none ? std::vector<int>{} : united(lists.joints, lanes);
    if (all.empty()) all.push_back(identity);
    const std::size_t base = blocks_.joint_weights.size();
    for (const int joint : all) blocks_.joints.push_back(static_cast<std::uint16_t>(joint));
    blocks_.joint_begin.push_back(static_cast<std::uint32_t>(blocks_.joints.size()));
    blocks_.joint_weights.resize(base + lane_count * (all.size() - 1), 0.f);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Entry* strongest = nullptr;
      for (int e = lists.joints.begin[lanes[l]]; e < lists.joints.begin[lanes[l] + 1]; ++e) {
        const Entry& entry = lists.joints.entries[e];
        if (const std::size_t rank = rank_of(entry.index, all); rank > 0)
          blocks_.joint_weights[base + lane_count * (rank - 1) + l] += entry.value.x();
        if (!strongest || entry.value.x() > strongest->value.x()) strongest = &entry;
      }
      blocks_.pivots.push_back(static_cast<std::uint16_t>(strongest ? strongest->index : identity));
    }
  }

  const Character& character_;
  WirePacker& wires_;
  ObjectPacker& objects_;
  Blocks& blocks_;
};

void check_limits(std::size_t shapes, std::size_t carriers) {
  if (shapes >= index_limit)
    throw invalid_input("character", "has " + std::to_string(shapes) + " shapes", "fewer than 65,535");
  if (carriers >= index_limit)
    throw invalid_input("character", "has " + std::to_string(carriers) + " joints", "fewer than 65,535");
}

}  // namespace

BlockData Blocks::view() const {
  BlockData data;
  data.neutral = neutral.data();
  data.shape_begin = shape_begin.data();
  data.shapes = shapes.data();
  (scales.empty() ? void(data.deltas = deltas.data()) : void(data.compact = compact.data()));
  data.shape_bits = shape_bits.data();
  data.words = words;
  data.joint_begin = joint_begin.data();
  data.joints = joints.data();
  data.joint_weights = joint_weights.data();
  data.wires = wires.view();
  data.objects = objects.view();
  return data;
}

Blocks compile_blocks(const Character& character, const std::vector<std::vector<int>>& vertices,
                      bool is_compact, const WireRows& wire_rows, const ObjectRows& object_rows,
                      JointChain& chain) {
  if (!vertices.empty() && vertices.size() != character.parts.size())
    throw invalid_input("vertices", "are of " + std::to_string(vertices.size()) + " parts",
                        std::to_string(character.parts.size()) + " lists, one a part");
  check_limits(character.shapes.size(), 0);
  Blocks blocks;
  blocks.first_row = {0};
  if (is_compact) blocks.scales = largest_deltas(character);
  for (float& scale : blocks.scales) scale /= 32767;
  WirePacker wires(character, wire_rows);
  ObjectPacker objects(character, object_rows);
  Packer packer(character, wires, objects, blocks);
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const PartLists lists =
        part_lists(character, p, chosen_vertices(character, p, vertices), blocks.scales, chain);
    check_limits(0, chain.carriers().size());
    packer.add_part(p, lists,
                    block_order(lists, wires, objects, p, character.shapes.size(), chain.carriers().size()));
  }
  blocks.wires = wires.take();
  blocks.objects = objects.take();
  const auto past = static_cast<std::uint16_t>(chain.carriers().size());
  for (auto* list : {&blocks.joints, &blocks.pivots})
    std::replace(list->begin(), list->end(), static_cast<std::uint16_t>(identity), past);
  blocks.lane_of_row.resize(blocks.vertex_count);
  for (std::size_t i = 0; i < blocks.row.size(); ++i)
    if (blocks.row[i] >= 0)
      blocks.lane_of_row[static_cast<std::size_t>(blocks.row[i])] = static_cast<std::uint32_t>(i);
  return blocks;
}

}  // namespace mien::detail
