#pragma once
/// Surface points taken apart: the vertices that they lie between, and what moves those.

#include <map>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/deform/wires.h"
#include "mien/evaluate/detail/joint_chain.h"

namespace mien::detail {

/// A vertex that a point needs.
struct Site {
  int column = 0;  // index into PointSites::parts
  Eigen::Vector3d neutral;
  int delta_begin = 0, delta_end = 0;
  int wire_begin = 0, wire_end = 0;
  int object_begin = 0, object_end = 0;
  int influence_begin = 0, influence_end = 0;  // none: the site is in model space already
  bool is_dual_quaternion = false;
};

struct Delta {
  int shape = 0;
  Eigen::Vector3d move;
};

struct SiteInfluence {
  int carrier = 0;
  double weight = 1;
};

/// What an influence object does to a site: weight times what its frame does, or what its control points in [begin, end) do.
struct SiteObject {
  int object = 0;
  double weight = 1;
  int begin = 0, end = 0;
};

struct ControlShare {
  int control = 0;
  double coefficient = 1;
};

/// A point is the sum of weight x site over its terms.
struct Term {
  int point = 0, site = 0;
  double weight = 1;
};

struct PointSites {
  std::size_t point_count = 0;
  std::vector<int> parts;  // the parts that have sites
  std::vector<Site> sites;
  std::vector<Delta> deltas;
  std::vector<WireField::Entry> wire_entries;
  std::vector<Eigen::Matrix3d> to_part;  // by column: model space vectors to the part's space
  std::vector<SiteObject> objects;
  std::vector<ControlShare> shares;
  std::vector<SiteInfluence> influences;  // the strongest of a site first
  std::vector<Term> terms;
  JointChain chain;

  PointSites(const Character& character, const std::vector<SurfacePoint>& points);

 private:
  using Known = std::map<std::pair<int, int>, int>;  // (part, vertex) -> site
  void add_point(const Character& character, const SurfacePoint& point, Known& known);
  int add_site(const Character& character, int part, int vertex, Known& known);
  void add_influences(const Character& character, const Part& part, int vertex);
  void add_deltas(const Character& character, const Known& known);
  void add_wires(const Character& character, const Known& known);
  void add_objects(const Character& character, const Known& known);
};

}  // namespace mien::detail
