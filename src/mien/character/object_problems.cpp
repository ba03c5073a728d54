#include "mien/character/object_problems.h"

#include <cmath>
#include <unordered_set>

#include "mien/character/detail/skin_problem.h"

namespace mien {
namespace {

std::string text_of(long long number) {
  return std::to_string(number);
}

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::string fault_of_mesh(const WrapMesh& mesh, std::size_t control_count) {
  if (mesh.faces.empty()) return "has no faces";
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.faces[f].size() < 3) return "has face " + text_of(f) + " of fewer than three corners";
    for (const int corner : mesh.faces[f])
      if (corner < 0 || corner >= static_cast<int>(control_count))
        return "has face " + text_of(f) + " with vertex " + text_of(corner) + ", there are " +
               text_of(control_count);
  }
  return {};
}

std::string fault_of_frame(std::size_t control_count) {
  return control_count == 1 ? std::string() : "has " + text_of(control_count) + " points, one is needed";
}

class ObjectChecker {
 public:
  explicit ObjectChecker(const Character& character) : character_(character) {}

  std::vector<Problem> run() {
    std::unordered_set<std::string> names;
    for (const InfluenceObject& object : character_.objects) {
      const std::string place = "object " + object.name;
      if (!names.insert(object.name).second) add(place, "is there twice", "names are unique");
      check_form(object, place);
      check_joints(object, place);
      check_bindings(object, place);
    }
    for (const Shape& shape : character_.shapes) check_moves(shape);
    return std::move(problems_);
  }

 private:
  void add(std::string place, std::string text, std::string remedy) {
    problems_.push_back({std::move(place), std::move(text), std::move(remedy)});
  }

  bool in_range(long long index, long long low, std::size_t count, const std::string& place,
                const char* what) {
    if (index >= low && index < static_cast<long long>(count)) return true;
    add(place, std::string("names ") + what + " " + text_of(index), "there are " + text_of(count));
    return false;
  }

  void check_form(const InfluenceObject& object, const std::string& place) {
    if (!object.controls.allFinite())
      add(place, "has control points that are not finite", "give finite numbers");
    if (const std::string fault = fault_of(object.form, static_cast<std::size_t>(object.controls.rows()));
        !fault.empty())
      add(place, fault, std::string("give a ") + name_of(object.form) + " that fits its control points");
  }

  void check_joints(const InfluenceObject& object, const std::string& place) {
    in_range(object.carrier, -1, character_.nodes.size(), place, "node");
    in_range(object.node, -1, character_.nodes.size(), place, "node");
    if (!in_range(object.skin, -1, character_.skins.size(), place, "skin")) return;
    if (object.skin_weights.empty()) return;
    if (object.skin < 0) {
      add(place, "has skin weights and no skin", "name the skin that lists the joints");
      return;
    }
    if (auto problem = detail::skin_problem(
            object.skin_weights, static_cast<std::size_t>(object.controls.rows()),
            character_.skins[static_cast<std::size_t>(object.skin)].joints.size(), place, "control point"))
      problems_.push_back(std::move(*problem));
  }

  void check_bindings(const InfluenceObject& object, const std::string& place) {
    int before = -1;
    for (const InfluenceBinding& binding : object.bindings) {
      if (binding.part <= before)
        add(place, "lists its parts out of order", "list each part once, ascending");
      before = binding.part;
      if (!in_range(binding.part, 0, character_.parts.size(), place, "part")) return;
      const std::string here =
          place + ": part " + character_.parts[static_cast<std::size_t>(binding.part)].name;
      if (check_vertices(binding, here)) check_shares(object, binding, here);
    }
  }

  bool check_vertices(const InfluenceBinding& binding, const std::string& place) {
    const auto count =
        static_cast<int>(character_.parts[static_cast<std::size_t>(binding.part)].mesh.vertex_count());
    if (binding.weights.size() != binding.vertices.size()) {
      add(place, "has " + text_of(static_cast<long long>(binding.weights.size())) + " weights",
          "there are " + text_of(static_cast<long long>(binding.vertices.size())) + " vertices");
      return false;
    }
    for (std::size_t k = 0; k < binding.vertices.size(); ++k) {
      const int vertex = binding.vertices[k];
      const auto here = [&] { return place + ", vertex " + text_of(vertex); };
      if (vertex < 0 || vertex >= count || (k > 0 && vertex <= binding.vertices[k - 1])) {
        add(here(), "is out of range or out of order", "ascending vertices of the part");
        return false;
      }
      if (!(binding.weights[k] > 0 && binding.weights[k] <= 1)) {
        add(here(), "has weight " + std::to_string(binding.weights[k]), "above 0 and at most 1");
        return false;
      }
    }
    return true;
  }

  void check_shares(const InfluenceObject& object, const InfluenceBinding& binding,
                    const std::string& place) {
    const std::size_t entries = binding.controls.size();
    if (is_frame(object.form)) {
      if (!binding.offsets.empty() || entries > 0 || !binding.coefficients.empty())
        add(place, "lists control points", std::string("a ") + name_of(object.form) + " has none");
      return;
    }
    if (binding.offsets.size() != binding.vertices.size() + 1 || binding.offsets.front() != 0 ||
        static_cast<std::size_t>(binding.offsets.back()) != entries ||
        binding.coefficients.size() != entries) {
      add(place, "has a binding whose counts do not fit together", "give each vertex its control points");
      return;
    }
    for (std::size_t k = 0; k < binding.vertices.size(); ++k)
      if (!check_entries(object, binding, k, place + ", vertex " + text_of(binding.vertices[k]))) return;
  }

  bool check_entries(const InfluenceObject& object, const InfluenceBinding& binding, std::size_t k,
                     const std::string& place) {
    const int begin = binding.offsets[k], end = binding.offsets[k + 1];
    if (end < begin || end > static_cast<int>(binding.controls.size())) {
      add(place, "has offsets that descend", "give each vertex its control points");
      return false;
    }
    double sum = 0;
    for (int e = begin; e < end; ++e) {
      const auto at = static_cast<std::size_t>(e);
      if (!in_range(binding.controls[at], 0, static_cast<std::size_t>(object.controls.rows()), place,
                    "control point"))
        return false;
      sum += binding.coefficients[at];
    }
    if (std::abs(sum - 1) <= 1e-3) return true;
    add(place, "has coefficients that sum to " + std::to_string(sum), "they sum to 1");
    return false;
  }

  void check_moves(const Shape& shape) {
    int before = -1;
    for (const ObjectMove& move : shape.objects) {
      const std::string place = "shape " + shape.name;
      if (!in_range(move.object, 0, character_.objects.size(), place, "object")) return;
      const InfluenceObject& object = character_.objects[static_cast<std::size_t>(move.object)];
      const std::string here = place + ": object " + object.name;
      if (move.object <= before) add(here, "is out of order", "list each object once, ascending");
      before = move.object;
      if (move.controls.rows() != 0 && move.controls.rows() != object.controls.rows())
        add(here, "is moved by " + text_of(move.controls.rows()) + " control points",
            text_of(object.controls.rows()));
      if (!move.controls.allFinite())
        add(here, "is moved by numbers that are not finite", "give finite numbers");
    }
  }

  const Character& character_;
  std::vector<Problem> problems_;
};

}  // namespace

const char* name_of(const InfluenceForm& form) {
  constexpr const char* names[] = {"curve", "surface", "lattice", "mesh", "cluster", "locator"};
  return names[form.index()];
}

bool is_frame(const InfluenceForm& form) {
  return std::holds_alternative<Cluster>(form) || std::holds_alternative<Locator>(form);
}

std::string fault_of(const InfluenceForm& form, std::size_t control_count) {
  return std::visit(Overloaded{[&](const NurbsCurve& curve) { return fault_of(curve, control_count); },
                               [&](const NurbsSurface& surface) { return fault_of(surface, control_count); },
                               [&](const Lattice& lattice) { return fault_of(lattice, control_count); },
                               [&](const WrapMesh& mesh) { return fault_of_mesh(mesh, control_count); },
                               [&](const Cluster&) { return fault_of_frame(control_count); },
                               [&](const Locator&) { return fault_of_frame(control_count); }},
                    form);
}

std::vector<Problem> object_problems(const Character& character) {
  return ObjectChecker(character).run();
}

}  // namespace mien
