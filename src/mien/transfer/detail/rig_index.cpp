#include "mien/transfer/detail/rig_index.h"

#include <algorithm>
#include <map>
#include <set>

#include "mien/transfer/detail/at.h"

namespace mien::detail {
namespace {

template <class Element>
std::vector<std::string> unique_names(const std::vector<Element>& elements) {
  std::vector<std::string> names;
  std::map<std::string, int> seen;
  for (const Element& element : elements) {
    const int count = ++seen[element.name];
    names.push_back(count == 1 ? element.name : element.name + "#" + std::to_string(count));
  }
  return names;
}

/// A number's new one; what names nothing stays that way.
int look_up(const std::vector<int>& numbers, int index) {
  return index < 0 ? -1 : numbers[at(index)];
}

template <class Element>
void place(std::vector<Element>& elements, const std::vector<int>& numbers, std::size_t count) {
  std::vector<Element> placed(count);
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (numbers[i] >= 0) placed[at(numbers[i])] = std::move(elements[i]);
  elements = std::move(placed);
}

class Renumbering {
 public:
  Renumbering(Character& character, const RigNumbers& numbers) : c_(character), numbers_(numbers) {}

  void run(const std::array<std::size_t, kind_count>& counts) {
    rename_nodes();
    rename_shapes();
    rename_sliders();
    rename_objects();
    rename_clips();
    rename_constraints_and_controls();
    place(c_.nodes, of(Kind::node), counts[0]);
    place(c_.shapes, of(Kind::shape), counts[1]);
    place(c_.sliders, of(Kind::slider), counts[2]);
    place(c_.wires, of(Kind::wire), counts[3]);
    place(c_.objects, of(Kind::object), counts[4]);
  }

 private:
  const std::vector<int>& of(Kind kind) const { return numbers_[static_cast<std::size_t>(kind)]; }
  void to(Kind kind, int& index) const { index = look_up(of(kind), index); }

  void rename_nodes() {
    for (Node& node : c_.nodes) to(Kind::node, node.parent);
    for (Part& part : c_.parts) to(Kind::node, part.node);
    for (std::size_t s = 0; s < c_.skins.size(); ++s) {
      Skin& skin = c_.skins[s];
      to(Kind::node, skin.skeleton);
      std::vector<int> slot(skin.joints.size(), -1);
      Skin kept = skin;
      kept.joints.clear();
      kept.inverse_bind.clear();
      for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const int node = look_up(of(Kind::node), skin.joints[j]);
        if (node < 0) continue;
        slot[j] = static_cast<int>(kept.joints.size());
        kept.joints.push_back(node);
        if (j < skin.inverse_bind.size()) kept.inverse_bind.push_back(skin.inverse_bind[j]);
      }
      skin = std::move(kept);
      for (Part& part : c_.parts)
        if (part.skin == static_cast<int>(s)) rename_joints(slot, part.skin_weights);
      for (InfluenceObject& object : c_.objects)
        if (object.skin == static_cast<int>(s)) rename_joints(slot, object.skin_weights);
    }
  }

  static void rename_joints(const std::vector<int>& slot, SkinWeights& weights) {
    if (std::none_of(slot.begin(), slot.end(), [](int j) { return j < 0; })) return;
    if (weights.empty()) return;
    SkinWeights kept;
    kept.offsets.push_back(0);
    for (std::size_t v = 0; v + 1 < weights.offsets.size(); ++v) {
      float sum = 0;
      const std::size_t first = kept.joints.size();
      for (int i = weights.offsets[v]; i < weights.offsets[v + 1]; ++i) {
        const int joint = slot[at(weights.joints[at(i)])];
        if (joint < 0) continue;
        kept.joints.push_back(joint);
        kept.weights.push_back(weights.weights[at(i)]);
        sum += kept.weights.back();
      }
      for (std::size_t k = first; k < kept.weights.size(); ++k) kept.weights[k] /= sum;
      kept.offsets.push_back(static_cast<int>(kept.joints.size()));
    }
    weights = std::move(kept);
  }

  void rename_shapes() {
    for (Shape& shape : c_.shapes) {
      for (WireMove& move : shape.wires) to(Kind::wire, move.wire);
      for (ObjectMove& move : shape.objects) to(Kind::object, move.object);
      std::erase_if(shape.wires, [](const WireMove& move) { return move.wire < 0; });
      std::erase_if(shape.objects, [](const ObjectMove& move) { return move.object < 0; });
      const auto by_wire = [](const WireMove& a, const WireMove& b) { return a.wire < b.wire; };
      const auto by_object = [](const ObjectMove& a, const ObjectMove& b) { return a.object < b.object; };
      std::stable_sort(shape.wires.begin(), shape.wires.end(), by_wire);
      std::stable_sort(shape.objects.begin(), shape.objects.end(), by_object);
    }
  }

  void rename_sliders() {
    for (Slider& slider : c_.sliders) {
      for (SliderStop& stop : slider.stops) to(Kind::shape, stop.shape);
      std::erase_if(slider.stops, [](const SliderStop& stop) { return stop.shape < 0; });
    }
    for (Corrective& corrective : c_.correctives) {
      to(Kind::shape, corrective.shape);
      for (CorrectiveInput& input : corrective.inputs) to(Kind::slider, input.slider);
    }
    std::erase_if(c_.correctives, [](const Corrective& corrective) {
      return corrective.shape < 0 ||
             std::any_of(corrective.inputs.begin(), corrective.inputs.end(),
                         [](const CorrectiveInput& input) { return input.slider < 0; });
    });
    for (Expression& expression : c_.expressions) {
      for (ExpressionValue& value : expression.values) to(Kind::slider, value.slider);
      std::erase_if(expression.values, [](const ExpressionValue& value) { return value.slider < 0; });
      std::sort(expression.values.begin(), expression.values.end(),
                [](const ExpressionValue& a, const ExpressionValue& b) { return a.slider < b.slider; });
    }
  }

  void rename_objects() {
    for (InfluenceObject& object : c_.objects) {
      to(Kind::node, object.carrier);
      to(Kind::node, object.node);
    }
  }

  void rename_clips() {
    for (Clip& clip : c_.clips) {
      for (Channel& channel : clip.channels) {
        to(Kind::node, channel.node);
        to(Kind::shape, channel.shape);
        to(Kind::slider, channel.slider);
        to(Kind::wire, channel.wire);
        to(Kind::object, channel.object);
      }
      std::erase_if(clip.channels, [](const Channel& channel) {
        return channel.node < 0 && channel.shape < 0 && channel.slider < 0 && channel.wire < 0 &&
               channel.object < 0;
      });
    }
  }

  void rename_constraints_and_controls() {
    for (Constraint& constraint : c_.constraints) {
      to(Kind::node, constraint.node);
      to(Kind::node, constraint.up_node);
      for (ConstraintSource& source : constraint.sources) to(Kind::node, source.node);
      std::erase_if(constraint.sources, [](const ConstraintSource& source) { return source.node < 0; });
    }
    std::erase_if(c_.constraints, [](const Constraint& constraint) {
      return constraint.node < 0 ||
             (constraint.kind != Constraint::Kind::limit && constraint.sources.empty());
    });
    for (Control& control : c_.controls) {
      to(Kind::node, control.node);
      for (int& slider : control.sliders) to(Kind::slider, slider);
    }
    drop_controls();
  }

  void drop_controls() {
    std::vector<int> slot(c_.controls.size(), -1);
    std::vector<Control> kept;
    for (std::size_t i = 0; i < c_.controls.size(); ++i) {
      const Control& control = c_.controls[i];
      const bool drives = control.kind == Control::Kind::joint
                              ? control.node >= 0
                              : std::any_of(control.sliders.begin(), control.sliders.end(),
                                            [](int slider) { return slider >= 0; });
      if (!drives) continue;
      slot[i] = static_cast<int>(kept.size());
      kept.push_back(control);
    }
    for (Control& control : kept) control.mirror = look_up(slot, control.mirror);
    c_.controls = std::move(kept);
  }

  Character& c_;
  const RigNumbers& numbers_;
};

std::vector<std::string> join(const std::vector<std::string>& before, const std::vector<std::string>& after,
                              const std::vector<std::string>& edited) {
  std::vector<std::string> all;
  std::set<std::string> known;
  const auto add = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names)
      if (known.insert(name).second) all.push_back(name);
  };
  add(after == before ? edited : after);
  add(edited);
  add(after);
  add(before);
  return all;
}

}  // namespace

RigNames names_of(const Character& character) {
  return {unique_names(character.nodes), unique_names(character.shapes), unique_names(character.sliders),
          unique_names(character.wires), unique_names(character.objects)};
}

RigNames joined(const RigNames& before, const RigNames& after, const RigNames& edited) {
  RigNames all;
  for (std::size_t k = 0; k < kind_count; ++k) all[k] = join(before[k], after[k], edited[k]);
  return all;
}

RigNumbers numbers_in(const RigNames& names, const RigNames& all) {
  RigNumbers numbers;
  for (std::size_t k = 0; k < kind_count; ++k) {
    std::map<std::string, int> place;
    for (std::size_t i = 0; i < all[k].size(); ++i) place.emplace(all[k][i], static_cast<int>(i));
    for (const std::string& name : names[k]) numbers[k].push_back(place.at(name));
  }
  return numbers;
}

Character renumbered(Character character, const RigNumbers& numbers,
                     const std::array<std::size_t, kind_count>& counts) {
  Renumbering(character, numbers).run(counts);
  return character;
}

}  // namespace mien::detail
