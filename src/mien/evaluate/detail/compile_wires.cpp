#include "mien/evaluate/detail/compile_wires.h"

#include <algorithm>

namespace mien::detail {
namespace {

using VertexEntries = std::span<const WireField::Entry>;

/// The four control points of an entry, or its four turns: those that count.
template <class Take>
void each_weight(const WireField::Entry& entry, bool is_turn, const Take& take) {
  const float* weights = is_turn ? entry.turn_basis : entry.basis;
  const int first = is_turn ? entry.turn_first : entry.first;
  for (int a = 0; a < 4; ++a)
    if (weights[a] != 0) take(first + a, weights[a]);
}

const WireField::Entry* find(VertexEntries entries, int wire) {
  for (const WireField::Entry& entry : entries)
    if (entry.wire == wire) return &entry;
  return nullptr;
}

void sort_once(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

WireData WireBlocks::view() const {
  return {begin.data(), entries.data(), rows.data(), weights.data(), arms.data()};
}

WirePacker::WirePacker(const Character& character, const WireRows& layout)
    : layout_(layout), field_(character, character.wires), row_of_vertex_(character.parts.size()) {
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const WireField::PartRows& rows = field_.parts()[p];
    if (!rows.vertices.empty()) row_of_vertex_[p].assign(character.parts[p].mesh.vertex_count(), -1);
    for (std::size_t r = 0; r < rows.vertices.size(); ++r)
      row_of_vertex_[p][rows.vertices[r]] = static_cast<int>(r);
    const Eigen::Matrix3d& to_part = field_.to_part(static_cast<int>(p));
    blocks_.is_in_model_space.push_back(to_part == Eigen::Matrix3d::Identity());
    blocks_.to_part.emplace_back();
    for (int k = 0; k < 9; ++k) blocks_.to_part.back()[k] = static_cast<float>(to_part(k / 3, k % 3));
  }
}

std::span<const WireField::Entry> WirePacker::entries_of(std::size_t part, int vertex) const {
  const int row = row_of_vertex_[part].empty() ? -1 : row_of_vertex_[part][vertex];
  if (row < 0) return {};
  const WireField::PartRows& rows = field_.parts()[part];
  return {rows.entries.data() + rows.offsets[row], rows.entries.data() + rows.offsets[row + 1]};
}

void WirePacker::add_block(std::size_t part, std::span<const int> vertices) {
  std::array<VertexEntries, lane_count> lanes;
  std::vector<int> wires;
  for (std::size_t l = 0; l < lane_count; ++l) {
    lanes[l] = entries_of(part, vertices[l]);
    for (const WireField::Entry& entry : lanes[l]) wires.push_back(entry.wire);
  }
  sort_once(wires);
  for (const int wire : wires) add_wire(wire, lanes);
  blocks_.begin.push_back(static_cast<std::uint32_t>(blocks_.entries.size()));
}

void WirePacker::add_wire(int wire, std::span<const VertexEntries> lanes) {
  WireEntry packed;
  packed.wire = static_cast<std::uint32_t>(wire);
  packed.begin = static_cast<std::uint32_t>(blocks_.rows.size());
  add_rows(wire, false, lanes);
  packed.turns = static_cast<std::uint32_t>(blocks_.rows.size());
  if (layout_.turn_count(wire) > 0) add_rows(wire, true, lanes);
  packed.end = static_cast<std::uint32_t>(blocks_.rows.size());
  blocks_.entries.push_back(packed);
  const std::size_t base = blocks_.arms.size();
  blocks_.arms.resize(base + block_floats, 0.f);
  for (std::size_t l = 0; l < lane_count; ++l)
    if (const WireField::Entry* entry = find(lanes[l], wire))
      for (std::size_t axis = 0; axis < 3; ++axis)
        blocks_.arms[base + axis * lane_count + l] = entry->offset[static_cast<Eigen::Index>(axis)];
}

void WirePacker::add_rows(int wire, bool is_turn, std::span<const VertexEntries> lanes) {
  std::vector<int> own;  // of the wire's control points, or of its turns
  for (const VertexEntries& entries : lanes)
    if (const WireField::Entry* entry = find(entries, wire))
      each_weight(*entry, is_turn, [&](int k, float) { own.push_back(k); });
  sort_once(own);
  const int first = is_turn ? layout_.turn_begin(wire) : layout_.control_begin(wire);
  for (const int k : own) blocks_.rows.push_back(static_cast<std::uint32_t>(first + k));
  const std::size_t base = blocks_.weights.size();
  blocks_.weights.resize(base + lane_count * own.size(), 0.f);
  for (std::size_t l = 0; l < lane_count; ++l)
    if (const WireField::Entry* entry = find(lanes[l], wire))
      each_weight(*entry, is_turn, [&](int k, float weight) {
        const auto place = std::lower_bound(own.begin(), own.end(), k) - own.begin();
        blocks_.weights[base + lane_count * static_cast<std::size_t>(place) + l] = weight;
      });
}

}  // namespace mien::detail
