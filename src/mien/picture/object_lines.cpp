#include "mien/picture/object_lines.h"

#include <set>
#include <utility>

#include "mien/deform/influence.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/evaluate.h"

namespace mien {
namespace {

constexpr int samples = 48;
constexpr Color curve_color{0.05f, 0.45f, 0.15f}, polygon_color{0.45f, 0.7f, 0.5f},
    surface_color{0.75f, 0.15f, 0.1f}, lattice_color{0.1f, 0.3f, 0.75f}, mesh_color{0.6f, 0.35f, 0.05f},
    frame_color{0.5f, 0.1f, 0.6f};
constexpr double frame_size = 0.03;  ///< of the character's box

/// One object's lines from its control points as posed.
class LineDrawer {
 public:
  LineDrawer(const PointsD& controls, const Eigen::Matrix3d& axes, double size, std::vector<Polyline>& lines)
      : controls_(controls), axes_(axes), size_(size), lines_(lines) {}

  void operator()(const NurbsCurve& curve) const {
    add(controls_, polygon_color);
    add(tessellate(curve, controls_, samples), curve_color);
  }
  void operator()(const NurbsSurface& surface) const {
    const int nu = 2 * surface.count_u, nv = 2 * surface.count_v;
    const auto line = [&](bool along_u, int k, int count) {
      const Mesh fine = tessellate(surface, controls_, along_u ? samples : count, along_u ? count : samples);
      PointsD points(samples, 3);
      for (int s = 0; s < samples; ++s)
        points.row(s) = fine.positions.row(along_u ? s + samples * k : k + count * s).cast<double>();
      add(points, surface_color);
    };
    for (int k = 0; k < nv; ++k) line(true, k, nv);
    for (int k = 0; k < nu; ++k) line(false, k, nu);
  }
  void operator()(const Lattice& lattice) const {
    const auto [ns, nt, nu] = lattice.count;
    const auto at = [&](int i, int j, int k) { return i + ns * (j + nt * k); };
    for (int k = 0; k < nu; ++k)
      for (int j = 0; j < nt; ++j)
        for (int i = 0; i < ns; ++i) {
          if (i + 1 < ns) edge(at(i, j, k), at(i + 1, j, k), lattice_color);
          if (j + 1 < nt) edge(at(i, j, k), at(i, j + 1, k), lattice_color);
          if (k + 1 < nu) edge(at(i, j, k), at(i, j, k + 1), lattice_color);
        }
  }
  void operator()(const WrapMesh& mesh) const {
    std::set<std::pair<int, int>> edges;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto face = mesh.faces[f];
      for (std::size_t c = 0; c < face.size(); ++c)
        edges.insert(std::minmax(face[c], face[(c + 1) % face.size()]));
    }
    for (const auto& [a, b] : edges) edge(a, b, mesh_color);
  }
  void operator()(const Cluster&) const { frame(); }
  void operator()(const Locator&) const { frame(); }

 private:
  void add(const PointsD& points, const Color& color) const {
    Polyline line;
    line.color = color;
    line.hidden = true;
    for (Eigen::Index r = 0; r < points.rows(); ++r) line.points.push_back(points.row(r).transpose());
    lines_.push_back(std::move(line));
  }
  void edge(int a, int b, const Color& color) const {
    PointsD ends(2, 3);
    ends << controls_.row(a), controls_.row(b);
    add(ends, color);
  }
  void frame() const {
    for (int axis = 0; axis < 3; ++axis) {
      PointsD ends = controls_.row(0).replicate(2, 1);
      const Eigen::RowVector3d way = size_ * axes_.col(axis).normalized().transpose();
      ends.row(0) -= way;
      ends.row(1) += way;
      if (ends.allFinite()) add(ends, frame_color);
    }
  }

  const PointsD& controls_;
  Eigen::Matrix3d axes_;
  double size_;
  std::vector<Polyline>& lines_;
};

}  // namespace

std::vector<Polyline> object_lines(const Character& character, const Pose& pose) {
  std::vector<Polyline> lines;
  if (character.objects.empty()) return lines;
  Eigen::AlignedBox3d box;
  for (const Points& part : evaluate(character, pose))
    for (Eigen::Index v = 0; v < part.rows(); ++v) box.extend(part.row(v).transpose().cast<double>());
  const std::vector<Eigen::Matrix4d> model = posed_matrices(character, pose);
  const InfluenceField field(character, posed_matrices(character, rest_pose(character)));
  const std::vector<ObjectPose> poses = field.pose(model, pose.shape_weights, pose.objects);
  for (std::size_t o = 0; o < character.objects.size(); ++o) {
    const InfluenceObject& object = character.objects[o];
    const PointsD controls = field.place(static_cast<int>(o), poses[o], model);
    const int node = object.node >= 0 ? object.node : object.carrier;
    const Eigen::Matrix3d axes =
        node >= 0 ? Eigen::Matrix3d(model[static_cast<std::size_t>(node)].topLeftCorner<3, 3>())
                  : Eigen::Matrix3d::Identity();
    std::visit(LineDrawer(controls, axes, box.isEmpty() ? 0 : frame_size * box.diagonal().norm(), lines),
               object.form);
  }
  return lines;
}

}  // namespace mien
