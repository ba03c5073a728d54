#include "mien/evaluate/detail/compile_objects.h"

#include <algorithm>

namespace mien::detail {
namespace {

/// The vertex's place in the binding, or -1.
int place_in(const InfluenceBinding& binding, int vertex) {
  const auto at = std::lower_bound(binding.vertices.begin(), binding.vertices.end(), vertex);
  return at == binding.vertices.end() || *at != vertex ? -1 : static_cast<int>(at - binding.vertices.begin());
}

/// Calls take(control point, share of its displacement) for a bound vertex; a frame's one control point has all of it.
template <class Take>
void each_share(const InfluenceBinding& binding, bool is_frame, int place, const Take& take) {
  if (is_frame) return take(0, binding.weights[place]);
  for (int e = binding.offsets[place]; e < binding.offsets[place + 1]; ++e)
    take(binding.controls[e], binding.weights[place] * binding.coefficients[e]);
}

}  // namespace

ObjectPacker::ObjectPacker(const Character& character, const ObjectRows& layout)
    : layout_(layout), bound_(character.parts.size()) {
  for (std::size_t o = 0; o < character.objects.size(); ++o)
    for (const InfluenceBinding& binding : character.objects[o].bindings)
      bound_[binding.part].push_back({static_cast<int>(o), &binding});
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Motion& to_model = layout.field().to_model(static_cast<int>(p));
    const Eigen::Matrix3d& to_part = layout.field().to_part(static_cast<int>(p));
    blocks_.is_in_model_space.push_back(to_model == Motion(Eigen::Matrix4d::Identity().topRows<3>()));
    blocks_.to_model.emplace_back();
    for (int k = 0; k < 12; ++k) blocks_.to_model.back()[k] = static_cast<float>(to_model(k / 4, k % 4));
    blocks_.to_part.emplace_back();
    for (int k = 0; k < 9; ++k) blocks_.to_part.back()[k] = static_cast<float>(to_part(k / 3, k % 3));
  }
}

std::vector<int> ObjectPacker::objects_of(std::size_t part, int vertex) const {
  std::vector<int> objects;
  for (const Bound& bound : bound_[part])
    if (place_in(*bound.binding, vertex) >= 0) objects.push_back(bound.object);
  return objects;
}

void ObjectPacker::add_block(std::size_t part, std::span<const int> vertices) {
  for (const Bound& bound : bound_[part]) add_object(bound, vertices);
  blocks_.begin.push_back(static_cast<std::uint32_t>(blocks_.entries.size()));
}

void ObjectPacker::add_object(const Bound& bound, std::span<const int> vertices) {
  const bool is_frame = layout_.is_frame(bound.object);
  const auto each = [&](const auto& take) {
    for (std::size_t l = 0; l < lane_count; ++l)
      if (const int place = place_in(*bound.binding, vertices[l]); place >= 0)
        each_share(*bound.binding, is_frame, place,
                   [&](int control, float share) { take(l, control, share); });
  };
  std::vector<int> own;
  each([&](std::size_t, int control, float) { own.push_back(control); });
  if (own.empty()) return;
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  ObjectEntry entry{static_cast<std::uint32_t>(bound.object), static_cast<std::uint32_t>(blocks_.rows.size()),
                    0, is_frame};
  for (const int control : own)
    blocks_.rows.push_back(static_cast<std::uint32_t>(layout_.control_begin(bound.object) + control));
  entry.end = static_cast<std::uint32_t>(blocks_.rows.size());
  blocks_.entries.push_back(entry);
  const std::size_t base = blocks_.weights.size();
  blocks_.weights.resize(base + lane_count * own.size(), 0.f);
  each([&](std::size_t lane, int control, float share) {
    const auto at = static_cast<std::size_t>(std::lower_bound(own.begin(), own.end(), control) - own.begin());
    blocks_.weights[base + lane_count * at + lane] += share;
  });
}

}  // namespace mien::detail
