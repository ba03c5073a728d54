#include "mien/evaluate/detail/point_sites.h"

#include <algorithm>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

void check_point(const Character& character, const SurfacePoint& point, std::size_t index) {
  const std::string place = "point " + std::to_string(index);
  if (point.part < 0 || point.part >= static_cast<int>(character.parts.size()))
    throw invalid_input(place, "is on part " + std::to_string(point.part), "a part that exists");
  const Mesh& mesh = character.parts[point.part].mesh;
  if (point.face < 0) {
    if (point.vertex < 0 || point.vertex >= static_cast<int>(mesh.vertex_count()))
      throw invalid_input(place, "is on vertex " + std::to_string(point.vertex), "a vertex that exists");
    return;
  }
  if (point.face >= static_cast<int>(mesh.faces.size()))
    throw invalid_input(place, "is on face " + std::to_string(point.face), "a face that exists");
  const int corners = static_cast<int>(mesh.faces[point.face].size());
  for (const int corner : point.corners)
    if (corner < 0 || corner >= corners)
      throw invalid_input(place, "names corner " + std::to_string(corner), "a corner that its face has");
  if (!point.barycentric.allFinite())
    throw invalid_input(place, "has barycentric coordinates that are not finite", "finite numbers");
}

}  // namespace

PointSites::PointSites(const Character& character, const std::vector<SurfacePoint>& points) {
  Known known;
  for (std::size_t p = 0; p < points.size(); ++p) {
    check_point(character, points[p], p);
    add_point(character, points[p], known);
  }
  add_deltas(character, known);
  add_wires(character, known);
  add_objects(character, known);
}

void PointSites::add_point(const Character& character, const SurfacePoint& point, Known& known) {
  const int index = static_cast<int>(point_count++);
  if (point.face < 0) {
    terms.push_back({index, add_site(character, point.part, point.vertex, known), 1});
    return;
  }
  const auto face = character.parts[point.part].mesh.faces[point.face];
  for (int k = 0; k < 3; ++k)
    if (point.barycentric[k] != 0)
      terms.push_back(
          {index, add_site(character, point.part, face[point.corners[k]], known), point.barycentric[k]});
}

int PointSites::add_site(const Character& character, int part, int vertex, Known& known) {
  const auto [found, is_new] = known.try_emplace({part, vertex}, static_cast<int>(sites.size()));
  if (!is_new) return found->second;
  const auto column = std::find(parts.begin(), parts.end(), part);
  Site site;
  site.column = static_cast<int>(column - parts.begin());
  if (column == parts.end()) parts.push_back(part);
  site.neutral = character.parts[part].mesh.positions.row(vertex).cast<double>();
  site.influence_begin = static_cast<int>(influences.size());
  add_influences(character, character.parts[part], vertex);
  site.influence_end = static_cast<int>(influences.size());
  const int skin = character.parts[part].skin;
  site.is_dual_quaternion = skin >= 0 && site.influence_begin != site.influence_end &&
                            character.skins[skin].method == SkinningMethod::dual_quaternion;
  std::stable_sort(influences.begin() + site.influence_begin, influences.end(),
                   [](const SiteInfluence& a, const SiteInfluence& b) { return a.weight > b.weight; });
  sites.push_back(site);
  return found->second;
}

void PointSites::add_influences(const Character& character, const Part& part, int vertex) {
  if (part.skin < 0) {
    if (part.node >= 0) influences.push_back({chain.add_node(character, part.node), 1});
    return;
  }
  const SkinWeights& weights = part.skin_weights;
  if (weights.empty()) return;
  if (weights.offsets.size() != part.mesh.vertex_count() + 1)
    throw invalid_input("part " + part.name,
                        "has skin weights of " + std::to_string(weights.offsets.size()) + " offsets",
                        std::to_string(part.mesh.vertex_count() + 1) + ", one a vertex and the end");
  double total = 0;
  for (int i = weights.offsets[vertex]; i < weights.offsets[vertex + 1]; ++i) total += weights.weights[i];
  if (total <= 0) return;
  for (int i = weights.offsets[vertex]; i < weights.offsets[vertex + 1]; ++i)
    influences.push_back(
        {chain.add_joint(character, part.skin, weights.joints[i]), weights.weights[i] / total});
}

void PointSites::add_deltas(const Character& character, const Known& known) {
  std::vector<std::vector<Delta>> of_site(sites.size());
  for (std::size_t s = 0; s < character.shapes.size(); ++s)
    for (const PartDelta& delta : character.shapes[s].parts)
      for (auto site = known.lower_bound({delta.part, 0});
           site != known.end() && site->first.first == delta.part; ++site) {
        const auto at = std::lower_bound(delta.vertices.begin(), delta.vertices.end(), site->first.second);
        if (at == delta.vertices.end() || *at != site->first.second) continue;
        const auto row = static_cast<Eigen::Index>(at - delta.vertices.begin());
        of_site[site->second].push_back({static_cast<int>(s), delta.deltas.row(row).cast<double>()});
      }
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sites[i].delta_begin = static_cast<int>(deltas.size());
    deltas.insert(deltas.end(), of_site[i].begin(), of_site[i].end());
    sites[i].delta_end = static_cast<int>(deltas.size());
  }
}

void PointSites::add_wires(const Character& character, const Known& known) {
  const WireField field(character, character.wires);
  for (const int part : parts) to_part.push_back(field.to_part(part));
  for (const auto& [at, index] : known) {
    const WireField::PartRows& rows = field.parts()[at.first];
    Site& site = sites[index];
    site.wire_begin = site.wire_end = static_cast<int>(wire_entries.size());
    const auto vertex = std::lower_bound(rows.vertices.begin(), rows.vertices.end(), at.second);
    if (vertex == rows.vertices.end() || *vertex != at.second) continue;
    const auto row = vertex - rows.vertices.begin();
    wire_entries.insert(wire_entries.end(), rows.entries.begin() + rows.offsets[row],
                        rows.entries.begin() + rows.offsets[row + 1]);
    site.wire_end = static_cast<int>(wire_entries.size());
  }
}

void PointSites::add_objects(const Character& character, const Known& known) {
  for (const auto& [at, index] : known) {
    Site& site = sites[index];
    site.object_begin = static_cast<int>(objects.size());
    for (std::size_t o = 0; o < character.objects.size(); ++o)
      for (const InfluenceBinding& binding : character.objects[o].bindings) {
        const auto vertex = std::lower_bound(binding.vertices.begin(), binding.vertices.end(), at.second);
        if (binding.part != at.first || vertex == binding.vertices.end() || *vertex != at.second) continue;
        const auto k = static_cast<std::size_t>(vertex - binding.vertices.begin());
        SiteObject object{static_cast<int>(o), binding.weights[k], static_cast<int>(shares.size()), 0};
        for (int e = binding.offsets.empty() ? 0 : binding.offsets[k];
             e < (binding.offsets.empty() ? 0 : binding.offsets[k + 1]); ++e)
          shares.push_back({binding.controls[e], binding.coefficients[e]});
        object.end = static_cast<int>(shares.size());
        objects.push_back(object);
      }
    site.object_end = static_cast<int>(objects.size());
  }
}

}  // namespace mien::detail
