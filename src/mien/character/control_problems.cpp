#include <cmath>
#include <unordered_set>

#include "mien/character/validate.h"

namespace mien {
namespace {

class ControlChecker {
 public:
  explicit ControlChecker(const Character& character) : character_(character) {}
  std::vector<Problem> run();

 private:
  void check_sliders(const Control& control);
  void check_node(const Control& control);
  void check_mirror(int index);
  void add(std::string text, std::string remedy) {
    problems_.push_back({place_, std::move(text), std::move(remedy)});
  }

  const Character& character_;
  std::string place_;
  std::vector<Problem> problems_;
};

void ControlChecker::check_sliders(const Control& control) {
  const std::size_t wanted = control.kind == Control::Kind::slider ? 1
                             : control.kind == Control::Kind::pad  ? 4
                                                                   : 0;
  if (control.sliders.size() != wanted)
    return add("has " + std::to_string(control.sliders.size()) + " sliders",
               "a slider's control has one, a pad four, a joint none");
  std::unordered_set<int> seen;
  for (const int slider : control.sliders) {
    if (slider == -1 && control.kind == Control::Kind::pad) continue;
    if (slider < 0 || slider >= static_cast<int>(character_.sliders.size()))
      return add("names slider " + std::to_string(slider),
                 "there are " + std::to_string(character_.sliders.size()));
    if (!seen.insert(slider).second)
      return add("has slider " + character_.sliders[slider].name + " twice", "a pad's directions differ");
  }
  if (wanted > 0 && seen.empty()) add("is a pad without sliders", "give one to a direction or more");
}

void ControlChecker::check_node(const Control& control) {
  if (control.kind != Control::Kind::joint) {
    if (control.node != -1) add("is no joint and names a node", "leave the node out");
    return;
  }
  if (control.node < 0 || control.node >= static_cast<int>(character_.nodes.size()))
    add("names node " + std::to_string(control.node), "there are " + std::to_string(character_.nodes.size()));
}

void ControlChecker::check_mirror(int index) {
  const std::vector<Control>& controls = character_.controls;
  const int mirror = controls[index].mirror;
  if (mirror == -1) return;
  if (mirror < 0 || mirror >= static_cast<int>(controls.size()) || mirror == index)
    return add("names control " + std::to_string(mirror) + " as its mirror",
               "another one of the " + std::to_string(controls.size()));
  if (controls[mirror].mirror != index)
    add("has the mirror " + controls[mirror].name + ", whose own is another", "mirrors name each other");
}

std::vector<Problem> ControlChecker::run() {
  std::unordered_set<std::string> names;
  for (std::size_t c = 0; c < character_.controls.size(); ++c) {
    const Control& control = character_.controls[c];
    place_ = "control " + (control.name.empty() ? std::to_string(c) : control.name);
    if (control.name.empty()) add("has no name", "give it one of its own");
    if (!names.insert(control.name).second) add("has the name of another control", "give each its own name");
    check_sliders(control);
    check_node(control);
    check_mirror(static_cast<int>(c));
    if (!control.position.allFinite() || !control.size.allFinite() || !(control.size.minCoeff() > 0))
      add("has a place or a size that is not finite or not above 0", "give finite numbers");
  }
  return std::move(problems_);
}

}  // namespace

std::vector<Problem> control_problems(const Character& character) {
  return ControlChecker(character).run();
}

}  // namespace mien
