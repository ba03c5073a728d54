#include "mien/deform/draw_object.h"

#include <string>

#include "mien/character/object_problems.h"
#include "mien/core/error.h"
#include "mien/deform/bind_influence.h"
#include "mien/deform/wires.h"
#include "mien/geometry/bspline.h"
#include "mien/geometry/nurbs_query.h"

namespace mien {
namespace {

/// Points between those that a curve is drawn through: it is to follow the line between them, too.
constexpr int samples_a_control = 8;

Eigen::Vector3d place_of(const Character& character, const std::string& place, const SurfacePoint& point) {
  const auto refuse = [&](const std::string& what) {
    return invalid_input(place, "has a point on " + what, "one that the character has");
  };
  if (point.part < 0 || point.part >= static_cast<int>(character.parts.size()))
    throw refuse("part " + std::to_string(point.part));
  const Mesh& mesh = character.parts[point.part].mesh;
  if (point.face >= static_cast<int>(mesh.faces.size())) throw refuse("face " + std::to_string(point.face));
  if (point.face < 0 && (point.vertex < 0 || point.vertex >= static_cast<int>(mesh.vertex_count())))
    throw refuse("vertex " + std::to_string(point.vertex));
  return position_of(mesh, bind_positions(character, point.part).cast<float>(), point);
}

PointsD places_of(const Character& character, const std::string& place, const ObjectSketch& sketch) {
  PointsD places(static_cast<Eigen::Index>(sketch.through.size()), 3);
  for (std::size_t p = 0; p < sketch.through.size(); ++p)
    places.row(static_cast<Eigen::Index>(p)) = place_of(character, place, sketch.through[p]).transpose();
  return places;
}

PointsD controls_of(const Character& character, const ObjectSketch& sketch, const std::string& place) {
  const PointsD places = places_of(character, place, sketch);
  const InfluenceForm& form = sketch.object.form;
  if (const auto* curve = std::get_if<NurbsCurve>(&form)) {
    if (places.rows() < 2)
      throw invalid_input(place, "goes through " + std::to_string(places.rows()) + " points", "two or more");
    return fit_controls(*curve, sample_through(places, samples_a_control * curve->control_count()));
  }
  if (const auto* surface = std::get_if<NurbsSurface>(&form)) return fit_controls(*surface, places);
  if (is_frame(form) && places.rows() == 1) return places;
  throw invalid_input(place, "is given by points", "control points of its own");
}

void require_node(const Character& character, int node, const std::string& place) {
  if (node < -1 || node >= static_cast<int>(character.nodes.size()))
    throw invalid_input(place, "names node " + std::to_string(node),
                        "there are " + std::to_string(character.nodes.size()));
}

}  // namespace

InfluenceObject draw_object(const Character& character, const ObjectSketch& sketch) {
  InfluenceObject object = sketch.object;
  const std::string place = "object " + object.name;
  require_node(character, object.carrier, place);
  require_node(character, object.node, place);
  try {
    if (object.controls.rows() == 0 && !sketch.through.empty())
      object.controls = controls_of(character, sketch, place);
  } catch (const Error& error) {
    const std::string text = error.what();
    if (text.starts_with(place)) throw;
    throw invalid_input(place, text);
  }
  object.bindings = bind_influence(character, object, sketch.reach);
  if (!sketch.follows_skin) return object;
  if (object.skin < 0) object.skin = character.parts[object.bindings.front().part].skin;
  if (object.skin < 0)
    throw invalid_input(place, "is to follow the joints of a part without a skin",
                        "a part with skin weights");
  object.skin_weights = bind_controls(character, object.controls, object.skin, sketch.joints);
  return object;
}

}  // namespace mien
