#include "mien/sample/detail/inner_parts.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mien/sample/detail/contours.h"

namespace mien::sample {

namespace {

constexpr double kPi = std::numbers::pi;

/// Collects points and faces, faces by group.
class MeshWriter {
 public:
  int add(const Vector3d& p, const Vector2d& uv = Vector2d::Zero()) {
    points_.push_back(p);
    uvs_.push_back(uv);
    return static_cast<int>(points_.size()) - 1;
  }
  void begin_group(const std::string& name, int material) {
    FaceGroup group;
    group.name = name;
    group.material = material;
    group.face_begin = static_cast<int>(faces_.size());
    groups_.push_back(group);
  }
  void face(std::initializer_list<int> corners, bool flipped = false) {
    std::vector<int> list(corners);
    if (flipped) std::reverse(list.begin(), list.end());
    faces_.push_back(list);
  }
  Mesh finish() {
    Mesh mesh;
    mesh.positions.resize(points_.size(), 3);
    UvSet uv;
    uv.coordinates.resize(points_.size(), 2);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      mesh.positions.row(i) = points_[i].cast<float>();
      uv.coordinates.row(i) = uvs_[i].cast<float>();
    }
    mesh.uvs.push_back(uv);
    mesh.faces = faces_;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      groups_[g].face_end =
          g + 1 < groups_.size() ? groups_[g + 1].face_begin : static_cast<int>(faces_.size());
      groups_[g].vertex_end = static_cast<int>(points_.size());
    }
    mesh.groups = groups_;
    return mesh;
  }

 private:
  std::vector<Vector3d> points_;
  std::vector<Vector2d> uvs_;
  Faces faces_;
  std::vector<FaceGroup> groups_;
};

}  // namespace

Mesh make_eyeball(const Vector3d& centre, double radius, double iris_degrees) {
  const int around = 28;
  const double pupil = 0.42 * iris_degrees;
  // Angles from the axis of sight: the pupil's edge twice over is the iris' inner edge.
  std::vector<double> angles = {0.5 * pupil, pupil, 0.86 * iris_degrees, iris_degrees, 1.2 * iris_degrees};
  for (int k = 1; k <= 8; ++k) angles.push_back(angles[4] + k * (172 - angles[4]) / 8);
  MeshWriter out;
  const int front = out.add(centre + Vector3d(0, 0, radius), {0.5, 0.5});
  std::vector<int> first;
  for (double angle : angles) {
    first.push_back(front + 1 + around * static_cast<int>(first.size()));
    for (int i = 0; i < around; ++i) {
      const double a = 2 * kPi * i / around, t = angle * kPi / 180;
      const Vector3d d(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
      out.add(centre + radius * d,
              Vector2d(0.5 + 0.5 * t / kPi * std::cos(a), 0.5 + 0.5 * t / kPi * std::sin(a)));
    }
  }
  const int back = out.add(centre - Vector3d(0, 0, radius), {0.5, 0});
  const auto band = [&](std::size_t k) {
    for (int i = 0; i < around; ++i) {
      const int j = (i + 1) % around;
      out.face({first[k] + i, first[k + 1] + i, first[k + 1] + j, first[k] + j});
    }
  };
  out.begin_group("white", white_material);
  for (std::size_t k = 3; k + 1 < first.size(); ++k) band(k);
  for (int i = 0; i < around; ++i) out.face({first.back() + i, back, first.back() + (i + 1) % around});
  out.begin_group("iris", iris_material);
  band(1);
  out.begin_group("limbus", limbus_material);
  band(2);
  out.begin_group("pupil", pupil_material);
  for (int i = 0; i < around; ++i) out.face({front, first[0] + i, first[0] + (i + 1) % around});
  band(0);
  return out.finish();
}

Mesh make_teeth(const TeethForm& form) {
  const int per_tooth = 4, columns = form.teeth * per_tooth;
  const double sign = form.height > 0 ? 1 : -1, crown = std::abs(form.height);
  MeshWriter out;
  const int section = 10;
  // Across a tooth, from the gum's front over the biting edge to the gum's back: (out of the arch, from the
  // edge up).
  const double outward[section] = {0.55, 0.62, 0.5, 0.55, 0.42, -0.1, -0.35, -0.45, -0.5, -0.5};
  const double height[section] = {
      crown + form.gum, crown + 0.25 * form.gum, crown * 0.97,    crown * 0.5, 0.0, 0.02, crown * 0.5,
      crown * 0.97,     crown + 0.25 * form.gum, crown + form.gum};
  for (int i = 0; i <= columns; ++i) {
    const double along = 2.0 * i / columns - 1;
    // The arch: half an oval, points spread evenly enough by the sine.
    const double angle = along * 0.5 * kPi * 0.98;
    const Vector3d at(form.width * std::sin(angle), form.edge,
                      form.front - form.depth * (1 - std::pow(std::cos(angle), 0.7)));
    const Vector3d out_of_arch =
        Vector3d(std::sin(angle) / form.width, 0, std::cos(angle) / form.depth).normalized();
    const double within =
        std::abs(2 * (double(i % per_tooth) / per_tooth) - 1);  // 1 between teeth, 0 at the middle
    const double groove = 1 - 0.28 * std::pow(within, 3);
    const int tooth = std::min(i / per_tooth, form.teeth - 1);
    const int from_middle = std::min(std::abs(tooth - form.teeth / 2), std::abs(tooth - form.teeth / 2 + 1));
    const double longer = (from_middle == 2 ? form.fang : 0.0) + 0.05 * (from_middle == 0);
    for (int k = 0; k < section; ++k) {
      const bool is_crown = k >= 2 && k <= 7;
      const double o = form.thickness * outward[k] * (is_crown ? groove : 1);
      const double reach = is_crown ? (1 - height[k] / crown) : 0;
      double h = height[k] + reach * crown * (0.1 + 0.8 * form.pointed) * std::pow(within, 2);
      h -= reach * longer * crown * (1 - within * within);
      out.add(at + o * out_of_arch + Vector3d(0, sign * h, 0),
              Vector2d(0.5 + 0.5 * along, double(k) / (section - 1)));
    }
  }
  const bool flipped = sign > 0;
  const auto strip = [&](int k) {
    for (int i = 0; i < columns; ++i) {
      const int a = i * section + k, b = a + section;
      out.face({a, b, b + 1, a + 1}, flipped);
    }
  };
  out.begin_group("teeth", tooth_material);
  for (int k = 2; k < 7; ++k) strip(k);
  out.begin_group("gum", gum_material);
  for (int k : {0, 1, 7, 8}) strip(k);
  // Roof of the gum and both ends.
  for (int i = 0; i < columns; ++i)
    out.face({i * section + section - 1, (i + 1) * section + section - 1, (i + 1) * section, i * section},
             flipped);
  for (const int end : {0, columns * section})
    for (int k = 0; k < section / 2 - 1; ++k)
      out.face({end + k, end + k + 1, end + section - 2 - k, end + section - 1 - k},
               (end == 0) != flipped ? false : true);
  return out.finish();
}

Mesh make_tongue(const TongueForm& form) {
  const int around = 16, rings = 12;
  MeshWriter out;
  out.begin_group("tongue", tongue_material);
  const int tip = out.add(form.tip + Vector3d(0, 0, 0.05), {0.5, 1});
  for (int k = 0; k < rings; ++k) {
    const double t = 1 - (k + 0.35) / (rings - 0.65);  // 1 at the tip
    const Vector3d at = (1 - t) * (1 - t) * form.root +
                        2 * t * (1 - t) * (2 * form.middle - 0.5 * (form.root + form.tip)) + t * t * form.tip;
    const double round = std::sqrt(std::max(0.0, 1 - std::pow(t, 6)));
    for (int i = 0; i < around; ++i) {
      const double a = 2 * kPi * i / around;
      const double groove = std::sin(a) > 0 ? 0.22 * std::exp(-std::pow(std::cos(a) / 0.3, 2)) : 0;
      out.add(at + Vector3d(form.width * (0.8 + 0.2 * (1 - t)) * round * std::cos(a),
                            form.thickness * round * (std::sin(a) - groove), 0),
              Vector2d(0.5 + 0.5 * std::cos(a), t));
    }
  }
  const auto id = [&](int k, int i) { return tip + 1 + k * around + i % around; };
  for (int i = 0; i < around; ++i) out.face({tip, id(0, i), id(0, i + 1)});
  for (int k = 0; k + 1 < rings; ++k)
    for (int i = 0; i < around; ++i) out.face({id(k, i), id(k + 1, i), id(k + 1, i + 1), id(k, i + 1)});
  const int root = out.add(form.root - Vector3d(0, 0, 0.3), {0.5, 0});
  for (int i = 0; i < around; ++i) out.face({id(rings - 1, i), root, id(rings - 1, i + 1)});
  return out.finish();
}

Mesh make_brows(const BrowForm& form, const Sculpt& sculpt) {
  const int length = 16, section = 8;
  MeshWriter out;
  out.begin_group("brows", hair_material);
  for (const double side : {1.0, -1.0}) {
    std::vector<int> ids;
    for (int i = 0; i <= length; ++i) {
      const double t = double(i) / length, at = t * (form.line.size() - 1);
      const std::size_t k = std::min(static_cast<std::size_t>(at), form.line.size() - 2);
      // Through the given points by a Catmull-Rom curve.
      const auto point = [&](std::size_t j) { return form.line[std::min(j, form.line.size() - 1)]; };
      const Vector3d p0 = k ? form.line[k - 1] : form.line[0], p1 = point(k), p2 = point(k + 1),
                     p3 = point(k + 2);
      const double s = at - k;
      const Vector3d on_line = 0.5 * (2 * p1 + s * (p2 - p0) + s * s * (2 * p0 - 5 * p1 + 4 * p2 - p3) +
                                      s * s * s * (3 * p1 - p0 - 3 * p2 + p3));
      const Vector3d centre = sculpt.project(on_line, 8), normal = sculpt.normal(centre);
      const Vector3d along = (form.line.back() - form.line.front()).normalized();
      const Vector3d across = normal.cross(along).normalized();
      const double thick =
          std::pow(std::max(0.0, 1 - std::pow(std::abs(2 * std::pow(t, 0.6) - 0.85) / 1.15, 2.2)), 0.6);
      const double taper = std::max(0.04, thick) * (1 - 0.35 * t);
      for (int j = 0; j < section; ++j) {
        const double a = 2 * kPi * j / section;
        Vector3d p = centre + 0.5 * form.height * taper * std::cos(a) * across;
        p = sculpt.project(p, 4);
        p += sculpt.normal(p) * form.thickness * (0.15 + std::sin(a) * std::max(0.25, taper));
        ids.push_back(out.add(Vector3d(side * p.x(), p.y(), p.z()), Vector2d(t, double(j) / section)));
      }
    }
    const auto id = [&](int i, int j) { return ids[i * section + j % section]; };
    for (int i = 0; i < length; ++i)
      for (int j = 0; j < section; ++j)
        out.face({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)}, side > 0);
    for (const int i : {0, length})
      for (int j = 0; j < section / 2 - 1; ++j)
        out.face({id(i, j), id(i, j + 1), id(i, section - 2 - j), id(i, section - 1 - j)},
                 (side > 0) != (i == length));
  }
  return out.finish();
}

Mesh make_lashes(const HeadMesh& head, const HeadForm& form, double length, std::vector<int>& anchors) {
  MeshWriter out;
  out.begin_group("lashes", hair_material);
  const Loop& edge = head.half.eye[head.half.lid_edge];
  const int turn = static_cast<int>(edge.size()) / 2;
  for (const double side : {1.0, -1.0}) {
    std::vector<std::array<int, 3>> rows;
    for (int a = 1; a < turn; ++a) {
      const Vector3d root = head.half.points[edge[a]];
      const Vector3d from_eye = (root - form.eye.centre).normalized();
      const double t = double(a) / turn;
      const double reach = length * std::pow(std::sin(kPi * t), 0.7) * (0.7 + 0.5 * t);
      const Vector3d tip = root + reach * (0.8 * from_eye + Vector3d(0.35 * (t - 0.4), 0.35, 0));
      // A thin wedge: two roots and one tip, seen from both sides.
      const Vector3d low = root - 0.02 * from_eye, high = root + 0.06 * from_eye + Vector3d(0, 0.05, 0);
      const auto put = [&](const Vector3d& p, double v) {
        anchors.push_back(side > 0 ? edge[a] : head.mirror[edge[a]]);
        return out.add(Vector3d(side * p.x(), p.y(), p.z()), Vector2d(t, v));
      };
      rows.push_back({put(low, 0), put(high, 0.5), put(tip, 1)});
    }
    for (std::size_t i = 0; i + 1 < rows.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const int n = (k + 1) % 3;
        out.face({rows[i][k], rows[i][n], rows[i + 1][n], rows[i + 1][k]}, side < 0);
      }
    out.face({rows.front()[0], rows.front()[2], rows.front()[1]}, side < 0);
    out.face({rows.back()[0], rows.back()[1], rows.back()[2]}, side < 0);
  }
  return out.finish();
}

}  // namespace mien::sample
