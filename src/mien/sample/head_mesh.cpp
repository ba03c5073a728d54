#include "mien/sample/detail/head_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

namespace mien::sample {

namespace {

/// UVs by face corner: the skin unrolled around the head, the crown's cap as an island above it.
class UvWriter {
 public:
  explicit UvWriter(const HeadMesh& head) : head_(head) {
    for (std::size_t q = 0; q < head.half.quads.size(); ++q)
      if (head.half.cap[q])
        for (int v : head.half.quads[q])
          box_.extend(Vector2d(head.half.points[v].x(), head.half.points[v].z()));
  }
  void corner(int half_vertex, bool mirrored, bool on_cap) {
    const Vector3d& p = head_.half.points[half_vertex];
    Vector2d uv = head_.half.uvs[half_vertex];
    if (on_cap) {
      const double scale = 0.17 / (box_.max().y() - box_.min().y());
      uv = Vector2d(0.5 + p.x() * scale, 0.985 - (p.z() - box_.min().y()) * scale);
    }
    if (mirrored) uv.x() = 1 - uv.x();
    const std::array<long, 3> key = {half_vertex, on_cap, std::lround(uv.x() * 1e6)};
    const auto [at, is_new] = rows_.try_emplace(key, static_cast<int>(coordinates_.size()));
    if (is_new) coordinates_.push_back(uv);
    corners_.push_back(at->second);
  }
  UvSet finish() const {
    UvSet set;
    set.coordinates.resize(coordinates_.size(), 2);
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      set.coordinates.row(i) = coordinates_[i].cast<float>();
    set.corners = corners_;
    return set;
  }

 private:
  const HeadMesh& head_;
  Eigen::AlignedBox2d box_;
  std::map<std::array<long, 3>, int> rows_;
  std::vector<Vector2d> coordinates_;
  std::vector<int> corners_;
};

}  // namespace

HeadMesh make_head(const HeadForm& form) {
  HeadMesh head;
  head.half = make_grid(form);
  add_eyelids(head.half, form);
  add_mouth(head.half, form);
  add_nostril(head.half, form);
  add_ear(head.half, form);
  relax(head.half, form);

  const int count = static_cast<int>(head.half.points.size());
  head.points = head.half.points;
  head.mirror.resize(count);
  for (int v = 0; v < count; ++v) {
    head.mirror[v] = v;
    if (head.half.midline[v]) continue;
    const int twin = static_cast<int>(head.points.size());
    const Vector3d& p = head.half.points[v];
    head.points.emplace_back(-p.x(), p.y(), p.z());
    head.mirror[v] = twin;
    head.mirror.push_back(v);
  }
  UvWriter uv(head);
  for (const bool mirrored : {false, true})
    for (std::size_t q = 0; q < head.half.quads.size(); ++q) {
      std::vector<int> corners(head.half.quads[q].begin(), head.half.quads[q].end());
      if (corners.back() < 0) corners.pop_back();
      if (mirrored) std::reverse(corners.begin(), corners.end());
      for (int v : corners) uv.corner(v, mirrored, head.half.cap[q]);
      if (mirrored)
        for (int& v : corners) v = head.mirror[v];
      head.faces.push_back(corners);
    }
  head.uv = uv.finish();
  return head;
}

}  // namespace mien::sample
