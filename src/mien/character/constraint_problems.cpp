// A node depends on its parent, and on the sources and the up node of each constraint that it obeys. A circle among these has no
// answer, wherever it starts: each constraint is asked whether its node is found again upwards from what it follows.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "mien/character/validate.h"

namespace mien {
namespace {

/// Axes count as unit within this, as rotations in files of single precision are.
constexpr double unit_tolerance = 1e-3;

class ConstraintChecker {
 public:
  explicit ConstraintChecker(const Character& character) : character_(character) {}
  std::vector<Problem> run();

 private:
  bool has_nodes(const Constraint& constraint, const std::string& place);
  void check_sources(const Constraint& constraint, const std::string& place);
  void check_ranges(const Constraint& constraint, const std::string& place);
  void check_aim(const Constraint& constraint, const std::string& place);
  void check_circles();
  std::vector<int> circle_of(const Constraint& constraint) const;
  std::string name_of(int node) const {
    const std::string& name = character_.nodes[node].name;
    return name.empty() ? std::to_string(node) : name;
  }
  void add(const std::string& place, std::string text, std::string remedy) {
    problems_.push_back({place, std::move(text), std::move(remedy)});
  }

  const Character& character_;
  std::vector<std::vector<int>> follows_;  ///< by node: what it depends on
  std::vector<Problem> problems_;
};

bool ConstraintChecker::has_nodes(const Constraint& constraint, const std::string& place) {
  const int count = static_cast<int>(character_.nodes.size());
  std::vector<int> named{constraint.node};
  for (const ConstraintSource& source : constraint.sources) named.push_back(source.node);
  if (constraint.up_node != -1) named.push_back(constraint.up_node);
  for (const int node : named)
    if (node < 0 || node >= count) {
      add(place, "names node " + std::to_string(node), "there are " + std::to_string(count));
      return false;
    }
  return true;
}

void ConstraintChecker::check_sources(const Constraint& constraint, const std::string& place) {
  if (constraint.kind == Constraint::Kind::limit) {
    if (!constraint.sources.empty()) add(place, "is a limit with sources", "leave the sources out");
    return;
  }
  if (constraint.sources.empty()) return add(place, "has no sources", "name one or more nodes to follow");
  double sum = 0;
  for (const ConstraintSource& source : constraint.sources) {
    if (!(source.share >= 0) || !std::isfinite(source.share))
      return add(place, "gives " + name_of(source.node) + " a share that is negative or not finite",
                 "give 0 or more");
    sum += source.share;
  }
  if (!(sum > 0) || !std::isfinite(sum))
    add(place, "has shares that sum to no number above 0", "give one of them more");
}

void ConstraintChecker::check_ranges(const Constraint& constraint, const std::string& place) {
  const std::pair<const std::array<ValueRange, 3>*, const char*> kinds[] = {
      {&constraint.translation, "translation"},
      {&constraint.rotation, "rotation"},
      {&constraint.scale, "scale"}};
  for (const auto& [ranges, kind] : kinds)
    for (int a = 0; a < 3; ++a) {
      const auto [low, high] = (*ranges)[a];
      const bool some = low <= high && low < std::numeric_limits<double>::infinity() &&
                        high > -std::numeric_limits<double>::infinity();
      if (!some)
        add(place + ": " + kind + " " + "xyz"[a],
            "ranges from " + std::to_string(low) + " to " + std::to_string(high),
            "give a low that is not above its high");
    }
}

void ConstraintChecker::check_aim(const Constraint& constraint, const std::string& place) {
  const auto is_unit = [](const Eigen::Vector3d& axis) {
    return std::abs(axis.norm() - 1) <= unit_tolerance;
  };
  if (!is_unit(constraint.aim_axis)) return add(place, "has an aim axis that is not unit", "normalise it");
  if (!is_unit(constraint.up_axis)) return add(place, "has an up axis that is not unit", "normalise it");
  if (constraint.aim_axis.cross(constraint.up_axis).norm() < unit_tolerance)
    add(place, "has an up axis along its aim axis", "give one across it");
  if (constraint.up_node < 0 && !(constraint.up.allFinite() && constraint.up.norm() > 0))
    add(place, "has no up direction", "give a finite direction or an up node");
}

/// The nodes from the constraint's own back to itself along what each follows; none: it does not come back.
std::vector<int> ConstraintChecker::circle_of(const Constraint& constraint) const {
  std::vector<int> came_from(character_.nodes.size(), -1), waiting{constraint.node};
  for (std::size_t next = 0; next < waiting.size(); ++next)
    for (const int node : follows_[waiting[next]]) {
      if (node == constraint.node) {
        std::vector<int> circle{node};
        for (int n = waiting[next]; n != node; n = came_from[n]) circle.push_back(n);
        circle.push_back(node);
        std::reverse(circle.begin(), circle.end());
        return circle;
      }
      if (came_from[node] < 0) {
        came_from[node] = waiting[next];
        waiting.push_back(node);
      }
    }
  return {};
}

void ConstraintChecker::check_circles() {
  for (const Node& node : character_.nodes) {
    if (node.parent < -1 || node.parent >= static_cast<int>(character_.nodes.size())) return;
    follows_.push_back({});
    if (node.parent >= 0) follows_.back().push_back(node.parent);
  }
  for (const Constraint& constraint : character_.constraints) {
    for (const ConstraintSource& source : constraint.sources)
      follows_[constraint.node].push_back(source.node);
    if (constraint.up_node >= 0) follows_[constraint.node].push_back(constraint.up_node);
  }
  for (const Constraint& constraint : character_.constraints) {
    if (constraint.kind == Constraint::Kind::limit) continue;
    const std::vector<int> circle = circle_of(constraint);
    if (circle.empty()) continue;
    std::string names;
    for (std::size_t k = 1; k < circle.size(); ++k)
      names += (k == 1 ? "" : ", that on ") + name_of(circle[k]);
    return add("constraint " + constraint.name, name_of(constraint.node) + " depends on " + names,
               "a node may not follow itself, also not through others' sources and parents");
  }
}

std::vector<Problem> ConstraintChecker::run() {
  std::unordered_set<std::string> names;
  bool nodes_known = true;
  for (std::size_t c = 0; c < character_.constraints.size(); ++c) {
    const Constraint& constraint = character_.constraints[c];
    const std::string place = "constraint " + (constraint.name.empty() ? std::to_string(c) : constraint.name);
    if (constraint.name.empty()) add(place, "has no name", "give it one of its own");
    if (!names.insert(constraint.name).second)
      add(place, "has the name of another constraint", "give each its own name");
    if (!(constraint.influence >= 0 && constraint.influence <= 1))
      add(place, "has an influence of " + std::to_string(constraint.influence), "give a number in [0, 1]");
    if (!has_nodes(constraint, place)) {
      nodes_known = false;
      continue;
    }
    check_sources(constraint, place);
    if (constraint.kind == Constraint::Kind::limit) check_ranges(constraint, place);
    if (constraint.kind == Constraint::Kind::aim) check_aim(constraint, place);
  }
  if (nodes_known && !character_.constraints.empty()) check_circles();
  return std::move(problems_);
}

}  // namespace

std::vector<Problem> constraint_problems(const Character& character) {
  return ConstraintChecker(character).run();
}

}  // namespace mien
