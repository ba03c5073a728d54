// All three rigs are renumbered into one list of names a kind, so that every reference is a number of that list and two elements are
// compared as values; at the end what is gone is taken out by another renumbering. Skin weights are merged vertex by vertex over the
// joints of all three.
#include "mien/transfer/merge_rigs.h"

#include <Eigen/LU>
#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>

#include "mien/core/error.h"
#include "mien/transfer/detail/assemble_target.h"
#include "mien/transfer/detail/at.h"
#include "mien/transfer/detail/merge_elements.h"
#include "mien/transfer/detail/rig_index.h"

namespace mien {
namespace {

using detail::Alike;
using detail::at;
using detail::combined;
using detail::Kind;
using Counts = std::array<std::size_t, detail::kind_count>;

/// One version of the rig in joined numbers, and which of them it has.
struct Version {
  Character rig;
  std::array<std::vector<char>, detail::kind_count> has;
};

Version version_of(const Character& character, const detail::RigNames& all, const Counts& counts) {
  const detail::RigNumbers numbers = detail::numbers_in(detail::names_of(character), all);
  Version version{detail::renumbered(character, numbers, counts), {}};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    version.has[k].assign(counts[k], 0);
    for (const int number : numbers[k]) version.has[k][at(number)] = 1;
  }
  return version;
}

class Merge {
 public:
  Merge(const Character& before, const Character& after, const Character& edited, const MergeOptions& options)
      : all_(detail::joined(detail::names_of(before), detail::names_of(after), detail::names_of(edited))) {
    for (std::size_t k = 0; k < all_.size(); ++k) counts_[k] = all_[k].size();
    before_ = version_of(before, all_, counts_);
    after_ = version_of(after, all_, counts_);
    edited_ = version_of(edited, all_, counts_);
    alike_.length = options.tolerance * options.unit;
  }

  MergedRig operator()() {
    result_ = edited_.rig;
    merge_numbered(Kind::node, &Character::nodes, "node");
    merge_numbered(Kind::shape, &Character::shapes, "shape");
    merge_numbered(Kind::slider, &Character::sliders, "slider");
    merge_numbered(Kind::wire, &Character::wires, "wire");
    merge_numbered(Kind::object, &Character::objects, "object");
    const auto by_name = [](const auto& element) { return element.name; };
    merge_listed(&Character::correctives, "corrective",
                 [&](const Corrective& corrective) { return all_[1][at(corrective.shape)]; });
    merge_listed(&Character::expressions, "expression", by_name);
    merge_listed(&Character::clips, "clip", by_name);
    merge_listed(&Character::constraints, "constraint", by_name);
    merge_controls();
    merge_skins();
    return {without_gone(), std::move(report_)};
  }

 private:
  /// What both changed: elements of some kinds add up, others stay as the target has them.
  Node both(const Node& b, const Node& a, const Node& e, const std::string& place) {
    Node node = e;
    if (alike_(b.rest, e.rest))
      node.rest = a.rest;
    else if (!alike_(a.rest, b.rest))
      node.rest = combined(b.rest, a.rest, e.rest);
    if (b.parent == e.parent) node.parent = a.parent;
    report_.conflicts.push_back(place +
                                ": changed on both sides; the target's move is added to the source's");
    return node;
  }
  template <class Element>
  Element both(const Element& b, const Element& a, const Element& e, const std::string& place) requires
      requires(const Alike& alike) {
    combined(b, a, e, alike);
  }
  {
    report_.conflicts.push_back(place +
                                ": changed on both sides; the target's changes are added to the source's");
    return combined(b, a, e, alike_);
  }
  template <class Element>
  Element both(const Element&, const Element&, const Element& e, const std::string& place) {
    report_.conflicts.push_back(place + ": changed on both sides; the target's is kept");
    return e;
  }

  /// The element that three versions, absent ones null, come to; null: none.
  template <class Element>
  std::optional<Element> merged(const Element* b, const Element* a, const Element* e,
                                const std::string& place) {
    if (b && a && e) {
      if (alike_(*b, *a)) {
        if (!alike_(*b, *e)) report_.kept.push_back(place);
        return *e;
      }
      if (alike_(*b, *e) || alike_(*a, *e)) {
        report_.updated.push_back(place);
        return *a;
      }
      return both(*b, *a, *e, place);
    }
    if (e && !b && a && !alike_(*a, *e)) {
      report_.conflicts.push_back(place + ": new on both sides; the target's is kept");
      return *e;
    }
    if (e && !b) {
      if (!a) report_.kept.push_back(place);
      return *e;
    }
    if (e && alike_(*b, *e)) {
      report_.removed.push_back(place);
      return std::nullopt;
    }
    if (e) {
      report_.conflicts.push_back(place + ": changed on the target, gone from the source; it is kept");
      return *e;
    }
    if (a && !b) {
      report_.updated.push_back(place);
      return *a;
    }
    if (a) {
      if (alike_(*b, *a))
        report_.removed.push_back(place);
      else
        report_.conflicts.push_back(place +
                                    ": changed in the source, removed from the target; it is left out");
    }
    return std::nullopt;
  }

  template <class Element>
  void merge_numbered(Kind kind, std::vector<Element> Character::*list, const std::string& name) {
    const std::size_t k = static_cast<std::size_t>(kind);
    present_[k].assign(counts_[k], 0);
    for (std::size_t i = 0; i < counts_[k]; ++i) {
      const auto in = [&](const Version& version) {
        return version.has[k][i] ? &(version.rig.*list)[i] : nullptr;
      };
      auto element = merged(in(before_), in(after_), in(edited_), name + " " + all_[k][i]);
      present_[k][i] = element.has_value();
      if (element) (result_.*list)[i] = std::move(*element);
    }
  }

  /// Lists that nothing refers to by number, in the order that `joined` has for the others.
  template <class Element, class Name>
  void merge_listed(std::vector<Element> Character::*list, const std::string& kind, const Name& name_of) {
    const auto find = [&](const Version& version, const std::string& name) -> const Element* {
      for (const Element& element : version.rig.*list)
        if (name_of(element) == name) return &element;
      return nullptr;
    };
    std::vector<Element> elements;
    for (const std::string& name : order_of(list, name_of)) {
      auto element = merged(find(before_, name), find(after_, name), find(edited_, name), kind + " " + name);
      if (element) elements.push_back(std::move(*element));
    }
    result_.*list = std::move(elements);
  }

  template <class Element, class Name>
  std::vector<std::string> order_of(std::vector<Element> Character::*list, const Name& name_of) const {
    const auto names = [&](const Version& version) {
      std::vector<std::string> result;
      for (const Element& element : version.rig.*list) result.push_back(name_of(element));
      return result;
    };
    const std::vector<std::string> b = names(before_), a = names(after_), e = names(edited_);
    std::vector<std::string> order;
    for (const std::vector<std::string>* part : {a == b ? &e : &a, &e, &a, &b})
      for (const std::string& name : *part)
        if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
    return order;
  }

  /// Controls name each other by number: the names of their mirrors are merged with them.
  void merge_controls() {
    const auto join_mirrors = [&](Version& version, const std::vector<std::string>& order) {
      std::vector<std::string> names;
      for (const Control& control : version.rig.controls) names.push_back(control.name);
      for (Control& control : version.rig.controls)
        if (control.mirror >= 0)
          control.mirror = static_cast<int>(std::find(order.begin(), order.end(), names[at(control.mirror)]) -
                                            order.begin());
    };
    const auto by_name = [](const Control& control) { return control.name; };
    const std::vector<std::string> order = order_of(&Character::controls, by_name);
    for (Version* version : {&before_, &after_, &edited_}) join_mirrors(*version, order);
    merge_listed(&Character::controls, "control", by_name);
    for (Control& control : result_.controls)
      if (control.mirror >= 0) {
        const std::string& name = order[at(control.mirror)];
        const auto other = std::find_if(result_.controls.begin(), result_.controls.end(),
                                        [&](const Control& c) { return c.name == name; });
        control.mirror =
            other == result_.controls.end() ? -1 : static_cast<int>(other - result_.controls.begin());
      }
  }

  // Skin weights and bind poses, by joined node numbers.
  using Row = std::map<int, float>;

  static Row row_of(const Version& version, std::size_t part, std::size_t vertex) {
    Row row;
    const Part& p = version.rig.parts[part];
    if (p.skin < 0 || p.skin_weights.empty()) return row;
    const SkinWeights& weights = p.skin_weights;
    for (int i = weights.offsets[vertex]; i < weights.offsets[vertex + 1]; ++i)
      row[version.rig.skins[at(p.skin)].joints[at(weights.joints[at(i)])]] += weights.weights[at(i)];
    return row;
  }

  bool rows_alike(const Row& a, const Row& b) const {
    const auto covered = [&](const Row& x, const Row& y) {
      return std::all_of(x.begin(), x.end(), [&](const auto& entry) {
        const auto other = y.find(entry.first);
        return std::abs(entry.second - (other == y.end() ? 0.f : other->second)) <= alike_.weight;
      });
    };
    return covered(a, b) && covered(b, a);
  }

  static std::map<int, Eigen::Matrix4d> inverse_binds(const Version& version) {
    std::map<int, Eigen::Matrix4d> binds;
    for (const Skin& skin : version.rig.skins)
      for (std::size_t j = 0; j < skin.joints.size(); ++j)
        binds.emplace(skin.joints[j], j < skin.inverse_bind.size()
                                          ? skin.inverse_bind[j]
                                          : Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
    return binds;
  }

  /// Which nodes are joints, in order, with their bind matrices.
  Skin merge_joints() {
    const auto b = inverse_binds(before_), a = inverse_binds(after_), e = inverse_binds(edited_);
    const Version& first = a.empty() ? edited_ : after_;
    Skin skin = first.rig.skins.empty() ? Skin{} : first.rig.skins.front();
    if (!edited_.rig.skins.empty()) {
      skin.name = edited_.rig.skins.front().name;
      skin.method = edited_.rig.skins.front().method;
    }
    skin.joints.clear();
    skin.inverse_bind.clear();
    const std::vector<Eigen::Matrix4d> rest = model_matrices(result_);
    for (const Version* version : std::initializer_list<const Version*>{&first, &edited_})
      for (const Skin& from : version->rig.skins)
        for (const int joint : from.joints) {
          if (!present_[0][at(joint)] ||
              std::find(skin.joints.begin(), skin.joints.end(), joint) != skin.joints.end())
            continue;
          skin.joints.push_back(joint);
          skin.inverse_bind.push_back(inverse_bind_of(joint, b, a, e, rest));
        }
    return skin;
  }

  Eigen::Matrix4d inverse_bind_of(int joint, const std::map<int, Eigen::Matrix4d>& b,
                                  const std::map<int, Eigen::Matrix4d>& a,
                                  const std::map<int, Eigen::Matrix4d>& e,
                                  const std::vector<Eigen::Matrix4d>& rest) const {
    const auto in = [&](const std::map<int, Eigen::Matrix4d>& binds) {
      const auto found = binds.find(joint);
      return found == binds.end() ? nullptr : &found->second;
    };
    const Eigen::Matrix4d *before = in(b), *after = in(a), *edited = in(e);
    if (!edited || !after) return edited ? *edited : *after;
    const auto same = [&](const Eigen::Matrix4d& x, const Eigen::Matrix4d& y) {
      const Eigen::Matrix4d bx = x.inverse(), by = y.inverse();
      return (bx - by).topRightCorner<3, 1>().norm() <= alike_.length &&
             (bx - by).topLeftCorner<3, 3>().norm() <= 10 * alike_.number;
    };
    if (!before || same(*before, *after)) return *edited;
    if (same(*before, *edited)) return *after;
    // Bound as they rest: so is what comes of them.
    if ((*edited * model_of(edited_, joint)).isIdentity(1e-4) &&
        (*after * model_of(after_, joint)).isIdentity(1e-4))
      return rest[at(joint)].inverse();
    return *edited * before->inverse() * *after;
  }

  static Eigen::Matrix4d model_of(const Version& version, int joint) {
    return model_matrices(version.rig)[at(joint)];
  }

  void merge_skins() {
    if (after_.rig.skins.empty() && edited_.rig.skins.empty()) return;
    const Skin skin = merge_joints();
    std::map<int, int> slot;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) slot.emplace(skin.joints[j], static_cast<int>(j));
    for (std::size_t p = 0; p < result_.parts.size(); ++p) merge_weights(p, slot);
    for (std::size_t o = 0; o < result_.objects.size(); ++o) rename_object_joints(o, slot);
    result_.skins = {skin};
  }

  /// A vertex's merged skin weights; adds to `painted` and `clashing`.
  Row merged_row(std::size_t part, std::size_t vertex, int& painted, int& clashing) const {
    const Row b = row_of(before_, part, vertex), a = row_of(after_, part, vertex),
              e = row_of(edited_, part, vertex);
    const bool same_source = rows_alike(b, a), same_target = rows_alike(b, e);
    painted += !same_target;
    if (same_source) return e;
    if (same_target) return a;
    ++clashing;
    Row sum = a;
    for (const auto& [joint, weight] : e) sum[joint] += weight;
    for (const auto& [joint, weight] : b) sum[joint] -= weight;
    std::erase_if(sum, [&](const auto& entry) { return !(entry.second > alike_.weight); });
    return sum.empty() ? a : sum;
  }

  void merge_weights(std::size_t part, const std::map<int, int>& slot) {
    SkinWeights weights;
    weights.offsets.push_back(0);
    int painted = 0, clashing = 0;
    const std::size_t vertices = static_cast<std::size_t>(result_.parts[part].mesh.positions.rows());
    for (std::size_t v = 0; v < vertices; ++v) {
      std::map<int, float> row;
      float sum = 0;
      for (const auto& [joint, weight] : merged_row(part, v, painted, clashing))
        if (const auto found = slot.find(joint); found != slot.end()) {
          row[found->second] = weight;
          sum += weight;
        }
      // What already sums to one is not divided: an unchanged row keeps its bits.
      const float divisor = std::abs(sum - 1) < 1e-5f || !(sum > 0) ? 1.f : sum;
      for (const auto& [joint, weight] : row) {
        weights.joints.push_back(joint);
        weights.weights.push_back(weight / divisor);
      }
      weights.offsets.push_back(static_cast<int>(weights.joints.size()));
    }
    Part& result = result_.parts[part];
    result.skin = weights.joints.empty() ? -1 : 0;
    result.skin_weights = weights.joints.empty() ? SkinWeights{} : std::move(weights);
    const std::string place = "skin weights of " + result.name;
    if (painted > 0) report_.kept.push_back(place + ": " + std::to_string(painted) + " vertices");
    if (clashing > 0)
      report_.conflicts.push_back(
          place + ": " + std::to_string(clashing) +
          " vertices changed on both sides; the target's changes are added to the source's");
  }

  /// An object's joints count in the skin of the version that its weights came from.
  void rename_object_joints(std::size_t object, const std::map<int, int>& slot) {
    InfluenceObject& result = result_.objects[object];
    if (result.skin < 0) return;
    for (const Version* version : std::initializer_list<const Version*>{&edited_, &after_}) {
      if (!version->has[4][object]) continue;
      const InfluenceObject& from = version->rig.objects[object];
      if (from.skin < 0 || !(from.skin_weights == result.skin_weights)) continue;
      const Skin& skin = version->rig.skins[at(from.skin)];
      for (int& joint : result.skin_weights.joints) joint = slot.at(skin.joints[at(joint)]);
      break;
    }
    result.skin = 0;
  }

  Character without_gone() {
    detail::RigNumbers numbers;
    Counts counts{};
    for (std::size_t k = 0; k < numbers.size(); ++k)
      for (const char present : present_[k])
        numbers[k].push_back(present ? static_cast<int>(counts[k]++) : -1);
    return detail::renumbered(std::move(result_), numbers, counts);
  }

  detail::RigNames all_;
  Counts counts_{};
  Version before_, after_, edited_;
  Alike alike_;
  Character result_;
  std::array<std::vector<char>, detail::kind_count> present_;
  MergeReport report_;
};

void check_parts(const Character& a, const Character& b) {
  bool alike = a.parts.size() == b.parts.size();
  for (std::size_t p = 0; alike && p < a.parts.size(); ++p)
    alike = a.parts[p].mesh.positions.rows() == b.parts[p].mesh.positions.rows();
  if (!alike)
    throw invalid_input("target", "has other parts than the rig that was transferred to it",
                        "the target that the source was transferred to, with its parts and vertices");
}

}  // namespace

MergedRig merge_rigs(const Character& before, const Character& after, const Character& edited,
                     const MergeOptions& options) {
  check_parts(before, edited);
  check_parts(after, edited);
  return Merge(before, after, edited, options)();
}

Character without_rig(const Character& target, bool skinned) {
  return detail::bare_target(target, detail::pool(target), skinned);
}

}  // namespace mien
