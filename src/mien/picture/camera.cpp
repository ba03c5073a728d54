#include "mien/picture/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "mien/character/shown_parts.h"
#include "mien/core/error.h"

namespace mien {
namespace {

constexpr std::array<std::pair<View, std::string_view>, 4> names{{{View::front, "front"},
                                                                  {View::left, "left"},
                                                                  {View::right, "right"},
                                                                  {View::three_quarter, "three-quarter"}}};

/// From the face to the camera, in the face's own frame.
Eigen::Vector3d direction_of(View view) {
  switch (view) {
    case View::left:
      return Eigen::Vector3d::UnitX();
    case View::right:
      return -Eigen::Vector3d::UnitX();
    case View::three_quarter:
      return Eigen::Vector3d(0.62, 0.06, 0.78).normalized();
    case View::front:
      break;
  }
  return Eigen::Vector3d::UnitZ();
}

/// All parts below one another.
Points stack(const std::vector<Points>& posed) {
  Eigen::Index rows = 0;
  for (const Points& part : posed) rows += part.rows();
  Points all(rows, 3);
  rows = 0;
  for (const Points& part : posed) {
    all.middleRows(rows, part.rows()) = part;
    rows += part.rows();
  }
  return all;
}

/// What the shapes move: where it is, and where it goes at weight 1.
struct Moved {
  Points from, to;
};

Moved moved_by_shapes(const Character& character, const std::vector<Points>& posed) {
  const std::vector<Eigen::Matrix4d> model = model_matrices(character);
  std::vector<Points> from, to;
  for (const Shape& shape : character.shapes)
    for (const PartDelta& delta : shape.parts) {
      if (delta.part < 0 || delta.part >= static_cast<int>(posed.size())) continue;
      const Part& part = character.parts[delta.part];
      const bool held = part.skin < 0 && part.node >= 0 && part.node < static_cast<int>(model.size());
      const Eigen::Matrix3d turn =
          held ? Eigen::Matrix3d(model[part.node].topLeftCorner<3, 3>()) : Eigen::Matrix3d::Identity();
      from.push_back(posed[delta.part](delta.vertices, Eigen::all));
      to.push_back(from.back() + Points(delta.deltas * turn.cast<float>().transpose()));
    }
  return {stack(from), stack(to)};
}

Points inside(const Points& points, const Box& box) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Eigen::Vector3d p = points.row(v).cast<double>();
    if ((p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all()) rows.push_back(v);
  }
  return points(rows, Eigen::all);
}

}  // namespace

View view_of_name(std::string_view name) {
  for (const auto& [view, known] : names)
    if (known == name) return view;
  throw invalid_input("view " + std::string(name), "does not exist", "front, left, right or three-quarter");
}

std::string_view name_of(View view) {
  for (const auto& [known, name] : names)
    if (known == view) return name;
  return {};
}

Camera frame_points(const Points& points, const FrameOptions& options) {
  if (points.rows() == 0) throw invalid_input("picture", "shows nothing", "a part with vertices");
  if (!points.allFinite())
    throw invalid_input("picture", "shows a position that is not finite", "finite positions");
  const Eigen::Matrix3d to_model = options.facing.transpose();
  const Eigen::Vector3d back = to_model * direction_of(options.view);
  Camera camera;
  camera.up = to_model * Eigen::Vector3d::UnitY();
  Eigen::Matrix3d axes;  // rows: right, up, towards the camera
  axes.row(0) = camera.up.cross(back).normalized();
  axes.row(2) = back;
  axes.row(1) = back.cross(axes.row(0).transpose());
  const PointsD seen = points.cast<double>() * axes.transpose();
  const Eigen::Vector3d low = seen.colwise().minCoeff(), high = seen.colwise().maxCoeff();
  const Eigen::Vector3d centre = (low + high) / 2;
  const double slope = std::tan(camera.field_of_view * std::numbers::pi / 360) * (1 - 2 * options.margin);
  // A single point is seen from some way off.
  double distance = high == low ? 1e-3 * std::max(centre.norm(), 1e-30) : 0;
  for (Eigen::Index v = 0; v < seen.rows(); ++v) {
    const Eigen::Vector3d p = seen.row(v).transpose() - centre;
    const double wide = std::max(std::abs(p.x()) / options.aspect, std::abs(p.y()));
    distance = std::max(distance, p.z() + wide / slope);
  }
  camera.target = axes.transpose() * centre;
  camera.eye = camera.target + distance * back;
  return camera;
}

Camera frame_head(const Character& character, const std::vector<Points>& posed, const FrameOptions& options) {
  const std::vector<Points> seen(posed.begin(),
                                 posed.begin() + std::min(posed.size(), shown_part_count(character)));
  const Points all = stack(seen);
  const Moved moved = moved_by_shapes(character, seen);
  if (moved.from.rows() == 0 || !all.allFinite() || !moved.to.allFinite()) return frame_points(all, options);
  const auto grown = [](Box box, double by) {
    box.low.array() -= by;
    box.high.array() += by;
    return box;
  };
  const Box face = bounding_box(moved.from), whole = bounding_box(all);
  const bool has_body = whole.diagonal() > 2.6 * face.diagonal() && face.diagonal() > 0;
  const Points shown = has_body ? inside(all, grown(face, 0.45 * face.diagonal())) : all;
  // A wildly exaggerated shape does not make the head small.
  const Points reached = inside(moved.to, grown(bounding_box(shown), 0.12 * bounding_box(shown).diagonal()));
  return frame_points(stack({shown, reached}), options);
}

}  // namespace mien
