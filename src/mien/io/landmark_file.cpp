#include "mien/io/landmark_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"
#include "mien/io/detail/point.h"
#include "mien/io/file.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;

LandmarkCurve read_curve(const std::string& name, const JsonObject& source, detail::PointReader& points) {
  source.expect_only({"points", "count"});
  LandmarkCurve curve;
  curve.name = name;
  for (const JsonObject& point : source.objects("points")) curve.points.push_back(points.read(point));
  if (curve.points.size() < 2)
    throw io_error(source.place_of("points"), fmt::format("has {} points", curve.points.size()),
                   "give two or more");
  curve.count = static_cast<int>(source.integer_or("count", static_cast<int>(curve.points.size()), 2, 10000));
  return curve;
}

}  // namespace

LandmarkSet read_landmarks(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    if (!root.has("landmarks") && !root.has("curves"))
      throw io_error("file", "has no \"landmarks\"", R"(give {"landmarks": {NAME: POINT}})");
    detail::PointReader points(character);
    LandmarkSet set;
    if (root.has("landmarks")) {
      const JsonObject landmarks = root.object("landmarks");
      for (const auto& [name, point] : landmarks.json().items())  // a JSON object ascends by name
        set.landmarks.push_back({name, points.read(JsonObject(point, fmt::format("landmark {}", name)))});
    }
    if (root.has("curves")) {
      const JsonObject curves = root.object("curves");
      for (const auto& [name, curve] : curves.json().items())
        set.curves.push_back(read_curve(name, JsonObject(curve, fmt::format("curve {}", name)), points));
    }
    return set;
  });
}

void write_landmarks(const LandmarkSet& set, const Character& character, const std::filesystem::path& path) {
  Json root = {{"landmarks", Json::object()}};
  for (const Landmark& landmark : set.landmarks)
    root["landmarks"][landmark.name] = detail::point_json(landmark.at, character);
  for (const LandmarkCurve& curve : set.curves) {
    Json points = Json::array();
    for (const SurfacePoint& point : curve.points) points.push_back(detail::point_json(point, character));
    root["curves"][curve.name] = {{"points", points}, {"count", curve.count}};
  }
  for (const auto& [name, confidence] : set.confidence) root["confidence"][name] = confidence;
  write_file_atomically(path, detail::json_text(root, 1) + "\n");
}

}  // namespace mien
