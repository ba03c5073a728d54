#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"
#include "mien/io/detail/point.h"

// The MIEN_character extension, both ways; docs/io.md is its specification. A program that does not know it
// sees a plain glTF. When another program changed a mesh so that the extension no longer fits it, the mesh is
// read as plain.

namespace mien::detail {
namespace {

/// -1 is "none": stored one higher, because accessors hold no negative indices.
std::vector<std::uint32_t> one_higher(const std::vector<int>& numbers) {
  std::vector<std::uint32_t> result(numbers.size());
  std::transform(numbers.begin(), numbers.end(), result.begin(),
                 [](int number) { return static_cast<std::uint32_t>(number + 1); });
  return result;
}

/// Each row's entry in the UV set, when every corner of a row uses the same one; otherwise nothing.
std::vector<int> entry_of_rows(const UvSet& uv, const SplitMesh& split) {
  std::vector<int> entry(split.rows(), -1);
  std::vector<bool> known(split.rows(), false);
  for (std::size_t c = 0; c < split.corner_row.size(); ++c) {
    const int row = split.corner_row[c];
    if (known[row] && entry[row] != uv.corners[c]) return {};
    entry[row] = uv.corners[c];
    known[row] = true;
  }
  return entry;
}

Json vendor_uv(const UvSet& uv, const SplitMesh& split, GltfBuilder& builder) {
  if (uv.corners.empty()) return Json::object();
  Json description = {{"count", uv.coordinates.rows()}};
  const std::vector<int> entry = entry_of_rows(uv, split);
  if (!entry.empty())
    description["rows"] = builder.add_numbers(one_higher(entry));
  else
    description["corners"] = builder.add_numbers(one_higher(uv.corners));
  return description;
}

}  // namespace

Json vendor_point(const SurfacePoint& point) {
  Json json = {{"mesh", point.part}};
  add_place_on_part(point, json);
  return json;
}

int part_of_mesh(const JsonObject& source, const std::vector<PartSource>& sources) {
  const auto mesh = source.integer("mesh", 0, 1 << 30);
  const auto part =
      std::find_if(sources.begin(), sources.end(), [&](const PartSource& s) { return s.mesh == mesh; });
  return part == sources.end() ? -1 : static_cast<int>(part - sources.begin());
}

int used_part_of_mesh(const JsonObject& source, const std::vector<PartSource>& sources) {
  const int part = part_of_mesh(source, sources);
  if (part < 0)
    throw io_error(source.place_of("mesh"), fmt::format("is {}", source.integer("mesh", 0, 1 << 30)),
                   "name a mesh in use");
  return part;
}

SurfacePoint read_vendor_point(const JsonObject& source, const std::vector<PartSource>& sources,
                               const Character& character) {
  SurfacePoint point;
  point.part = used_part_of_mesh(source, sources);
  const Mesh& surface = character.parts[point.part].mesh;
  if (!source.has("face")) {
    point.vertex = source.index("vertex", surface.vertex_count());
    return point;
  }
  point.face = source.index("face", surface.faces.size());
  const std::vector<double> weights = source.numbers("barycentric", 3);
  if (weights.size() != 3) throw io_error(source.place(), "has no \"barycentric\"", "give three numbers");
  point.barycentric = Eigen::Map<const Eigen::Vector3d>(weights.data());
  const std::vector<int> corners = source.indices("corners", surface.faces[point.face].size());
  if (corners.size() == 3) std::copy(corners.begin(), corners.end(), point.corners.begin());
  return point;
}

namespace {

/// Puts one mesh back as it was before it was split for glTF.
class Restorer {
 public:
  Restorer(GltfDocument& document, const JsonObject& vendor, Part& part)
      : document_(document),
        vendor_(vendor),
        part_(part),
        rows_(static_cast<int>(part.mesh.vertex_count())) {}

  /// False: the extension does not fit the mesh, which stays as it is.
  bool run(std::vector<PartDelta*> deltas);

 private:
  bool read_copies();
  bool read_faces();
  bool read_uvs();
  void read_groups();
  void drop_copies(const std::vector<PartDelta*>& deltas);
  int accessor(const JsonObject& owner, const char* key) const {
    return owner.index_or_none(key, document_.count("accessors"));
  }

  GltfDocument& document_;
  const JsonObject& vendor_;
  Part& part_;
  int rows_, vertex_count_ = 0;
  std::vector<std::uint32_t> copy_of_;
  Faces faces_;                  ///< n-gons over vertices
  std::vector<int> corner_row_;  ///< their rows in the file
  std::vector<UvSet> uvs_;
};

bool Restorer::run(std::vector<PartDelta*> deltas) {
  if (!read_copies() || !read_faces() || !read_uvs()) return false;
  part_.mesh.faces = std::move(faces_);
  part_.mesh.uvs = std::move(uvs_);
  read_groups();
  drop_copies(deltas);
  if (vendor_.truth_or("normalsComputed", false)) part_.mesh.normals.resize(0, 3);
  return true;
}

bool Restorer::read_copies() {
  vertex_count_ = static_cast<int>(vendor_.integer("vertexCount", 0, 1 << 30));
  const int copies = accessor(vendor_, "copies");
  if (copies >= 0) copy_of_ = document_.integers(copies, 1);
  return vertex_count_ + static_cast<std::int64_t>(copy_of_.size()) == rows_ &&
         std::all_of(copy_of_.begin(), copy_of_.end(),
                     [&](std::uint32_t v) { return v < static_cast<std::uint32_t>(vertex_count_); });
}

/// Consecutive triangles of one fan become their n-gon again.
bool Restorer::read_faces() {
  const Faces& triangles = part_.mesh.faces;
  std::vector<std::uint32_t> sizes(triangles.size(), 3);
  if (const int accessor_index = accessor(vendor_, "faceSizes"); accessor_index >= 0)
    sizes = document_.integers(accessor_index, 1);
  std::size_t t = 0;
  std::vector<int> face, rows;
  for (const std::uint32_t size : sizes) {
    if (size < 3 || size - 2 > triangles.size() - t) return false;
    rows.assign(triangles[t].begin(), triangles[t].end());
    for (std::uint32_t k = 1; k + 2 < size; ++k) {
      const auto next = triangles[t + k];
      if (next[0] != rows[0] || next[1] != rows.back()) return false;
      rows.push_back(next[2]);
    }
    t += size - 2;
    face.clear();
    for (const int row : rows)
      face.push_back(row < vertex_count_ ? row : static_cast<int>(copy_of_[row - vertex_count_]));
    faces_.push_back(face);
    corner_row_.insert(corner_row_.end(), rows.begin(), rows.end());
  }
  return t == triangles.size();
}

bool Restorer::read_uvs() {
  uvs_ = part_.mesh.uvs;
  const std::vector<JsonObject> descriptions = vendor_.objects("uvs");
  if (descriptions.empty()) return copy_of_.empty() || uvs_.empty();
  if (descriptions.size() != uvs_.size()) return false;
  for (std::size_t set = 0; set < uvs_.size(); ++set) {
    const JsonObject& description = descriptions[set];
    if (!description.has("count")) {
      uvs_[set].coordinates.conservativeResize(vertex_count_, Eigen::NoChange);
      continue;
    }
    const bool by_row = description.has("rows");
    const auto entries =
        document_.integers(description.index(by_row ? "rows" : "corners", document_.count("accessors")), 1);
    if (entries.size() != (by_row ? static_cast<std::size_t>(rows_) : corner_row_.size())) return false;
    // No more coordinates than corners: a larger count would be one that nothing backs.
    const auto count =
        description.integer("count", 0, static_cast<std::int64_t>(16 * corner_row_.size() + 65536));
    UvSet uv;
    uv.coordinates = Points2::Zero(count, 2);
    uv.corners.resize(corner_row_.size());
    for (std::size_t c = 0; c < corner_row_.size(); ++c) {
      const std::uint32_t entry = entries[by_row ? static_cast<std::size_t>(corner_row_[c]) : c];
      if (entry > static_cast<std::uint64_t>(count)) return false;
      uv.corners[c] = static_cast<int>(entry) - 1;
      if (entry > 0) uv.coordinates.row(entry - 1) = uvs_[set].coordinates.row(corner_row_[c]);
    }
    uvs_[set] = std::move(uv);
  }
  return true;
}

void Restorer::read_groups() {
  if (!vendor_.has("groups")) return;  // the primitives say it all
  Mesh& mesh = part_.mesh;
  const int face_count = static_cast<int>(mesh.faces.size());
  mesh.groups.clear();
  int begin = 0;
  for (const JsonObject& source : vendor_.objects("groups")) {
    FaceGroup group;
    group.name = source.text_or("name", "");
    group.material = source.index_or_none("material", document_.count("materials"));
    group.face_begin = begin;
    group.face_end = begin = static_cast<int>(source.integer("end", begin, face_count));
    const auto range = source.numbers("vertices");
    group.vertex_end = vertex_count_;
    if (range.size() == 2 && range[0] >= 0 && range[0] <= range[1] && range[1] <= vertex_count_) {
      group.vertex_begin = static_cast<int>(range[0]);
      group.vertex_end = static_cast<int>(range[1]);
    }
    mesh.groups.push_back(std::move(group));
  }
  if (!mesh.groups.empty() && begin != face_count)
    throw io_error(vendor_.place_of("groups"), fmt::format("end at face {}", begin),
                   fmt::format("they must cover {} faces", face_count));
}

void Restorer::drop_copies(const std::vector<PartDelta*>& deltas) {
  if (copy_of_.empty()) return;
  Mesh& mesh = part_.mesh;
  mesh.positions.conservativeResize(vertex_count_, Eigen::NoChange);
  if (mesh.normals.rows() > 0) mesh.normals.conservativeResize(vertex_count_, Eigen::NoChange);
  if (mesh.tangents.rows() > 0) mesh.tangents.conservativeResize(vertex_count_, Eigen::NoChange);
  for (Points4& colors : mesh.colors) colors.conservativeResize(vertex_count_, Eigen::NoChange);
  for (VertexAttribute& attribute : mesh.attributes)
    attribute.values.resize(static_cast<std::size_t>(vertex_count_) * attribute.width);
  for (LooseElements& loose : mesh.loose)
    for (int& v : loose.vertices)
      if (v >= vertex_count_) v = static_cast<int>(copy_of_[v - vertex_count_]);
  if (!part_.skin_weights.empty()) {
    SkinWeights& skin = part_.skin_weights;
    skin.offsets.resize(vertex_count_ + 1);
    skin.joints.resize(skin.offsets.back());
    skin.weights.resize(skin.offsets.back());
  }
  for (PartDelta* delta : deltas) {
    const auto kept = std::lower_bound(delta->vertices.begin(), delta->vertices.end(), vertex_count_) -
                      delta->vertices.begin();
    delta->vertices.resize(kept);
    delta->deltas.conservativeResize(kept, Eigen::NoChange);
    if (delta->normal_deltas.rows() > 0) delta->normal_deltas.conservativeResize(kept, Eigen::NoChange);
    if (delta->tangent_deltas.rows() > 0) delta->tangent_deltas.conservativeResize(kept, Eigen::NoChange);
  }
}

bool groups_are_plain(const Mesh& mesh, const SplitMesh& split) {
  const std::vector<FaceGroup> primitives = primitive_groups(mesh, split);
  return split.copy_of.empty() && primitives == mesh.groups &&
         mesh.faces.corner_count() == 3 * mesh.faces.size() &&
         std::all_of(primitives.begin(), primitives.end(), [](const FaceGroup& g) { return g.name.empty(); });
}

}  // namespace

Json vendor_mesh(const Mesh& mesh, const SplitMesh& split, bool normals_computed, GltfBuilder& builder) {
  Json vendor = Json::object();
  if (!split.copy_of.empty()) {
    const std::vector<std::uint32_t> copies(split.copy_of.begin(), split.copy_of.end());
    vendor["copies"] = builder.add_numbers(copies);
  }
  std::vector<std::uint32_t> sizes(mesh.faces.size());
  for (std::size_t f = 0; f < sizes.size(); ++f) sizes[f] = static_cast<std::uint32_t>(mesh.faces[f].size());
  if (std::any_of(sizes.begin(), sizes.end(), [](std::uint32_t size) { return size != 3; }))
    vendor["faceSizes"] = builder.add_numbers(sizes);
  if (std::any_of(mesh.uvs.begin(), mesh.uvs.end(), [](const UvSet& uv) { return !uv.corners.empty(); }))
    for (const UvSet& uv : mesh.uvs) vendor["uvs"].push_back(vendor_uv(uv, split, builder));
  if (!groups_are_plain(mesh, split)) {
    vendor["groups"] = Json::array();
    for (const FaceGroup& group : mesh.groups) {
      Json description = {{"end", group.face_end}};
      if (!group.name.empty()) description["name"] = group.name;
      if (group.material >= 0) description["material"] = group.material;
      if (group.vertex_begin != 0 || group.vertex_end != split.vertex_count)
        description["vertices"] = {group.vertex_begin, group.vertex_end};
      vendor["groups"].push_back(std::move(description));
    }
  }
  if (mesh.faces.empty() && mesh.loose.empty()) vendor["points"] = true;
  if (normals_computed) vendor["normalsComputed"] = true;
  return vendor;
}

Json vendor_root(const Character& character, GltfBuilder& builder) {
  Json vendor = Json::object();
  for (const Landmark& landmark : character.landmarks) {
    Json json = vendor_point(landmark.at);
    json["name"] = landmark.name;
    vendor["landmarks"].push_back(std::move(json));
  }
  for (const LandmarkCurve& curve : character.curves) {
    Json json = {{"name", curve.name}, {"count", curve.count}, {"points", Json::array()}};
    for (const SurfacePoint& point : curve.points) json["points"].push_back(vendor_point(point));
    vendor["curves"].push_back(std::move(json));
  }
  write_sliders(character, vendor);
  write_wires(character, builder, vendor);
  write_constraints(character, vendor);
  write_controls(character, vendor);
  write_objects(character, builder, vendor);
  if (!character.name.empty()) vendor["name"] = character.name;
  if (!vendor.empty()) vendor["version"] = 1;
  return vendor;
}

void read_vendor(GltfDocument& document, const std::vector<PartSource>& sources, Character& character) {
  for (std::size_t p = 0; p < sources.size(); ++p) {
    const JsonObject mesh = document.element("meshes", sources[p].mesh);
    if (!mesh.has("extensions") || !mesh.object("extensions").has(vendor_extension)) continue;
    std::vector<PartDelta*> deltas;
    for (const int shape : sources[p].shapes)
      for (PartDelta& delta : character.shapes[shape].parts)
        if (delta.part == static_cast<int>(p)) deltas.push_back(&delta);
    const JsonObject vendor = mesh.object("extensions").object(vendor_extension);
    if (Restorer(document, vendor, character.parts[p]).run(deltas)) read_surface(vendor, character.parts[p]);
  }
  if (!document.root().has("extensions") || !document.root().object("extensions").has(vendor_extension))
    return;
  const JsonObject vendor = document.root().object("extensions").object(vendor_extension);
  if (vendor.integer("version", 1, 1 << 30) > 1)
    throw io_error(vendor.place_of("version"), "is newer than 1", "read it with a newer mien");
  character.name = vendor.text_or("name", "");
  read_sliders(vendor, character);
  read_wires(vendor, document, sources, character);
  read_constraints(vendor, character);
  read_controls(vendor, character);
  read_objects(vendor, document, sources, character);
  for (const JsonObject& source : vendor.objects("landmarks"))
    character.landmarks.push_back({source.text("name"), read_vendor_point(source, sources, character)});
  for (const JsonObject& source : vendor.objects("curves")) {
    LandmarkCurve curve;
    curve.name = source.text("name");
    curve.count = static_cast<int>(source.integer("count", 2, 10000));
    for (const JsonObject& point : source.objects("points"))
      curve.points.push_back(read_vendor_point(point, sources, character));
    character.curves.push_back(std::move(curve));
  }
}

std::string others_but_vendor(const JsonObject& source, std::initializer_list<const char*> keys) {
  const std::string text = source.others(keys);
  if (text.empty()) return text;
  Json others = Json::parse(text);
  if (others.contains("extensions") && others["extensions"].is_object()) {
    others["extensions"].erase(vendor_extension);
    if (others["extensions"].empty()) others.erase("extensions");
  }
  return others.empty() ? std::string() : json_text(others);
}

}  // namespace mien::detail
