#include "mien/report/thesis_times.h"

namespace mien {
namespace {

constexpr std::array<ThesisCharacter, 6> characters{{{"Teseo", 1, 3412},
                                                     {"Demetrio", 1, 3126},
                                                     {"Mostaza", 1, 3098},
                                                     {"Hada", 1, 2702},
                                                     {"Cartoon", 2, 2770},
                                                     {"Fantastic", 2, 3116}}};

// Table 5.1 calls the influence objects "NURBS Transfer", table 5.2 "Additional Deformers".
constexpr std::array<ThesisStep, 7> steps{
    {{"Skin Deformation (TPS)", "skin deformation", {0.02, 0.01, 0.01, 0.01, 0.01, 0.01}},
     {"Dense Deformation", "dense correspondence", {1.41, 1.33, 1.35, 1.15, 1.12, 1.03}},
     {"Joints Transfer", "joints", {16.09, 16.56, 16.55, 15.32, 19.05, 19.18}},
     {"Shape Transfer (each)", "shapes", {5.50, 4.57, 4.41, 3.42, 2.36, 2.42}, true},
     {"NURBS / Additional Deformers", "influence objects", {21.14, 21.35, 21.36, 21.17, 15.32, 15.05}},
     {"Weight Transfer", "skin weights", {8.17, 7.36, 7.45, 7.16, 6.10, 6.57}},
     {"Animation Transfer", "clips", {0.30, 0.21, 0.25, 0.20, 1.25, 1.33}}}};

}  // namespace

std::span<const ThesisCharacter> thesis_characters() {
  return characters;
}
std::span<const ThesisStep> thesis_steps() {
  return steps;
}

}  // namespace mien
