#include "mien/evaluate/detail/object_motion.h"

#include <algorithm>

#include "mien/character/object_problems.h"

namespace mien::detail {
namespace {

JointChain all_nodes(const Character& character) {
  JointChain chain;
  for (int n = 0; n < static_cast<int>(character.nodes.size()); ++n) chain.add_node(character, n);
  return chain;
}

/// Marks the node and all above it.
void mark_up(const Character& character, int node, std::vector<int>& marks) {
  for (; node >= 0; node = character.nodes[node].parent) ++marks[node];
}

}  // namespace

ObjectRows::ObjectRows(const Character& character, const ConstraintSolver& constraints)
    : nodes_(character.nodes),
      chain_(all_nodes(character)),
      field_(character, rest_of(character, constraints)) {
  for (const InfluenceObject& object : character.objects) {
    control_begin_.push_back(control_begin_.back() + static_cast<int>(object.controls.rows()));
    is_frame_.push_back(mien::is_frame(object.form));
  }
  find_movers(character, !constraints.empty());
}

/// By the same steps as every pose: where nothing has moved, matrices are equal bit for bit.
std::vector<Eigen::Matrix4d> ObjectRows::rest_of(const Character& character,
                                                 const ConstraintSolver& constraints) const {
  std::vector<Transform> locals = rest_pose(character).locals;
  constraints.apply(locals);
  std::vector<Affine> links, nodes;
  std::vector<Eigen::Matrix4d> rest;
  place_nodes(locals, links, nodes, rest);
  return rest;
}

/// A node moves an object when it is above one of what moves the object and not above all of it and its carrier.
void ObjectRows::find_movers(const Character& character, bool is_constrained) {
  is_moved_by_.assign(character.nodes.size(), is_constrained && !character.objects.empty());
  for (const InfluenceObject& object : character.objects) {
    std::vector<int> marks(character.nodes.size(), 0);
    std::vector<int> own;
    if (object.node >= 0) own.push_back(object.node);
    if (object.skin >= 0)
      own.insert(own.end(), character.skins[object.skin].joints.begin(),
                 character.skins[object.skin].joints.end());
    for (const int node : own) mark_up(character, node, marks);
    mark_up(character, object.carrier, marks);
    const int all = static_cast<int>(own.size()) + (object.carrier >= 0 ? 1 : 0);
    const bool is_in_model_space = object.carrier < 0;
    for (std::size_t n = 0; n < marks.size(); ++n)
      if (marks[n] > 0 && (marks[n] < all || is_in_model_space)) is_moved_by_[n] = 1;
  }
}

void ObjectRows::place_nodes(const std::vector<Transform>& locals, std::vector<Affine>& links,
                             std::vector<Affine>& nodes, std::vector<Eigen::Matrix4d>& model) const {
  chain_.evaluate(nodes_, locals, links, nodes);
  model.resize(nodes.size(), Eigen::Matrix4d::Identity());
  for (std::size_t n = 0; n < nodes.size(); ++n) model[n].topRows<3>() << nodes[n].linear, nodes[n].origin;
}

}  // namespace mien::detail
