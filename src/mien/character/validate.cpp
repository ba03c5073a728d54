#include "mien/character/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "mien/character/detail/skin_problem.h"
#include "mien/character/detail/validate_carried.h"
#include "mien/character/object_problems.h"

namespace mien {
namespace {

std::string text_of(long long number) {
  return std::to_string(number);
}

class Validator {
 public:
  explicit Validator(const Character& character) : character_(character) {}
  std::vector<Problem> run();

 private:
  void check_nodes();
  void check_materials();
  void check_skins();
  void check_mesh(const Part& part, const std::string& place);
  void check_faces(const Mesh& mesh, const std::string& place);
  void check_uvs(const Mesh& mesh, const std::string& place);
  void check_groups(const Mesh& mesh, const std::string& place);
  void check_skin_weights(const Part& part, const std::string& place);
  void check_shapes();
  void check_delta(const PartDelta& delta, const std::string& place);
  void check_sliders();
  void check_stops(const Slider& slider, const std::string& place);
  void check_correctives();
  void check_expressions();
  void check_clips();
  void check_channel(const Channel& channel, const std::string& place);
  void check_wires();
  void check_wire_target(const Channel& channel, const std::string& place);
  void check_channel_target(const Channel& channel, const std::string& place);
  void check_landmarks();
  void check_point(const SurfacePoint& point, const std::string& place);
  void add(std::string place, std::string text, std::string remedy) {
    problems_.push_back({std::move(place), std::move(text), std::move(remedy)});
  }
  /// Whether `index` is in [low, count); adds a problem otherwise.
  bool in_range(long long index, long long low, std::size_t count, const std::string& place,
                const char* what);
  template <typename Matrix>
  void check_finite(const Matrix& rows, const std::string& place, const char* what);
  template <typename Matrix>
  void check_rows(const Matrix& rows, Eigen::Index wanted, const std::string& place, const char* what);

  const Character& character_;
  std::vector<Problem> problems_;
};

bool Validator::in_range(long long index, long long low, std::size_t count, const std::string& place,
                         const char* what) {
  if (index >= low && index < static_cast<long long>(count)) return true;
  add(place, std::string("names ") + what + " " + text_of(index), "there are " + text_of(count));
  return false;
}

template <typename Matrix>
void Validator::check_finite(const Matrix& rows, const std::string& place, const char* what) {
  if (rows.allFinite()) return;
  Eigen::Index row = 0;
  while (rows.row(row).allFinite()) ++row;
  add(place + ": " + what + " " + text_of(row), "is not finite", "give finite numbers");
}

template <typename Matrix>
void Validator::check_rows(const Matrix& rows, Eigen::Index wanted, const std::string& place,
                           const char* what) {
  if (rows.rows() != 0 && rows.rows() != wanted)
    add(place, "has " + text_of(rows.rows()) + " " + what, "there are " + text_of(wanted) + " vertices");
  else
    check_finite(rows, place, what);
}

void Validator::check_nodes() {
  const std::vector<Node>& nodes = character_.nodes;
  bool parents_known = true;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Node& node = nodes[n];
    const std::string place = "node " + (node.name.empty() ? text_of(n) : node.name);
    parents_known = in_range(node.parent, -1, nodes.size(), place, "parent") && parents_known;
    if (!node.rest.translation.allFinite() || !node.rest.scale.allFinite() ||
        !node.rest.rotation.coeffs().allFinite() || !node.matrix.allFinite())
      add(place, "has a transform that is not finite", "give finite numbers");
    else if (std::abs(node.rest.rotation.norm() - 1) > 1e-3)
      add(place, "has a rotation that is not unit", "normalise it");
  }
  if (!parents_known) return;
  std::vector<int> walk(nodes.size(), -1);
  for (int start = 0; start < static_cast<int>(nodes.size()); ++start)
    for (int at = start; at >= 0 && walk[at] != start; at = nodes[at].parent) {
      if (walk[at] >= 0) break;
      walk[at] = start;
      if (nodes[at].parent >= 0 && walk[nodes[at].parent] == start) {
        add("node " + (nodes[at].name.empty() ? text_of(at) : nodes[at].name), "is its own ancestor",
            "nodes must form trees");
        return;
      }
    }
}

void Validator::check_materials() {
  for (const Material& material : character_.appearance.materials)
    if (!material.base_color.allFinite())
      add("material " + material.name, "has a colour that is not finite", "give numbers in [0, 1]");
}

void Validator::check_skins() {
  for (std::size_t s = 0; s < character_.skins.size(); ++s) {
    const Skin& skin = character_.skins[s];
    const std::string place = "skin " + (skin.name.empty() ? text_of(s) : skin.name);
    if (skin.joints.empty()) add(place, "has no joints", "a skin needs joints");
    std::unordered_set<int> seen;
    for (const int joint : skin.joints) {
      if (!in_range(joint, 0, character_.nodes.size(), place, "node")) break;
      if (!seen.insert(joint).second) {
        add(place, "lists node " + text_of(joint) + " twice", "list each joint once");
        break;
      }
    }
    in_range(skin.skeleton, -1, character_.nodes.size(), place, "node");
    if (skin.inverse_bind.size() != skin.joints.size())
      add(place, "has " + text_of(skin.inverse_bind.size()) + " inverse bind matrices",
          "there are " + text_of(skin.joints.size()) + " joints");
    for (const Eigen::Matrix4d& matrix : skin.inverse_bind)
      if (!matrix.cast<float>().allFinite()) {
        add(place, "has an inverse bind matrix that is not finite", "give finite numbers");
        break;
      }
  }
}

void Validator::check_faces(const Mesh& mesh, const std::string& place) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto here = [&] { return place + ": face " + text_of(f); };
    if (mesh.faces[f].size() < 3) return add(here(), "has fewer than three corners", "give three or more");
    for (const int v : mesh.faces[f])
      if (v < 0 || v >= mesh.positions.rows()) {
        in_range(v, 0, mesh.vertex_count(), here(), "vertex");
        return;
      }
  }
}

void Validator::check_uvs(const Mesh& mesh, const std::string& place) {
  for (std::size_t set = 0; set < mesh.uvs.size(); ++set) {
    const UvSet& uv = mesh.uvs[set];
    const std::string here = place + ": UV set " + text_of(set);
    check_finite(uv.coordinates, here, "coordinate");
    if (uv.corners.empty()) {
      if (uv.coordinates.rows() != mesh.positions.rows() && !mesh.faces.empty())
        add(here, "has " + text_of(uv.coordinates.rows()) + " coordinates",
            "there are " + text_of(mesh.positions.rows()) + " vertices");
      continue;
    }
    if (uv.corners.size() != mesh.faces.corner_count())
      add(here, "has " + text_of(uv.corners.size()) + " corners",
          "the faces have " + text_of(mesh.faces.corner_count()));
    for (const int corner : uv.corners)
      if (!in_range(corner, -1, static_cast<std::size_t>(uv.coordinates.rows()), here, "coordinate")) break;
  }
}

void Validator::check_groups(const Mesh& mesh, const std::string& place) {
  int next = 0;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    const FaceGroup& group = mesh.groups[g];
    const std::string here = place + ": group " + text_of(g);
    if (group.face_begin != next || group.face_end < group.face_begin)
      return add(here, "has faces " + text_of(group.face_begin) + " to " + text_of(group.face_end),
                 "groups follow one another from face " + text_of(next));
    next = group.face_end;
    if (!in_range(group.material, -1, character_.appearance.materials.size(), here, "material")) return;
  }
  if (!mesh.groups.empty() && next != static_cast<int>(mesh.faces.size()))
    add(place, "has groups up to face " + text_of(next),
        "they must cover " + text_of(mesh.faces.size()) + " faces");
}

void Validator::check_skin_weights(const Part& part, const std::string& place) {
  const bool of_hidden =
      !part.shown && part.skin < 0;  // whatever skin its joints belong to, files name 2^16 at most
  if (part.skin_weights.empty() || (part.skin < 0 && !of_hidden) ||
      part.skin >= static_cast<int>(character_.skins.size()))
    return;
  if (auto problem = detail::skin_problem(part.skin_weights, part.mesh.vertex_count(),
                                          of_hidden ? 65536 : character_.skins[part.skin].joints.size(),
                                          place, "vertex"))
    problems_.push_back(std::move(*problem));
}

void Validator::check_mesh(const Part& part, const std::string& place) {
  const Mesh& mesh = part.mesh;
  const Eigen::Index count = mesh.positions.rows();
  if (count == 0) add(place, "has no vertices", "leave the part out");
  check_finite(mesh.positions, place, "vertex");
  check_rows(mesh.normals, count, place, "normals");
  check_rows(mesh.tangents, count, place, "tangents");
  for (const Points4& colors : mesh.colors) check_rows(colors, count, place, "colours");
  check_faces(mesh, place);
  check_uvs(mesh, place);
  check_groups(mesh, place);
  detail::check_carried(mesh, character_.appearance.materials.size(), place, problems_);
  in_range(part.node, -1, character_.nodes.size(), place, "node");
  in_range(part.skin, -1, character_.skins.size(), place, "skin");
  check_skin_weights(part, place);
  if (part.surface)
    if (const std::string fault = fault_of(*part.surface, mesh.vertex_count()); !fault.empty())
      add(place + ": spline surface", fault, "give a descriptor of its control vertices");
}

void Validator::check_delta(const PartDelta& delta, const std::string& place) {
  if (!in_range(delta.part, 0, character_.parts.size(), place, "part")) return;
  const auto rows = static_cast<Eigen::Index>(delta.vertices.size());
  if (delta.deltas.rows() != rows ||
      (delta.normal_deltas.rows() != 0 && delta.normal_deltas.rows() != rows) ||
      (delta.tangent_deltas.rows() != 0 && delta.tangent_deltas.rows() != rows))
    add(place, "has arrays of unequal length", "give one row a vertex");
  for (std::size_t k = 0; k < delta.vertices.size(); ++k) {
    if (k > 0 && delta.vertices[k] <= delta.vertices[k - 1]) {
      add(place, "has vertices that do not ascend", "sort them and name each once");
      break;
    }
    if (!in_range(delta.vertices[k], 0, character_.parts[delta.part].mesh.vertex_count(), place, "vertex"))
      break;
  }
  check_finite(delta.deltas, place, "displacement");
  check_finite(delta.normal_deltas, place, "normal displacement");
  check_finite(delta.tangent_deltas, place, "tangent displacement");
}

void Validator::check_shapes() {
  std::unordered_set<std::string> names;
  for (const Shape& shape : character_.shapes) {
    const std::string place = "shape " + shape.name;
    if (!names.insert(shape.name).second)
      add(place, "has the name of another shape", "give each its own name");
    int before = -1;
    for (const PartDelta& delta : shape.parts) {
      if (delta.part <= before) add(place, "lists its parts out of order", "list each part once, ascending");
      before = delta.part;
      check_delta(delta, place);
    }
  }
}

void Validator::check_stops(const Slider& slider, const std::string& place) {
  double before = -std::numeric_limits<double>::infinity();
  for (const SliderStop& stop : slider.stops) {
    if (!std::isfinite(stop.at) || stop.at == 0 || stop.at <= before)
      return add(place, "has a stop at " + std::to_string(stop.at), "stops ascend and none is at 0");
    before = stop.at;
    if (!in_range(stop.shape, 0, character_.shapes.size(), place, "shape")) return;
  }
}

void Validator::check_sliders() {
  std::unordered_set<std::string> names;
  for (const Slider& slider : character_.sliders) {
    const std::string place = "slider " + slider.name;
    if (!names.insert(slider.name).second)
      add(place, "has the name of another slider", "give each its own name");
    if (!std::isfinite(slider.minimum) || !std::isfinite(slider.maximum) ||
        !(slider.minimum < slider.maximum))
      add(place, "has no range", "give a minimum below a maximum");
    if (!std::isfinite(slider.rest))
      add(place, "has a rest value that is not finite", "give a finite number");
    check_stops(slider, place);
  }
}

void Validator::check_correctives() {
  for (std::size_t c = 0; c < character_.correctives.size(); ++c) {
    const Corrective& corrective = character_.correctives[c];
    const std::string place = "corrective " + text_of(c);
    in_range(corrective.shape, 0, character_.shapes.size(), place, "shape");
    if (corrective.inputs.empty()) add(place, "has no inputs", "name the sliders that fire it");
    std::unordered_set<int> seen;
    for (const CorrectiveInput& input : corrective.inputs) {
      if (!in_range(input.slider, 0, character_.sliders.size(), place, "slider")) break;
      if (!seen.insert(input.slider).second)
        add(place, "lists slider " + text_of(input.slider) + " twice", "list each slider once");
      if (!std::isfinite(input.at) || input.at == 0)
        add(place, "has an input that is full at " + std::to_string(input.at), "give a value other than 0");
    }
  }
}

void Validator::check_expressions() {
  std::unordered_set<std::string> names;
  for (const Expression& expression : character_.expressions) {
    const std::string place = "expression " + expression.name;
    if (!names.insert(expression.name).second)
      add(place, "has the name of another expression", "give each its own name");
    int before = -1;
    for (const ExpressionValue& entry : expression.values) {
      if (!in_range(entry.slider, 0, character_.sliders.size(), place, "slider")) break;
      if (entry.slider <= before) add(place, "lists its sliders out of order", "list each once, ascending");
      if (!std::isfinite(entry.value)) add(place, "has a value that is not finite", "give finite numbers");
      before = entry.slider;
    }
  }
}

void Validator::check_wires() {
  std::unordered_set<std::string> names;
  for (const Wire& wire : character_.wires) {
    const std::string place = "wire " + wire.name;
    if (!names.insert(wire.name).second) add(place, "is there twice", "names are unique");
    try {
      require_valid(wire.curve);
    } catch (const Error& error) {
      add(place, error.what(), "a cubic B-spline");
    }
    for (const WireBinding& binding : wire.bindings)
      in_range(binding.part, 0, character_.parts.size(), place, "part");
  }
  for (const Shape& shape : character_.shapes)
    for (const WireMove& move : shape.wires)
      if (in_range(move.wire, 0, character_.wires.size(), "shape " + shape.name, "wire")) {
        const std::string place = "shape " + shape.name + ": wire " + character_.wires[move.wire].name;
        check_finite(move.controls, place, "control point");
        check_finite(move.turns, place, "turn");
      }
}

void Validator::check_wire_target(const Channel& channel, const std::string& place) {
  if (!in_range(channel.wire, 0, character_.wires.size(), place, "wire")) return;
  const Wire& wire = character_.wires[channel.wire];
  if (channel.property == Channel::Property::wire_control)
    in_range(channel.control, 0, static_cast<std::size_t>(wire.curve.control_count()), place,
             "control point");
  if (channel.property == Channel::Property::wire_turn)
    in_range(channel.control, 0, static_cast<std::size_t>(wire.turn_controls), place, "turn");
}

void Validator::check_channel_target(const Channel& channel, const std::string& place) {
  if (channel.moves_wire()) {
    check_wire_target(channel, place);
    return;
  }
  if (channel.property == Channel::Property::object_control) {
    if (in_range(channel.object, 0, character_.objects.size(), place, "object"))
      in_range(channel.control, 0,
               static_cast<std::size_t>(character_.objects[channel.object].controls.rows()), place,
               "control point");
    return;
  }
  if (channel.property == Channel::Property::slider) {
    in_range(channel.slider, 0, character_.sliders.size(), place, "slider");
    return;
  }
  if (channel.property != Channel::Property::shape_weight) {
    in_range(channel.node, 0, character_.nodes.size(), place, "node");
    return;
  }
  in_range(channel.shape, 0, character_.shapes.size(), place, "shape");
  in_range(channel.part, -1, character_.parts.size(), place, "part");
}

void Validator::check_channel(const Channel& channel, const std::string& place) {
  check_channel_target(channel, place);
  const bool cubic = channel.interpolation == Interpolation::cubic_spline;
  const std::size_t wanted = channel.times.size() * channel.width() * (cubic ? 3 : 1);
  if (channel.times.empty()) return add(place, "has no keys", "leave the channel out");
  if (channel.values.size() != wanted)
    return add(place, "has " + text_of(channel.values.size()) + " values", text_of(wanted) + " are needed");
  for (std::size_t k = 0; k < channel.times.size(); ++k)
    if (!std::isfinite(channel.times[k]) || channel.times[k] < 0 ||
        (k > 0 && channel.times[k] <= channel.times[k - 1]))
      return add(place + ": key " + text_of(k), "is not later than the one before it",
                 "times must ascend from 0");
  for (const float value : channel.values)
    if (!std::isfinite(value)) return add(place, "has a value that is not finite", "give finite numbers");
  if (channel.property != Channel::Property::rotation) return;
  for (std::size_t k = 0; k < channel.times.size(); ++k) {
    const float* q = channel.values.data() + 4 * (cubic ? 3 * k + 1 : k);
    if (std::abs(Eigen::Vector4f(q[0], q[1], q[2], q[3]).norm() - 1) > 1e-2f)
      return add(place + ": key " + text_of(k), "has a rotation that is not unit", "normalise it");
  }
}

void Validator::check_clips() {
  for (std::size_t c = 0; c < character_.clips.size(); ++c) {
    const Clip& clip = character_.clips[c];
    for (std::size_t k = 0; k < clip.channels.size(); ++k)
      check_channel(clip.channels[k],
                    "clip " + (clip.name.empty() ? text_of(c) : clip.name) + ": channel " + text_of(k));
  }
}

void Validator::check_point(const SurfacePoint& point, const std::string& place) {
  if (!in_range(point.part, 0, character_.parts.size(), place, "part")) return;
  const Mesh& mesh = character_.parts[point.part].mesh;
  if (point.face < 0) {
    in_range(point.vertex, 0, mesh.vertex_count(), place, "vertex");
    return;
  }
  if (!in_range(point.face, 0, mesh.faces.size(), place, "face")) return;
  for (const int corner : point.corners) in_range(corner, 0, mesh.faces[point.face].size(), place, "corner");
  if (!point.barycentric.allFinite() || std::abs(point.barycentric.sum() - 1) > 1e-3)
    add(place, "has barycentric weights that do not sum to one", "give three weights of sum 1");
}

void Validator::check_landmarks() {
  std::unordered_set<std::string> names;
  for (const Landmark& landmark : character_.landmarks) {
    const std::string place = "landmark " + landmark.name;
    if (!names.insert(landmark.name).second)
      add(place, "has the name of another landmark", "give each its own name");
    check_point(landmark.at, place);
  }
  for (const LandmarkCurve& curve : character_.curves) {
    const std::string place = "curve " + curve.name;
    if (curve.points.size() < 2) add(place, "has fewer than two points", "give two or more");
    if (curve.count < 2) add(place, "has a count of " + text_of(curve.count), "give 2 or more");
    for (const SurfacePoint& point : curve.points) check_point(point, place);
  }
}

std::vector<Problem> Validator::run() {
  check_nodes();
  check_materials();
  check_skins();
  for (std::size_t p = 0; p < character_.parts.size(); ++p) {
    const Part& part = character_.parts[p];
    const std::string place = "part " + (part.name.empty() ? text_of(p) : part.name);
    check_mesh(part, place);
    if (part.shown && p > 0 && !character_.parts[p - 1].shown)
      add(place, "comes after a part that is not shown", "parts that are not shown come last");
  }
  check_shapes();
  check_wires();
  for (Problem& problem : object_problems(character_)) problems_.push_back(std::move(problem));
  check_sliders();
  check_correctives();
  check_expressions();
  check_clips();
  check_landmarks();
  for (const auto& found : {constraint_problems(character_), control_problems(character_)})
    problems_.insert(problems_.end(), found.begin(), found.end());
  return std::move(problems_);
}

}  // namespace

std::vector<Problem> validate(const Character& character) {
  return Validator(character).run();
}

void require_valid(const Character& character) {
  const std::vector<Problem> problems = validate(character);
  if (!problems.empty()) throw problems.front().error();
}

}  // namespace mien
