#include "mien/io/curves_file.h"

#include <fmt/format.h>

#include <cmath>

#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"
#include "mien/io/detail/point.h"
#include "mien/io/file.h"

namespace mien {
namespace {

using detail::Json;
using detail::JsonObject;

/// Positions are taken to the closest surface point; from further away than this part of the box they mean something else.
constexpr double off_surface = 0.01;

double box_diagonal(const Character& character) {
  Eigen::AlignedBox3d box;
  const auto model = model_matrices(character);
  for (const Part& part : character.parts)
    for (Eigen::Index v = 0; v < part.mesh.positions.rows(); ++v) {
      const Eigen::Vector3d local = part.mesh.positions.row(v).transpose().cast<double>();
      box.extend(part.skin >= 0 || part.node < 0
                     ? local
                     : Eigen::Vector3d((model[part.node] * local.homogeneous()).head<3>()));
    }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

class CurveReader {
 public:
  explicit CurveReader(const Character& character)
      : character_(character),
        points_(character),
        model_(model_matrices(character)),
        box_(box_diagonal(character)) {}

  WireSketch read(const std::string& name, const JsonObject& source) {
    source.expect_only({"points", "controls", "range", "feature", "turns", "distance"});
    WireSketch curve;
    curve.name = name;
    curve.feature = source.text_or("feature", name);
    for (const JsonObject& point : source.objects("points")) curve.points.push_back(read_point(point));
    if (curve.points.size() < 4)
      throw io_error(source.place_of("points"), fmt::format("has {} points", curve.points.size()),
                     "a cubic needs four or more");
    curve.controls = static_cast<int>(source.integer_or("controls", curve.controls, -(1 << 30), 1 << 30));
    if (curve.controls < 4 || curve.controls > 1000)
      throw io_error(source.place_of("controls"), fmt::format("is {}", curve.controls),
                     "a cubic needs four or more, at most 1000");
    curve.turn_controls = static_cast<int>(source.integer_or("turns", curve.turn_controls, 0, 1000));
    if (curve.turn_controls > 0 && curve.turn_controls < 4)
      throw io_error(source.place_of("turns"), fmt::format("is {}", curve.turn_controls),
                     "give 0, or four or more");
    if (source.has("range")) {
      curve.range = source.number("range");
      if (!(curve.range > 0))
        throw io_error(source.place_of("range"), fmt::format("is {}", curve.range), "give a length above 0");
    }
    const std::string distance = source.text_or("distance", "geodesic");
    if (distance != "geodesic" && distance != "euclidean")
      throw io_error(source.place_of("distance"), fmt::format("is \"{}\"", distance.substr(0, 40)),
                     "give geodesic or euclidean");
    curve.geodesic = distance == "geodesic";
    return curve;
  }

 private:
  SurfacePoint read_point(const JsonObject& source) {
    const SurfacePoint point = points_.read(source);
    if (!source.has("position")) return point;
    const std::vector<double> given = source.numbers("position", 3);
    const Part& part = character_.parts[point.part];
    Eigen::Vector3d found = position_of(part.mesh, part.mesh.positions, point);
    if (part.skin < 0 && part.node >= 0) found = (model_[part.node] * found.homogeneous()).head<3>();
    const double distance = (found - Eigen::Map<const Eigen::Vector3d>(given.data())).norm();
    if (distance > off_surface * box_)
      throw io_error(source.place_of("position"), fmt::format("is {:.3g} off the surface", distance),
                     fmt::format("give a point within {:.3g} of it", off_surface * box_));
    return point;
  }

  const Character& character_;
  detail::PointReader points_;
  std::vector<Eigen::Matrix4d> model_;
  double box_;
};

}  // namespace

std::vector<WireSketch> read_curves(const std::filesystem::path& path, const Character& character) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
    if (!root.has("curves"))
      throw io_error("file", "has no \"curves\"", R"(give {"curves": {NAME: {"points": [POINT, ...]}}})");
    const JsonObject curves = root.object("curves");
    CurveReader reader(character);
    std::vector<WireSketch> result;
    for (const auto& [name, curve] : curves.json().items())  // a JSON object ascends by name
      result.push_back(reader.read(name, JsonObject(curve, fmt::format("curve {}", name))));
    if (result.empty()) throw io_error("curves", "are none", "give one or more");
    return result;
  });
}

void write_curves(const std::vector<WireSketch>& curves, const Character& character,
                  const std::filesystem::path& path) {
  Json root = {{"curves", Json::object()}};
  for (const WireSketch& curve : curves) {
    Json json = {{"points", Json::array()},
                 {"controls", curve.controls},
                 {"feature", curve.feature},
                 {"turns", curve.turn_controls}};
    for (const SurfacePoint& point : curve.points)
      json["points"].push_back(detail::point_json(point, character));
    if (curve.range > 0) json["range"] = curve.range;
    if (!curve.geodesic) json["distance"] = "euclidean";
    root["curves"][curve.name] = std::move(json);
  }
  write_file_atomically(path, detail::json_text(root, 1) + "\n");
}

}  // namespace mien
