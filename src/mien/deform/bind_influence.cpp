// Where an object lies and how far it acts are two questions: a lip's curve must not pull the other lip, so distances go along the
// skin, from the vertices under the object; the point of the object that a vertex follows is the closest in space, which varies
// smoothly over a face and needs no path.
#include "mien/deform/bind_influence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>

#include "mien/character/object_problems.h"
#include "mien/character/weld.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/deform/detail/influence_target.h"
#include "mien/deform/wires.h"
#include "mien/geometry/geodesic.h"
#include "mien/geometry/surface_query.h"

namespace mien {
namespace {

/// Weights below this move nothing that a float would hold.
constexpr double least_weight = 1e-4;
double falloff(const InfluenceReach& reach, double distance) {
  const double x = std::max(0.0, distance - reach.full) / (reach.range - reach.full);
  return x < 1 ? reach.strength * (x * x - 1) * (x * x - 1) : 0;
}

/// A vertex's weight, 0: not bound.
using Weights = std::vector<double>;

class Binder {
 public:
  Binder(const Character& character, const InfluenceObject& object, const InfluenceReach& reach)
      : character_(character),
        object_(object),
        reach_(reach),
        place_("object " + object.name),
        is_lattice_(std::holds_alternative<Lattice>(object.form)) {
    check();
    target_ = detail::target_of(object, reach.smoothing);
  }

  std::vector<InfluenceBinding> run() const {
    std::vector<InfluenceBinding> bindings;
    const auto keep = [&](InfluenceBinding binding) {
      if (!binding.vertices.empty()) bindings.push_back(std::move(binding));
    };
    if (!reach_.drawn.empty())
      for (const VertexWeights& drawn : reach_.drawn) keep(bind_part(drawn.part, drawn_weights(drawn)));
    else if (is_lattice_)
      for (const int part : parts()) keep(bind_part(part, lattice_weights(part)));
    else if (reach_.geodesic)
      for (const int part : parts()) keep(bind_part(part, weights_along(part)));
    else
      for (const int part : parts()) keep(bind_part(part, weights_through_space(part)));
    if (bindings.empty())
      throw invalid_input(place_, is_lattice_ ? "holds no vertex" : "reaches no vertex",
                          is_lattice_ ? "a lattice around some of the skin"
                                      : "a longer range, or a place nearer to the skin");
    return bindings;
  }

 private:
  void check() const;
  std::vector<int> parts() const;
  Weights drawn_weights(const VertexWeights& drawn) const;
  Weights lattice_weights(int part) const;
  Weights weights_along(int part) const;
  Weights weights_through_space(int part) const;
  InfluenceBinding bind_part(int part, const Weights& weights) const;
  std::size_t count_of(int part) const { return character_.parts[part].mesh.vertex_count(); }

  const Character& character_;
  const InfluenceObject& object_;
  const InfluenceReach& reach_;
  std::string place_;
  bool is_lattice_;
  std::unique_ptr<detail::InfluenceTarget> target_;
};

void Binder::check() const {
  const auto fail = [&](const std::string& text, const std::string& remedy) {
    throw invalid_input(place_, text, remedy);
  };
  if (const std::string fault = fault_of(object_.form, static_cast<std::size_t>(object_.controls.rows()));
      !fault.empty())
    fail(fault, std::string("a ") + name_of(object_.form) + " that fits its control points");
  if (!object_.controls.allFinite()) fail("has control points that are not finite", "finite numbers");
  if (!is_lattice_ && reach_.drawn.empty()) {
    if (!std::isfinite(reach_.full) || reach_.full < 0)
      fail("has full weight up to " + std::to_string(reach_.full), "a length, 0 or more");
    if (!std::isfinite(reach_.range) || !(reach_.range > reach_.full))
      fail("has range " + std::to_string(reach_.range),
           reach_.full > 0 ? "a length above that of full weight" : "a length above 0");
  }
  if (!(reach_.strength > 0 && reach_.strength <= 1))
    fail("has strength " + std::to_string(reach_.strength), "above 0 and at most 1");
  if (!(reach_.fade >= 0 && reach_.fade <= 0.5))
    fail("fades over " + std::to_string(reach_.fade) + " of its sides", "0 to 0.5");
  if (reach_.smoothing < 1)
    fail("shares a vertex among " + std::to_string(reach_.smoothing) + " triangles", "1 or more");
  const auto count = static_cast<int>(character_.parts.size());
  for (const int part : reach_.parts)
    if (part < 0 || part >= count)
      fail("is to reach part " + std::to_string(part), "one from 0 to " + std::to_string(count - 1));
  int before = -1;
  for (const VertexWeights& drawn : reach_.drawn) {
    if (drawn.part <= before || drawn.part >= count)
      fail("has weights drawn on part " + std::to_string(drawn.part),
           "parts that exist, each once, ascending");
    before = drawn.part;
  }
}

/// The parts to look at. Along the skin and with none given: the one whose vertices are nearest to the object on the whole.
std::vector<int> Binder::parts() const {
  if (!reach_.parts.empty()) return reach_.parts;
  std::vector<int> all;
  for (std::size_t p = 0; p < character_.parts.size(); ++p)
    if (count_of(static_cast<int>(p)) > 0) all.push_back(static_cast<int>(p));
  if (is_lattice_ || !reach_.geodesic) return all;
  const PointsD samples = target_->samples();
  double least = std::numeric_limits<double>::infinity();
  int nearest = -1;
  for (const int part : all) {
    const PointsD positions = bind_positions(character_, part);
    double sum = 0;
    for (Eigen::Index s = 0; s < samples.rows(); s += 4)
      sum += std::sqrt((positions.rowwise() - samples.row(s)).rowwise().squaredNorm().minCoeff());
    if (!(sum < least)) continue;
    least = sum;
    nearest = part;
  }
  return nearest < 0 ? std::vector<int>{} : std::vector<int>{nearest};
}

Weights Binder::drawn_weights(const VertexWeights& drawn) const {
  Weights weights(count_of(drawn.part), 0.0);
  const std::string place = place_ + ": part " + character_.parts[drawn.part].name;
  if (drawn.weights.size() != drawn.vertices.size())
    throw invalid_input(place, "has " + std::to_string(drawn.weights.size()) + " drawn weights",
                        std::to_string(drawn.vertices.size()) + ", one a vertex");
  for (std::size_t k = 0; k < drawn.vertices.size(); ++k) {
    const int vertex = drawn.vertices[k];
    if (vertex < 0 || vertex >= static_cast<int>(weights.size()))
      throw invalid_input(place, "has a weight drawn on vertex " + std::to_string(vertex),
                          "one from 0 to " + std::to_string(static_cast<int>(weights.size()) - 1));
    if (!(drawn.weights[k] > 0 && drawn.weights[k] <= 1))
      throw invalid_input(place + ", vertex " + std::to_string(vertex),
                          "has weight " + std::to_string(drawn.weights[k]), "above 0 and at most 1");
    weights[static_cast<std::size_t>(vertex)] = drawn.weights[k];
  }
  return weights;
}

Weights Binder::lattice_weights(int part) const {
  const PointsD positions = bind_positions(character_, part);
  const auto& lattice = std::get<Lattice>(object_.form);
  Weights weights(count_of(part), 0.0);
  parallel_for(weights.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto at = lattice_coordinates(lattice, object_.controls,
                                          positions.row(static_cast<Eigen::Index>(v)).transpose());
      if (!at) continue;
      weights[v] = reach_.strength;
      for (int axis = 0; axis < 3 && reach_.fade > 0; ++axis) {
        const double t = std::min(1.0, std::min((*at)[axis], 1 - (*at)[axis]) / reach_.fade);
        weights[v] *= t * t * (3 - 2 * t);
      }
    }
  });
  return weights;
}

Weights Binder::weights_through_space(int part) const {
  const PointsD positions = bind_positions(character_, part);
  Weights weights(count_of(part), 0.0);
  parallel_for(weights.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      weights[v] =
          falloff(reach_, target_->distance(positions.row(static_cast<Eigen::Index>(v)).transpose()));
  });
  return weights;
}

Weights Binder::weights_along(int part) const {
  const PointsD positions = bind_positions(character_, part);
  const Weld weld = weld_seams(character_, part);
  PointsD welded(static_cast<Eigen::Index>(weld.size()), 3);
  for (std::size_t w = 0; w < weld.size(); ++w)
    welded.row(static_cast<Eigen::Index>(w)) = positions.row(weld.representative[w]);
  std::map<int, double> under;
  const PointsD samples = target_->samples();
  for (Eigen::Index s = 0; s < samples.rows(); ++s) {
    Eigen::Index vertex = 0;
    (welded.rowwise() - samples.row(s)).rowwise().squaredNorm().minCoeff(&vertex);
    const auto [found, added] = under.emplace(static_cast<int>(vertex), 0.0);
    if (added) found->second = target_->distance(welded.row(vertex).transpose());
  }
  std::vector<GeodesicSeed> seeds;
  for (const auto& [vertex, distance] : under)
    if (distance < reach_.range) seeds.push_back({vertex, distance, 0});
  Weights weights(count_of(part), 0.0);
  if (seeds.empty()) return weights;
  const Geodesics geodesics(welded, triangulate(weld_faces(character_.parts[part].mesh.faces, weld)));
  const GeodesicField field = geodesics.distances(seeds, reach_.range);
  for (std::size_t v = 0; v < weights.size(); ++v) weights[v] = falloff(reach_, field.distance[weld.of[v]]);
  return weights;
}

InfluenceBinding Binder::bind_part(int part, const Weights& weights) const {
  InfluenceBinding binding;
  binding.part = part;
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (weights[v] >= least_weight) {
      binding.vertices.push_back(static_cast<int>(v));
      binding.weights.push_back(static_cast<float>(weights[v]));
    }
  if (is_frame(object_.form)) return binding;
  const PointsD positions = bind_positions(character_, part);
  std::vector<detail::ControlShares> shares(binding.vertices.size());
  parallel_for(shares.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      shares[k] = target_->shares(positions.row(binding.vertices[k]).transpose());
  });
  binding.offsets.push_back(0);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    if (shares[k].empty())
      throw invalid_input(place_ + ": part " + character_.parts[part].name,
                          "has a weight drawn on vertex " + std::to_string(binding.vertices[k]) +
                              ", which is outside of the lattice",
                          "vertices inside");
    for (const auto& [control, share] : shares[k]) {
      binding.controls.push_back(control);
      binding.coefficients.push_back(static_cast<float>(share));
    }
    binding.offsets.push_back(static_cast<int>(binding.controls.size()));
  }
  return binding;
}

/// The closest point's skin weights on the nearest part that has them, added up by joint.
class SkinBelow {
 public:
  SkinBelow(const Character& character, int skin) : character_(character) {
    for (std::size_t p = 0; p < character.parts.size(); ++p) {
      const Part& part = character.parts[p];
      if (part.skin != skin || part.skin_weights.empty() || part.mesh.faces.empty()) continue;
      parts_.push_back(static_cast<int>(p));
      triangles_.push_back(triangulate(part.mesh.faces));
      queries_.emplace_back(bind_positions(character, static_cast<int>(p)), triangles_.back());
    }
  }
  bool empty() const { return parts_.empty(); }

  std::map<int, double> at(const Eigen::Vector3d& point) const {
    SurfaceQuery::Hit best;
    std::size_t on = 0;
    for (std::size_t q = 0; q < queries_.size(); ++q) {
      const SurfaceQuery::Hit hit = queries_[q].closest(point);
      if (hit.distance < best.distance) {
        best = hit;
        on = q;
      }
    }
    std::map<int, double> joints;
    const SkinWeights& skin = character_.parts[parts_[on]].skin_weights;
    for (int k = 0; k < 3 && best.triangle >= 0; ++k) {
      const int vertex = triangles_[on](best.triangle, k);
      for (int i = skin.offsets[vertex]; i < skin.offsets[vertex + 1]; ++i)
        joints[skin.joints[i]] += best.barycentric[k] * skin.weights[i];
    }
    return joints;
  }

 private:
  const Character& character_;
  std::vector<int> parts_;
  std::vector<Triangles> triangles_;
  std::vector<SurfaceQuery> queries_;
};

}  // namespace

std::vector<InfluenceBinding> bind_influence(const Character& character, const InfluenceObject& object,
                                             const InfluenceReach& reach) {
  return Binder(character, object, reach).run();
}

SkinWeights bind_controls(const Character& character, const PointsD& controls, int skin,
                          std::span<const int> only) {
  if (skin < 0 || skin >= static_cast<int>(character.skins.size()))
    throw invalid_input("skin " + std::to_string(skin), "does not exist", "one of the character's");
  const std::vector<int>& joints = character.skins[skin].joints;
  std::vector<int> allowed;
  for (const int node : only) {
    const auto found = std::find(joints.begin(), joints.end(), node);
    if (found == joints.end())
      throw invalid_input(
          "node " + (node >= 0 && node < static_cast<int>(character.nodes.size()) ? character.nodes[node].name
                                                                                  : std::to_string(node)),
          "is not a joint of the skin", "one of its joints");
    allowed.push_back(static_cast<int>(found - joints.begin()));
  }
  const SkinBelow below(character, skin);
  if (below.empty())
    throw invalid_input("skin " + std::to_string(skin), "is on no part", "a skin with skin weights");
  SkinWeights weights;
  weights.offsets.push_back(0);
  for (Eigen::Index c = 0; c < controls.rows(); ++c) {
    std::map<int, double> found = below.at(controls.row(c).transpose());
    if (!allowed.empty())
      std::erase_if(found, [&](const auto& entry) {
        return std::find(allowed.begin(), allowed.end(), entry.first) == allowed.end();
      });
    double total = 0;
    for (const auto& [joint, share] : found) total += share;
    if (!(total > least_weight)) found = {{allowed.empty() ? 0 : allowed.front(), total = 1}};
    for (const auto& [joint, share] : found) {
      if (!(share > 0)) continue;
      weights.joints.push_back(joint);
      weights.weights.push_back(static_cast<float>(share / total));
    }
    weights.offsets.push_back(static_cast<int>(weights.joints.size()));
  }
  return weights;
}

}  // namespace mien
