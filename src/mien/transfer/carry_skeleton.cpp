#include "mien/transfer/carry_skeleton.h"

#include <Eigen/LU>
#include <algorithm>

#include "mien/core/error.h"
#include "mien/geometry/similarity.h"
#include "mien/transfer/detail/at.h"

namespace mien {
namespace {

using detail::at;

/// A matrix as translation, rotation, scale; false where it shears and the three cannot say it.
bool decompose(const Eigen::Matrix4d& matrix, Transform& transform) {
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  transform.translation = matrix.topRightCorner<3, 1>();
  transform.scale = linear.colwise().norm().transpose();
  if (linear.determinant() < 0) transform.scale = -transform.scale;
  const Eigen::Matrix3d rotation = closest_rotation(linear * transform.scale.cwiseInverse().asDiagonal());
  transform.rotation = Eigen::Quaterniond(rotation).normalized();
  return (transform.matrix() - matrix).topLeftCorner<3, 3>().norm() <= 1e-6 * linear.norm();
}

void set_local(Node& node, const Eigen::Matrix4d& local) {
  node.has_matrix = !decompose(local, node.rest);
  node.matrix = node.has_matrix ? local : Eigen::Matrix4d(Eigen::Matrix4d::Identity());
}

/// The model matrix after the map: moved, turned, its own scale kept.
Eigen::Matrix4d carry_matrix(const Eigen::Matrix4d& matrix, const SpaceMap& map) {
  const Eigen::Vector3d origin = matrix.topRightCorner<3, 1>();
  Eigen::Matrix4d carried = matrix;
  carried.topLeftCorner<3, 3>() = map.rotation(origin) * matrix.topLeftCorner<3, 3>();
  carried.topRightCorner<3, 1>() = map.position(origin);
  return carried;
}

std::vector<char> nodes_to_carry(const Character& source, const std::vector<int>& joint_of_node) {
  std::vector<char> holds_part(source.nodes.size(), 0), carry(source.nodes.size(), 0);
  for (const Part& part : source.parts)
    if (part.node >= 0) holds_part[at(part.node)] = 1;
  for (std::size_t n = 0; n < source.nodes.size(); ++n) {
    if (joint_of_node[n] < 0 && holds_part[n]) continue;
    for (int a = static_cast<int>(n); a >= 0 && !carry[at(a)]; a = source.nodes[at(a)].parent)
      carry[at(a)] = 1;
  }
  return carry;
}

/// Per joint of the joined list its matrix at bind time, in model space.
std::vector<Eigen::Matrix4d> bind_matrices(const Character& source, const JointList& joints,
                                           const std::vector<Eigen::Matrix4d>& model) {
  std::vector<Eigen::Matrix4d> bind;
  for (const int node : joints.nodes) bind.push_back(model[at(node)]);
  for (std::size_t s = source.skins.size(); s-- > 0;) {
    const Skin& skin = source.skins[s];
    for (std::size_t j = 0; j < skin.joints.size() && j < skin.inverse_bind.size(); ++j) {
      const Eigen::FullPivLU<Eigen::Matrix4d> lu(skin.inverse_bind[j]);
      if (!lu.isInvertible())
        throw invalid_input("skin " + skin.name + ", joint " + source.nodes[at(skin.joints[j])].name,
                            "its inverse bind matrix is singular", "an invertible matrix");
      bind[at(joints.skin_joint[s][j])] = lu.inverse();
    }
  }
  return bind;
}

}  // namespace

int holding_joint(const Character& source, const Part& part) {
  if (part.skin >= 0 || source.skins.empty() || part.node < 0) return -1;
  for (int n = source.nodes[at(part.node)].parent; n >= 0; n = source.nodes[at(n)].parent)
    for (const Skin& skin : source.skins)
      if (std::find(skin.joints.begin(), skin.joints.end(), n) != skin.joints.end()) return n;
  return -1;
}

JointList list_joints(const Character& source) {
  JointList list;
  list.joint_of_node.assign(source.nodes.size(), -1);
  const auto add = [&](int node) {
    int& joint = list.joint_of_node[at(node)];
    if (joint < 0) {
      joint = static_cast<int>(list.nodes.size());
      list.nodes.push_back(node);
    }
    return joint;
  };
  for (const Skin& skin : source.skins) {
    list.skin_joint.emplace_back();
    for (const int node : skin.joints) list.skin_joint.back().push_back(add(node));
  }
  for (const Part& part : source.parts) {
    const int node = holding_joint(source, part);
    if (node >= 0) add(node);
  }
  return list;
}

CarriedSkeleton carry_skeleton(const Character& source, const SpaceMap& map, int first_node) {
  CarriedSkeleton result;
  const auto model = model_matrices(source);
  const JointList joints = list_joints(source);
  const auto bind = bind_matrices(source, joints, model);

  // A joint's rest may differ from its bind pose (a character saved in a pose): the difference stays its own.
  std::vector<Eigen::Matrix4d> carried_model(source.nodes.size());
  result.growth.assign(source.nodes.size(), 1);
  std::vector<Eigen::Matrix4d> carried_bind(bind.size());
  for (std::size_t n = 0; n < source.nodes.size(); ++n) {
    const Eigen::Vector3d origin = model[n].topRightCorner<3, 1>();
    result.growth[n] = map.scale(origin);
    carried_model[n] = carry_matrix(model[n], map);
    const int joint = joints.joint_of_node[n];
    if (joint < 0) continue;
    carried_bind[at(joint)] = carry_matrix(bind[at(joint)], map);
    Eigen::Matrix4d difference = bind[at(joint)].inverse() * model[n];
    difference.topRightCorner<3, 1>() *= result.growth[n];
    if (!difference.isIdentity(1e-5)) carried_model[n] = carried_bind[at(joint)] * difference;
  }

  const auto carry = nodes_to_carry(source, joints.joint_of_node);
  result.node_of.assign(source.nodes.size(), -1);
  int next = first_node;
  for (std::size_t n = 0; n < source.nodes.size(); ++n)
    if (carry[n]) result.node_of[n] = next++;
  for (std::size_t n = 0; n < source.nodes.size(); ++n) {
    if (!carry[n]) continue;
    Node node = source.nodes[n];
    const int parent = node.parent;
    node.parent = parent < 0 ? -1 : result.node_of[at(parent)];
    const Eigen::Matrix4d local =
        parent < 0 ? carried_model[n]
                   : Eigen::Matrix4d(carried_model[at(parent)].inverse() * carried_model[n]);
    set_local(node, local);
    result.nodes.push_back(std::move(node));
  }
  result.skin.name = source.skins.empty() ? "" : source.skins.front().name;
  if (!source.skins.empty()) result.skin.method = source.skins.front().method;
  for (std::size_t j = 0; j < joints.nodes.size(); ++j) {
    result.skin.inverse_bind.push_back(carried_bind[j].inverse());
    result.skin.joints.push_back(result.node_of[at(joints.nodes[j])]);
  }
  if (!source.skins.empty() && source.skins.front().skeleton >= 0)
    result.skin.skeleton = result.node_of[at(source.skins.front().skeleton)];
  return result;
}

}  // namespace mien
