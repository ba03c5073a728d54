#include "mien/evaluate/detail/joint_chain.h"

#include <algorithm>
#include <string>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

void check_index(const std::string& place, const char* what, int index, std::size_t count) {
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw invalid_input(
        place, std::string("names ") + what + " " + std::to_string(index),
        std::string("a ") + what + " from 0 to " + std::to_string(static_cast<int>(count) - 1));
}

}  // namespace

Affine affine(const Eigen::Matrix4d& matrix) {
  return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

Affine local_affine(const Node& node, const Transform& local) {
  if (node.has_matrix) return affine(local_matrix(node, local));
  return {local.rotation.toRotationMatrix() * local.scale.asDiagonal(), local.translation};
}

Character outline(const Character& character) {
  Character kept;
  kept.nodes = character.nodes;
  for (const Shape& shape : character.shapes) kept.shapes.push_back({shape.name, {}});
  kept.sliders = character.sliders;
  kept.correctives = character.correctives;
  return kept;
}

int JointChain::add_joint(const Character& character, int skin, int joint) {
  const auto [found, is_new] = carrier_of_.try_emplace({skin, joint}, static_cast<int>(carriers_.size()));
  if (!is_new) return found->second;
  check_index("character", "skin", skin, character.skins.size());
  const Skin& bound = character.skins[skin];
  check_index("skin " + bound.name, "joint", joint, std::min(bound.joints.size(), bound.inverse_bind.size()));
  carriers_.push_back({add_link(character, bound.joints[joint]), affine(bound.inverse_bind[joint])});
  return found->second;
}

int JointChain::add_node(const Character& character, int node) {
  const auto [found, is_new] = carrier_of_.try_emplace({-1, node}, static_cast<int>(carriers_.size()));
  if (is_new) carriers_.push_back({add_link(character, node), {}});
  return found->second;
}

int JointChain::add_link(const Character& character, int node) {
  link_of_node_.resize(character.nodes.size(), -1);
  std::vector<int> path;  // from the node up to the first one that is there already
  for (int n = node; n != -1; n = character.nodes[n].parent) {
    check_index("character", "node", n, character.nodes.size());
    if (link_of_node_[n] >= 0) break;
    if (path.size() > character.nodes.size())
      throw invalid_input("node " + std::to_string(node) + " (" + character.nodes[node].name + ")",
                          "is its own ancestor", "a hierarchy without cycles");
    path.push_back(n);
  }
  for (auto n = path.rbegin(); n != path.rend(); ++n) {
    const int parent = character.nodes[*n].parent;
    link_of_node_[*n] = static_cast<int>(links_.size());
    links_.push_back({*n, parent < 0 ? -1 : link_of_node_[parent]});
  }
  return link_of_node_[node];
}

int JointChain::link_of(int node) const {
  return static_cast<std::size_t>(node) < link_of_node_.size() ? link_of_node_[node] : -1;
}

void JointChain::evaluate(const std::vector<Node>& nodes, const std::vector<Transform>& locals,
                          std::vector<Affine>& model, std::vector<Affine>& carried) const {
  model.resize(links_.size());
  carried.resize(carriers_.size());
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const auto [node, parent] = links_[l];
    const Affine local = local_affine(nodes[node], locals[node]);
    model[l] = parent < 0 ? local : model[parent] * local;
  }
  for (std::size_t c = 0; c < carriers_.size(); ++c)
    carried[c] = model[carriers_[c].link] * carriers_[c].inverse_bind;
}

}  // namespace mien::detail
