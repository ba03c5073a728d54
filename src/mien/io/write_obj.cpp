#include <fmt/format.h>

#include <Eigen/LU>
#include <iterator>
#include <string>

#include "mien/character/shown_parts.h"
#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/io/file.h"
#include "mien/io/obj.h"

namespace mien {
namespace {

/// Numbers of the first v, vt and vn of a part, from 1.
struct First {
  int vertex = 1, uv = 1, normal = 1;
};

class ObjWriter {
 public:
  explicit ObjWriter(const Character& character)
      : character_(character), matrices_(model_matrices(character)) {}
  std::string write();

 private:
  void write_points(const Part& part);
  void write_faces(const Part& part);
  void write_group(const FaceGroup& group, const FaceGroup* before);
  template <typename... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  const Character& character_;
  std::vector<Eigen::Matrix4d> matrices_;
  First first_;
  std::string text_;
};

std::string ObjWriter::write() {
  text_ = "# mien\n";
  const std::size_t count = shown_part_count(character_);
  for (std::size_t p = 0; p < count; ++p) {
    const Part& part = character_.parts[p];
    if (count > 1) line("o {}\n", part.name);
    write_points(part);
    write_faces(part);
    first_.vertex += static_cast<int>(part.mesh.vertex_count());
    if (!part.mesh.uvs.empty()) first_.uv += static_cast<int>(part.mesh.uvs[0].coordinates.rows());
    first_.normal += static_cast<int>(part.mesh.normals.rows());
  }
  return std::move(text_);
}

void ObjWriter::write_points(const Part& part) {
  const Mesh& mesh = part.mesh;
  const bool placed = part.node >= 0 && part.skin < 0 && !matrices_[part.node].isIdentity(0);
  const Eigen::Matrix4d matrix = placed ? matrices_[part.node] : Eigen::Matrix4d::Identity();
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    Eigen::Vector3f p = mesh.positions.row(v);
    if (placed) p = (linear * p.cast<double>() + matrix.topRightCorner<3, 1>()).cast<float>();
    line("v {} {} {}", p[0], p[1], p[2]);
    if (!mesh.colors.empty())
      line(" {} {} {}", mesh.colors[0](v, 0), mesh.colors[0](v, 1), mesh.colors[0](v, 2));
    text_ += '\n';
  }
  if (!mesh.uvs.empty())
    for (Eigen::Index t = 0; t < mesh.uvs[0].coordinates.rows(); ++t)
      line("vt {} {}\n", mesh.uvs[0].coordinates(t, 0), mesh.uvs[0].coordinates(t, 1));
  // Normals turn with the inverse transpose; a flat transform has none, and its cofactors serve.
  const Eigen::Matrix3d turn =
      std::abs(linear.determinant()) > 1e-300 ? Eigen::Matrix3d(linear.inverse().transpose()) : linear;
  for (Eigen::Index v = 0; v < mesh.normals.rows(); ++v) {
    Eigen::Vector3f n = mesh.normals.row(v);
    if (placed) n = (turn * n.cast<double>()).normalized().cast<float>();
    line("vn {} {} {}\n", n[0], n[1], n[2]);
  }
}

void ObjWriter::write_group(const FaceGroup& group, const FaceGroup* before) {
  if (!before || before->name != group.name)
    text_ += group.name.empty() ? (before ? "g default\n" : "") : "g " + group.name + "\n";
  if (group.material >= 0 && (!before || before->material != group.material)) {
    const std::string& name = character_.appearance.materials[group.material].name;
    line("usemtl {}\n", name.empty() ? "material_" + std::to_string(group.material) : name);
  }
}

void ObjWriter::write_faces(const Part& part) {
  const Mesh& mesh = part.mesh;
  const UvSet* uv = mesh.uvs.empty() ? nullptr : &mesh.uvs[0];
  std::size_t group = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    while (group < mesh.groups.size() && mesh.groups[group].face_begin == static_cast<int>(f)) {
      write_group(mesh.groups[group], group > 0 ? &mesh.groups[group - 1] : nullptr);
      ++group;
    }
    text_ += 'f';
    for (std::size_t c = 0; c < mesh.faces[f].size(); ++c) {
      const int vertex = mesh.faces[f][c];
      line(" {}", first_.vertex + vertex);
      const int entry = !uv ? -1 : uv->corners.empty() ? vertex : uv->corners[mesh.faces.offset(f) + c];
      if (entry >= 0) line("/{}", first_.uv + entry);
      if (mesh.normals.rows() > 0) line("{}{}", entry >= 0 ? "/" : "//", first_.normal + vertex);
    }
    text_ += '\n';
  }
}

}  // namespace

void write_obj(const Character& character, const std::filesystem::path& path) {
  try {
    require_valid(character);
    write_file_atomically(path, ObjWriter(character).write());
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
