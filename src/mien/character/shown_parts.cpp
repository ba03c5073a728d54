#include "mien/character/shown_parts.h"

#include <algorithm>

namespace mien {

std::size_t shown_part_count(const Character& character) {
  return static_cast<std::size_t>(std::count_if(character.parts.begin(), character.parts.end(),
                                                [](const Part& part) { return part.shown; }));
}

Character only_shown(const Character& character) {
  Character result = character;
  const int count = static_cast<int>(shown_part_count(character));
  const auto is_gone = [&](const auto& entry) { return entry.part >= count; };
  const auto is_gone_point = [&](const SurfacePoint& point) { return point.part >= count; };
  std::erase_if(result.parts, [](const Part& part) { return !part.shown; });
  for (Shape& shape : result.shapes) std::erase_if(shape.parts, is_gone);
  for (Wire& wire : result.wires) {
    std::erase_if(wire.points, is_gone_point);
    std::erase_if(wire.bindings, is_gone);
  }
  for (InfluenceObject& object : result.objects) std::erase_if(object.bindings, is_gone);
  for (Clip& clip : result.clips) std::erase_if(clip.channels, is_gone);
  std::erase_if(result.landmarks, [&](const Landmark& landmark) { return is_gone_point(landmark.at); });
  for (LandmarkCurve& curve : result.curves) std::erase_if(curve.points, is_gone_point);
  std::erase_if(result.curves, [](const LandmarkCurve& curve) { return curve.points.size() < 2; });
  return result;
}

}  // namespace mien
