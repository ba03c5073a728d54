// The influence objects of the two rigs in Sanchez 2007: a spline surface for the ring muscle of the mouth, two curves for the lips, a
// lattice for the jaw; and a wrap over the cheeks, a cluster at the nose's tip and a locator between the brows. All are drawn from the
// landmarks, in the character's unit, on its finished rig.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "mien/core/error.h"
#include "mien/deform/bind_influence.h"
#include "mien/deform/draw_object.h"
#include "mien/geometry/nurbs_query.h"
#include "mien/geometry/surface_query.h"
#include "mien/sample/detail/character_form.h"

namespace mien::sample {

namespace {

using Eigen::Vector3d;

constexpr int kAround = 10, kRings = 3;  ///< control vertices of the ring muscle, the repeated ones left out
constexpr int kDegree = 3;
constexpr int kPatch = 4;  ///< vertices of a cheek's patch along each side

class ObjectBuilder {
 public:
  explicit ObjectBuilder(Character& character)
      : character_(character),
        skin_(character.parts[face_part].mesh.positions.cast<double>()),
        query_(skin_, triangulate(character.parts[face_part].mesh.faces)),
        width_((at(55) - at(49)).norm()) {}

  void build() {
    add_mouth_muscle();
    add_lip("lipUpperCurve", "head", {49, 50, 51, 52, 53, 54, 55});
    add_lip("lipLowerCurve", "jaw", {49, 60, 59, 58, 57, 56, 55});
    add_jaw_lattice();
    add_cheeks();
    add_frame("noseTip", Cluster{}, 31, 0.35);
    add_frame("glabella", Locator{}, 28, 0.5);
  }

 private:
  const SurfacePoint& landmark(int number) const {
    const std::string name = "ibug_" + std::to_string(number);
    for (const Landmark& landmark : character_.landmarks)
      if (landmark.name == name) return landmark.at;
    throw invalid_input("landmark " + name, "is missing");
  }
  Vector3d at(int number) const {
    const Mesh& mesh = character_.parts[face_part].mesh;
    return position_of(mesh, mesh.positions, landmark(number));
  }
  /// Onto the skin, and then along z.
  Vector3d on_skin(const Vector3d& point, double forward) const {
    return query_.closest(point).position + Vector3d(0, 0, forward);
  }
  void add(const std::string& name, ObjectSketch sketch, const char* carrier) {
    sketch.object.name = name;
    sketch.object.carrier = find_node(character_, carrier);
    sketch.reach.parts = {face_part};
    character_.objects.push_back(draw_object(character_, sketch));
  }
  void add_mouth_muscle();
  void add_lip(const char* name, const char* carrier, const std::array<int, 7>& numbers);
  void add_jaw_lattice();
  void add_cheeks();
  void add_frame(const char* name, InfluenceForm form, int number, double range);

  Character& character_;
  PointsD skin_;
  SurfaceQuery query_;
  double width_;  ///< of the mouth: what lengths are given in
};

/// Rings of control vertices around the mouth, a little under the skin. The ring is closed: its last columns repeat the first.
void ObjectBuilder::add_mouth_muscle() {
  NurbsSurface surface;
  surface.degree_u = kDegree;
  surface.degree_v = 2;
  surface.count_u = kAround + kDegree;
  surface.count_v = kRings;
  for (int k = 0; k <= surface.count_u + kDegree; ++k) surface.knots_u.push_back(k - kDegree);
  surface.knots_v = clamped_knots(kRings, surface.degree_v);
  const Vector3d centre = (at(49) + at(55)) / 2, left = (at(55) - at(49)) / 2;
  const double up = (at(52) - at(58)).norm() / 2, middle = (at(52).y() + at(58).y()) / 2;
  ObjectSketch sketch;
  sketch.object.controls.resize(static_cast<Eigen::Index>(surface.count_u) * kRings, 3);
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < surface.count_u; ++i) {
      const double angle = 2 * std::numbers::pi * (i % kAround) / kAround;
      Vector3d place = centre + (1.05 + 0.17 * ring) * std::cos(angle) * left;
      place.y() = middle + (1.15 * up + 0.17 * ring * left.norm()) * std::sin(angle);
      place.z() = at(52).z();
      sketch.object.controls.row(i + surface.count_u * ring) = on_skin(place, -0.06 * width_).transpose();
    }
  sketch.object.form = surface;
  sketch.reach.full = 0.1 * width_;
  sketch.reach.range = 0.4 * width_;
  add("orbicularisOris", std::move(sketch), "head");
}

void ObjectBuilder::add_lip(const char* name, const char* carrier, const std::array<int, 7>& numbers) {
  ObjectSketch sketch;
  sketch.object.form = NurbsCurve{kDegree, clamped_knots(static_cast<int>(numbers.size()), kDegree), {}};
  for (const int number : numbers) sketch.through.push_back(landmark(number));
  sketch.reach.range = 0.3 * width_;
  add(name, std::move(sketch), carrier);
}

void ObjectBuilder::add_jaw_lattice() {
  const Vector3d chin = at(9), corner = at(5), mouth = at(58);
  const Lattice lattice{{5, 4, 4}, {3, 3, 3}};
  Box box;
  const double side = 1.15 * std::abs(corner.x());
  box.low = {-side, chin.y() - 0.5 * width_, corner.z() - 0.8 * width_};
  box.high = {side, mouth.y(), mouth.z() + 0.4 * width_};
  ObjectSketch sketch;
  sketch.object.form = lattice;
  sketch.object.controls = lattice_controls(lattice, box);
  sketch.reach.fade = 0.3;
  add("jawLattice", std::move(sketch), "jaw");
}

/// A patch of quads before each cheek, one mesh.
void ObjectBuilder::add_cheeks() {
  WrapMesh mesh;
  ObjectSketch sketch;
  sketch.object.controls.resize(2 * kPatch * kPatch, 3);
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    const int first = side * kPatch * kPatch;
    // Between lid, nostril, corner of the mouth and ear.
    const Vector3d inner(std::abs(at(36).x()) * 1.6, at(30).y(), at(36).z()),
        outer(std::abs(at(15).x()) * 0.9, at(30).y(), at(15).z());
    const double low = at(34).y() - at(30).y();
    for (int j = 0; j < kPatch; ++j)
      for (int i = 0; i < kPatch; ++i) {
        const double s = static_cast<double>(i) / (kPatch - 1), t = static_cast<double>(j) / (kPatch - 1);
        Vector3d place = inner + s * (outer - inner);
        place.y() += 1.4 * t * low;
        place.x() *= sign;
        sketch.object.controls.row(first + i + kPatch * j) = on_skin(place, 0.03 * width_).transpose();
      }
    for (int j = 0; j + 1 < kPatch; ++j)
      for (int i = 0; i + 1 < kPatch; ++i) {
        const int corner = first + i + kPatch * j;
        if (side == 0)
          mesh.faces.push_back({corner, corner + kPatch, corner + 1 + kPatch, corner + 1});
        else
          mesh.faces.push_back({corner, corner + 1, corner + 1 + kPatch, corner + kPatch});
      }
  }
  sketch.object.form = std::move(mesh);
  sketch.reach.full = 0.05 * width_;
  sketch.reach.range = 0.4 * width_;
  add("cheeks", std::move(sketch), "head");
}

/// A frame at a landmark, with a node of its own below the head.
void ObjectBuilder::add_frame(const char* name, InfluenceForm form, int number, double range) {
  const int head = find_node(character_, "head");
  const Eigen::Matrix4d to_head = model_matrices(character_)[head].inverse();
  Node node;
  node.name = std::string(name) + "_frame";
  node.parent = head;
  node.rest.translation = (to_head * at(number).homogeneous()).head<3>();
  character_.nodes.push_back(node);
  ObjectSketch sketch;
  sketch.object.form = std::move(form);
  sketch.object.node = static_cast<int>(character_.nodes.size()) - 1;
  sketch.through = {landmark(number)};
  sketch.reach.range = range * width_;
  add(name, std::move(sketch), "head");
}

struct Key {
  double seconds;
  Vector3d move;  ///< mouth widths
};

/// Moves one control point of an object of the talking clip.
void move_control(Character& character, const std::string& object, int control,
                  std::initializer_list<Key> keys, double unit) {
  Channel channel;
  channel.property = Channel::Property::object_control;
  channel.object = find_object(character, object);
  channel.control = control;
  for (const Key& key : keys) {
    channel.times.push_back(static_cast<float>(key.seconds));
    for (const double value : unit* key.move) channel.values.push_back(static_cast<float>(value));
  }
  character.clips.front().channels.push_back(std::move(channel));
}

}  // namespace

void add_influence_objects(Character& character) {
  ObjectBuilder(character).build();
}

void move_objects_while_talking(Character& character) {
  const InfluenceObject& muscle = character.objects[find_object(character, "orbicularisOris")];
  const auto row = [&](int i) { return Vector3d(muscle.controls.row(i).transpose()); };
  const double width = (row(0) - row(kAround / 2)).norm();
  const Vector3d centre = (row(0) + row(kAround / 2)) / 2;
  // "ou" and "uu" draw the inner ring of the muscle together and forward.
  for (int i = 0; i < kAround + kDegree; ++i) {
    Vector3d in = (centre - row(i)) / width;
    in.z() = 0;
    const Vector3d round = 0.12 * in + Vector3d(0, 0, 0.03);
    move_control(character, "orbicularisOris", i,
                 {{0, Vector3d::Zero()},
                  {0.8, Vector3d::Zero()},
                  {1.05, 0.8 * round},
                  {1.3, Vector3d::Zero()},
                  {2.95, Vector3d::Zero()},
                  {3.2, round},
                  {3.5, Vector3d::Zero()},
                  {4, Vector3d::Zero()}},
                 width);
  }
  // The lips' middles part a little further on open vowels, and press together on the way to them.
  for (int i = 2; i <= 4; ++i) {
    const double share = i == 3 ? 1 : 0.6;
    for (const auto& [name, sign] : {std::pair{"lipUpperCurve", 1.0}, std::pair{"lipLowerCurve", -1.0}})
      move_control(character, name, i,
                   {{0, Vector3d::Zero()},
                    {1.3, Vector3d::Zero()},
                    {1.55, sign * share * Vector3d(0, 0.03, 0.01)},
                    {1.8, Vector3d::Zero()},
                    {1.95, sign * share * Vector3d(0, -0.01, 0)},
                    {2.1, Vector3d::Zero()},
                    {4, Vector3d::Zero()}},
                   width);
  }
}

}  // namespace mien::sample
