// Joints and skin weights: the head's joint has everything; neck and jaw take their share, then small joints
// of the face take theirs from whoever holds it.

#include <algorithm>
#include <cmath>

#include "mien/sample/detail/character_form.h"
#include "mien/sample/detail/face_shapes.h"

namespace mien::sample {

namespace {

enum class Takes { nothing, upper, lower, all };

struct JointForm {
  const char* name;
  const char* parent;
  Vector3d at;
  Vector3d reach = Vector3d::Zero();  ///< radii of its soft region
  Takes takes = Takes::nothing;
  double share = 0.8;  ///< of the skin at its centre
};

/// The left one of each pair ends in Left; the right one is its mirror image.
std::vector<JointForm> joint_forms(const HeadForm& form) {
  const MouthForm& m = form.mouth;
  const Vector3d corner(m.width, m.corner, m.corner_front);
  return {
      {"root", "", {0, -15.6, -2.2}},
      {"neck", "root", {0, -13.5, -2.1}},
      {"head", "neck", {0, -6, -1.4}},
      {"jaw", "head", jaw_opening(0).centre},
      {"eyeLeft_joint", "head", form.eye.centre},
      {"lidUpperLeft", "head", form.eye.centre},
      {"lidLowerLeft", "head", form.eye.centre},
      {"browInnerLeft", "head", {1.5, 2.2, 9.0}, {1.9, 1.9, 2.6}, Takes::all},
      {"browOuterLeft", "head", {4.1, 2.3, 7.9}, {2.1, 1.9, 2.6}, Takes::all},
      {"cheekLeft", "head", {4.0, -3.3, 8.0}, {2.3, 2.2, 2.6}, Takes::upper},
      {"nose", "head", {0, -3.8, 11.3}, {2.2, 2.0, 2.4}, Takes::upper, 0.7},
      {"lipUpper", "head", {0, m.line + 0.4, m.front}, {1.7, 1.5, 2.4}, Takes::upper},
      {"lipUpperLeft", "head", {1.5, m.line + 0.35, m.front - 0.4}, {1.4, 1.5, 2.2}, Takes::upper},
      {"lipLower", "jaw", {0, m.line - 0.5, m.front - 0.1}, {1.7, 1.5, 2.4}, Takes::lower},
      {"lipLowerLeft", "jaw", {1.5, m.line - 0.45, m.front - 0.4}, {1.4, 1.5, 2.2}, Takes::lower},
      {"lipCornerLeft", "head", corner, {1.7, 1.6, 2.4}, Takes::all, 0.7},
      {"tongue1", "jaw", {0, -8.3, 4.4}},
      {"tongue2", "tongue1", {0, -7.4, 6.4}},
      {"tongue3", "tongue2", {0, -7.4, 7.8}},
  };
}

/// Joints with their pairs made, in order of `joint_forms`.
struct Joint {
  JointForm form;
  bool right = false;
};

std::string right_name(std::string name) {
  const auto at = name.find("Left");
  if (at != std::string::npos) name.replace(at, 4, "Right");
  return name;
}

std::vector<Joint> make_joints(const HeadForm& form) {
  std::vector<Joint> joints;
  for (const JointForm& joint : joint_forms(form)) {
    joints.push_back({joint, false});
    if (std::string(joint.name).find("Left") == std::string::npos) continue;
    joints.push_back({joint, true});
    joints.back().form.at.x() *= -1;
  }
  return joints;
}

using Rows = std::vector<std::vector<double>>;  ///< [joint][vertex]

/// Share of the skin that the lids' joints take: all at the edge, less and less outwards.
double lid_share(const HeadMesh& head, const LoopPlace& place, bool upper) {
  const int count = static_cast<int>(head.half.eye[0].size()), turn = count / 2;
  if (place.ring < 1) return 0;
  const double out = std::clamp(double(place.ring) / head.half.lid_edge, 0.0, 1.0);
  // Both lids share the corners.
  const double angle = std::sin(2 * 3.14159265358979 * place.slot / count);
  const double side = std::clamp(0.5 + 2.5 * (upper ? angle : -angle), 0.0, 1.0);
  return std::pow(out, 2.0) * side *
         std::clamp(3.0 * std::abs(std::sin(3.14159265358979 * place.slot / turn)), 0.0, 1.0);
}

Rows skin_rows(const HeadMesh& head, const FaceRegions& regions, const std::vector<Joint>& joints) {
  const std::size_t n = head.points.size();
  Rows rows(joints.size(), std::vector<double>(n, 0.0));
  const auto row = [&](std::string_view name) -> std::vector<double>& {
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (joints[j].form.name == name) return rows[j];
    return rows[0];
  };
  for (std::size_t v = 0; v < n; ++v) {
    row("neck")[v] = regions.neck[v];
    row("jaw")[v] = (1 - regions.neck[v]) * regions.jaw[v];
    row("head")[v] = (1 - regions.neck[v]) * (1 - regions.jaw[v]);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointForm& form = joints[j].form;
    const bool lid = std::string_view(form.name).starts_with("lid");
    if (form.takes == Takes::nothing && !lid) continue;
    for (std::size_t v = 0; v < n; ++v) {
      double share = 0;
      if (lid) {
        const int left = joints[j].right ? head.mirror[v] : static_cast<int>(v);
        share = lid_share(head, regions.left_eye[left], std::string_view(form.name) == "lidUpperLeft");
      } else {
        share = form.share * soft(head.points[v], form.at, form.reach);
        if (form.takes == Takes::upper) share *= 1 - regions.lower[v];
        if (form.takes == Takes::lower) share *= regions.lower[v];
      }
      if (share <= 0) continue;
      for (std::size_t other = 0; other < joints.size(); ++other) rows[other][v] *= 1 - share;
      rows[j][v] += share;
    }
  }
  return rows;
}

/// Small shares are dropped and the rest is brought back to a sum of one.
SkinWeights compact(const Rows& rows, std::size_t vertices) {
  SkinWeights out;
  out.offsets.push_back(0);
  for (std::size_t v = 0; v < vertices; ++v) {
    double sum = 0;
    for (const auto& row : rows)
      if (row[v] > 2e-3) sum += row[v];
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (rows[j][v] > 2e-3) {
        out.joints.push_back(static_cast<int>(j));
        out.weights.push_back(static_cast<float>(rows[j][v] / sum));
      }
    out.offsets.push_back(static_cast<int>(out.joints.size()));
  }
  return out;
}

Rows followed(const Rows& skin, const Anchors& anchors) {
  Rows rows(skin.size(), std::vector<double>(anchors.size(), 0.0));
  for (std::size_t j = 0; j < skin.size(); ++j)
    for (std::size_t v = 0; v < anchors.size(); ++v)
      for (const auto& [vertex, share] : anchors[v]) rows[j][v] += share * skin[j][vertex];
  return rows;
}

}  // namespace

void add_rig(BuiltCharacter& built, const CharacterForm& form, const FaceRegions& regions) {
  Character& character = built.character;
  const std::vector<Joint> joints = make_joints(form.head);
  Skin skin;
  skin.name = form.name;
  const int first = static_cast<int>(character.nodes.size());
  const auto joint_named = [&](const std::string& name) {
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (character.nodes.size() > first + j && character.nodes[first + j].name == name)
        return static_cast<int>(j);
    return -1;
  };
  for (const Joint& joint : joints) {
    Node node;
    node.name = joint.right ? right_name(joint.form.name) : joint.form.name;
    const int parent = joint_named(joint.form.parent);
    node.parent = parent < 0 ? -1 : first + parent;
    node.rest.translation = joint.form.at;
    if (parent >= 0) node.rest.translation -= joints[parent].form.at;
    skin.joints.push_back(static_cast<int>(character.nodes.size()));
    Eigen::Matrix4d inverse = Eigen::Matrix4d::Identity();
    inverse.topRightCorner<3, 1>() = -joint.form.at;
    skin.inverse_bind.push_back(inverse);
    character.nodes.push_back(node);
  }
  skin.skeleton = first;
  character.skins.push_back(skin);

  const Rows face = skin_rows(built.head, regions, joints);
  const auto whole = [&](int part, const std::string& joint) {
    Rows rows(joints.size(), std::vector<double>(character.parts[part].mesh.vertex_count(), 0.0));
    for (double& w : rows[joint_named(joint)]) w = 1;
    return rows;
  };
  const auto bind = [&](int part, const Rows& rows) {
    character.parts[part].skin = 0;
    character.parts[part].skin_weights = compact(rows, character.parts[part].mesh.vertex_count());
  };
  bind(face_part, face);
  bind(left_eye_part, whole(left_eye_part, "eyeLeft_joint"));
  bind(right_eye_part, whole(right_eye_part, "eyeRight_joint"));
  bind(upper_teeth_part, whole(upper_teeth_part, "head"));
  bind(lower_teeth_part, whole(lower_teeth_part, "jaw"));
  bind(brows_part, followed(face, anchors_of(character.parts[brows_part].mesh, built.head, {})));
  bind(lashes_part,
       followed(face, anchors_of(character.parts[lashes_part].mesh, built.head, built.lash_anchors)));

  Rows tongue = whole(tongue_part, "jaw");
  const Mesh& mesh = character.parts[tongue_part].mesh;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    // One joint after the other takes over along the tongue.
    double rest = 1;
    for (const char* name : {"tongue3", "tongue2", "tongue1"}) {
      const int j = joint_named(name);
      const double t = std::clamp((mesh.positions(v, 2) - joints[j].form.at.z()) / 1.2 + 0.5, 0.0, 1.0);
      tongue[j][v] = rest * t * t * (3 - 2 * t);
      rest -= tongue[j][v];
    }
    tongue[joint_named("jaw")][v] = rest;
  }
  bind(tongue_part, tongue);
}

}  // namespace mien::sample
