#pragma once
/// The nodes that move anything, in an order in which parents come first, and what they do to points in a pose.

#include <Eigen/Geometry>
#include <map>
#include <utility>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pose.h"

namespace mien::detail {

/// x -> linear x + origin.
struct Affine {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return linear * x + origin; }
  Affine operator*(const Affine& first) const {
    return {linear * first.linear, linear * first.origin + origin};
  }
};
Affine affine(const Eigen::Matrix4d& matrix);
/// local_matrix of pose.h, without its last row.
Affine local_affine(const Node& node, const Transform& local);

/// What an evaluator keeps of a character: its nodes and its shapes' names, without surfaces.
Character outline(const Character& character);

/// One carrier of points: a joint of a skin, or a node that holds a part without one.
struct Carrier {
  int link = 0;  ///< index into JointChain's links
  Affine inverse_bind;
};

class JointChain {
 public:
  struct Link {
    int node = 0;     ///< index into Character::nodes
    int parent = -1;  ///< index into the links, -1: a root
  };

  /// The carrier's index for joint `joint` of skin `skin`; adds it and the nodes above it when new.
  ///   throws  invalid_input: an index out of range, a cycle among the parents
  int add_joint(const Character& character, int skin, int joint);
  /// The same for a node that holds a part.
  int add_node(const Character& character, int node);

  const std::vector<Link>& links() const { return links_; }
  const std::vector<Carrier>& carriers() const { return carriers_; }
  /// The link of this node, or -1: it moves no point.
  int link_of(int node) const;

  /// Node to model space for every link, and bind pose (or part's space) to model space for every carrier.
  /// Both are resized; `locals` have been checked.
  void evaluate(const std::vector<Node>& nodes, const std::vector<Transform>& locals,
                std::vector<Affine>& model, std::vector<Affine>& carried) const;

 private:
  int add_link(const Character& character, int node);
  std::vector<Link> links_;
  std::vector<Carrier> carriers_;
  std::vector<int> link_of_node_;                  // #N, -1: none
  std::map<std::pair<int, int>, int> carrier_of_;  // by (skin, joint), or (-1, node)
};

}  // namespace mien::detail
