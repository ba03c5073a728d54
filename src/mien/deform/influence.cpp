// Objects that rest are found before anything is computed: a pose in which only the head turns costs a comparison of matrices, and
// a vertex that nothing moves keeps its bits, which no product of a matrix with its inverse would promise.
#include "mien/deform/influence.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "mien/character/object_problems.h"
#include "mien/core/error.h"

namespace mien {
namespace {

Motion identity() {
  return Eigen::Matrix4d::Identity().topRows<3>();
}

/// Rounding of the float matrices in files: bind poses closer to the rest pose than this, of the matrix's largest entry, are it.
constexpr double same_pose = 1e-6;

/// Motions closer to none than this, of the matrices' largest entry, are the rounding of a product with an inverse.
constexpr double no_motion = 1e-13;

/// The inverse, or nothing when the matrix has none to speak of.
bool invert(const Eigen::Matrix4d& matrix, Eigen::Matrix4d& inverse) {
  inverse = matrix.inverse();
  return inverse.allFinite();
}

/// What the skin does at rest to a bound point that follows `carrier`; the object's own skin is asked first.
Eigen::Matrix4d bind_to_rest(const Character& character, const InfluenceObject& object,
                             const std::vector<Eigen::Matrix4d>& rest) {
  const auto from = [&](const Skin& skin) -> const Eigen::Matrix4d* {
    const auto joint = std::find(skin.joints.begin(), skin.joints.end(), object.carrier);
    const auto at = static_cast<std::size_t>(joint - skin.joints.begin());
    return joint == skin.joints.end() || at >= skin.inverse_bind.size() ? nullptr : &skin.inverse_bind[at];
  };
  const Eigen::Matrix4d* inverse_bind = nullptr;
  if (object.carrier >= 0 && object.skin >= 0) inverse_bind = from(character.skins[object.skin]);
  for (std::size_t s = 0; object.carrier >= 0 && !inverse_bind && s < character.skins.size(); ++s)
    inverse_bind = from(character.skins[s]);
  return inverse_bind ? Eigen::Matrix4d(rest[object.carrier] * *inverse_bind) : Eigen::Matrix4d::Identity();
}

}  // namespace

InfluenceField::InfluenceField(const Character& character, std::vector<Eigen::Matrix4d> rest)
    : rest_(std::move(rest)),
      parts_(character.parts.size()),
      to_model_(character.parts.size(), identity()),
      to_part_(character.parts.size(), Eigen::Matrix3d::Identity()) {
  if (const auto problems = object_problems(character); !problems.empty()) throw problems.front().error();
  if (rest_.empty()) rest_ = model_matrices(character);
  if (rest_.size() != character.nodes.size())
    throw invalid_input("rest", "has " + std::to_string(rest_.size()) + " matrices",
                        std::to_string(character.nodes.size()) + ", one a node");
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Part& part = character.parts[p];
    if (part.skin >= 0 || part.node < 0) continue;
    if (part.node >= static_cast<int>(rest_.size()))
      throw invalid_input("part " + part.name, "names node " + std::to_string(part.node),
                          "a node that exists");
    to_model_[p] = rest_[part.node].topRows<3>();
    const Eigen::Matrix3d inverse = to_model_[p].leftCols<3>().inverse();
    to_part_[p] = inverse.allFinite() ? inverse : Eigen::Matrix3d::Zero();
  }
  for (const Shape& shape : character.shapes) shapes_.push_back(shape.objects);
  for (std::size_t o = 0; o < character.objects.size(); ++o) {
    const InfluenceObject& source = character.objects[o];
    Object object{source.name, is_frame(source.form), source.carrier, source.node, source.controls,
                  {},          source.skin_weights};
    if (source.skin >= 0) object.joints = character.skins[source.skin].joints;
    object.to_rest = bind_to_rest(character, source, rest_);
    const double size = std::max(1.0, object.to_rest.cwiseAbs().maxCoeff());
    Eigen::Matrix4d inverse;
    object.rest_is_bind =
        (object.to_rest - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() <= same_pose * size ||
        !invert(object.to_rest, inverse);
    objects_.push_back(std::move(object));
    for (const InfluenceBinding& binding : source.bindings)
      parts_[binding.part].push_back({static_cast<int>(o), binding});
  }
}

bool InfluenceField::has_moved(int node, const std::vector<Eigen::Matrix4d>& model) const {
  return node >= 0 && model[node] != rest_[node];
}

Motion InfluenceField::motion_of(int index, int node, const std::vector<Eigen::Matrix4d>& model) const {
  if (index < 0 || index >= object_count())
    throw invalid_input("object " + std::to_string(index), "does not exist",
                        "one from 0 to " + std::to_string(object_count() - 1));
  if (model.size() != rest_.size())
    throw invalid_input("pose", "has " + std::to_string(model.size()) + " matrices",
                        std::to_string(rest_.size()) + ", one a node");
  const Object& object = objects_[index];
  if (node < -1 || node >= static_cast<int>(rest_.size()))
    throw invalid_input("object " + object.name, "names node " + std::to_string(node), "a node that exists");
  if (node < 0 || node == object.carrier || (!has_moved(node, model) && !has_moved(object.carrier, model)))
    return identity();
  const auto since_rest = [&](int n, Eigen::Matrix4d& motion) {
    motion.setIdentity();
    Eigen::Matrix4d back;
    if (!has_moved(n, model)) return true;
    if (!invert(rest_[n], back)) return false;
    motion = model[n] * back;
    return true;
  };
  Eigen::Matrix4d own, carried, carried_back;
  if (!since_rest(node, own) || !since_rest(object.carrier, carried) || !invert(carried, carried_back))
    return identity();
  Eigen::Matrix4d motion = carried_back * own;
  const double size = std::max({1.0, own.cwiseAbs().maxCoeff(), carried_back.cwiseAbs().maxCoeff()});
  if ((motion - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() <= no_motion * size) return identity();
  if (!object.rest_is_bind) motion = object.to_rest.inverse() * motion * object.to_rest;
  return motion.allFinite() ? Motion(motion.topRows<3>()) : identity();
}

/// Writes what joints and node do to each control point.
///   returns  false: they do nothing, and nothing is written
bool InfluenceField::set_motions(int index, const std::vector<Eigen::Matrix4d>& model,
                                 ObjectPose& pose) const {
  const Object& object = objects_[index];
  const bool has_joints = !object.joints.empty() && !object.skin_weights.empty();
  bool moved = has_moved(object.node, model) || has_moved(object.carrier, model);
  for (std::size_t j = 0; has_joints && !moved && j < object.joints.size(); ++j)
    moved = has_moved(object.joints[j], model);
  if (!moved) return false;
  const Motion node = motion_of(index, object.node, model);
  if (!has_joints && node == identity()) return false;
  pose.motions.assign(static_cast<std::size_t>(object.controls.rows()), node);
  if (!has_joints) return true;
  pose.joints.resize(object.joints.size());
  for (std::size_t j = 0; j < object.joints.size(); ++j)
    pose.joints[j] = motion_of(index, object.joints[j], model);
  const SkinWeights& skin = object.skin_weights;
  Eigen::Matrix4d blend = Eigen::Matrix4d::Identity();
  for (std::size_t c = 0; c < pose.motions.size(); ++c) {
    double total = 0;
    Motion sum = Motion::Zero();
    for (int i = skin.offsets[c]; i < skin.offsets[c + 1]; ++i) {
      sum += static_cast<double>(skin.weights[i]) * pose.joints[skin.joints[i]];
      total += skin.weights[i];
    }
    if (!(total > 0)) continue;
    blend.topRows<3>() = sum / total;
    pose.motions[c] = node * blend;
  }
  return !std::all_of(pose.motions.begin(), pose.motions.end(),
                      [](const Motion& m) { return m == identity(); });
}

/// Adds to the displacements before joints and node count.
void InfluenceField::move_by(const ObjectMove& move, double share, std::vector<ObjectPose>& poses) const {
  if (move.object < 0 || move.object >= object_count())
    throw invalid_input("object " + std::to_string(move.object), "does not exist",
                        objects_.empty() ? "no move: the character has no objects"
                                         : "one from 0 to " + std::to_string(object_count() - 1));
  const Object& object = objects_[move.object];
  if (move.controls.rows() == 0) return;
  if (move.controls.rows() != object.controls.rows())
    throw invalid_input("object " + object.name,
                        "is moved by " + std::to_string(move.controls.rows()) + " control points",
                        std::to_string(object.controls.rows()));
  if (!move.controls.allFinite())
    throw invalid_input("object " + object.name, "is moved by numbers that are not finite", "finite numbers");
  if (share == 0 || move.controls.isZero(0)) return;
  poses[move.object].displacements += share * move.controls;
  poses[move.object].moves = true;
}

/// From what shapes and animator do to the control points, which `displacements` holds, to where they are. (M - 1) c + M d: small
/// motions of a point far from the origin keep their digits.
void InfluenceField::set_displacements(int index, bool is_carried, ObjectPose& pose) const {
  const Object& object = objects_[index];
  if (!is_carried) pose.motions.assign(static_cast<std::size_t>(object.controls.rows()), identity());
  for (Eigen::Index c = 0; c < object.controls.rows(); ++c) {
    const Motion& motion = pose.motions[static_cast<std::size_t>(c)];
    const Eigen::Vector3d place = object.controls.row(c).transpose();
    const Eigen::Vector3d shift = motion.leftCols<3>() * pose.displacements.row(c).transpose();
    const Eigen::Matrix3d turn = motion.leftCols<3>() - Eigen::Matrix3d::Identity();
    pose.displacements.row(c) = (turn * place + motion.col(3) + shift).transpose();
    if (!object.is_frame) continue;
    pose.frame = motion;
    pose.frame.col(3) += shift;
  }
}

std::vector<ObjectPose> InfluenceField::pose(const std::vector<Eigen::Matrix4d>& model,
                                             const ShapeWeights& weights,
                                             std::span<const ObjectMove> moves) const {
  std::vector<ObjectPose> poses;
  pose(model, weights, moves, poses);
  return poses;
}

void InfluenceField::pose(const std::vector<Eigen::Matrix4d>& model, const ShapeWeights& weights,
                          std::span<const ObjectMove> moves, std::vector<ObjectPose>& poses) const {
  if (model.size() != rest_.size())
    throw invalid_input("pose", "has " + std::to_string(model.size()) + " matrices",
                        std::to_string(rest_.size()) + ", one a node");
  if (weights.values.size() != static_cast<Eigen::Index>(shapes_.size()))
    throw invalid_input("shape weights", "number " + std::to_string(weights.values.size()),
                        std::to_string(shapes_.size()) + ", one a shape");
  if (!weights.values.allFinite()) throw invalid_input("shape weights", "are not finite", "finite numbers");
  poses.resize(objects_.size());
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    poses[o].moves = false;
    poses[o].displacements.setZero(objects_[o].controls.rows(), 3);
  }
  for (std::size_t s = 0; s < shapes_.size(); ++s)
    for (const ObjectMove& move : shapes_[s])
      move_by(move, weights.values[static_cast<Eigen::Index>(s)], poses);
  for (const ObjectMove& move : moves) move_by(move, 1, poses);
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    const bool is_carried = set_motions(static_cast<int>(o), model, poses[o]);
    poses[o].moves = poses[o].moves || is_carried;
    if (poses[o].moves) set_displacements(static_cast<int>(o), is_carried, poses[o]);
  }
}

PointsD InfluenceField::place(int index, const ObjectPose& pose,
                              const std::vector<Eigen::Matrix4d>& model) const {
  if (index < 0 || index >= object_count())
    throw invalid_input("object " + std::to_string(index), "does not exist",
                        "one from 0 to " + std::to_string(object_count() - 1));
  const Object& object = objects_[index];
  if (model.size() != rest_.size())
    throw invalid_input("pose", "has " + std::to_string(model.size()) + " matrices",
                        std::to_string(rest_.size()) + ", one a node");
  PointsD places = object.controls;
  if (pose.moves) places += pose.displacements;
  Eigen::Matrix4d carry = object.to_rest, back;
  if (has_moved(object.carrier, model) && invert(rest_[object.carrier], back))
    carry = model[object.carrier] * back * carry;
  return (places * carry.topLeftCorner<3, 3>().transpose()).rowwise() +
         carry.topRightCorner<3, 1>().transpose();
}

void InfluenceField::add(int part, std::span<const ObjectPose> poses, PointsD& positions) const {
  if (part < 0 || part >= static_cast<int>(parts_.size()))
    throw invalid_input("part " + std::to_string(part), "does not exist",
                        "a part from 0 to " + std::to_string(static_cast<int>(parts_.size()) - 1));
  if (poses.size() != objects_.size())
    throw invalid_input("pose", "has " + std::to_string(poses.size()) + " objects",
                        std::to_string(objects_.size()));
  std::vector<char> moved(static_cast<std::size_t>(positions.rows()), 0);
  PointsD sums = PointsD::Zero(positions.rows(), 3);
  const Motion& to_model = to_model_[part];
  for (const auto& [index, binding] : parts_[part]) {
    const ObjectPose& pose = poses[index];
    if (!pose.moves) continue;
    if (!binding.vertices.empty() && binding.vertices.back() >= positions.rows())
      throw invalid_input("part " + std::to_string(part),
                          "has " + std::to_string(positions.rows()) + " positions", "one a vertex");
    const Eigen::Matrix3d turn = pose.frame.leftCols<3>() - Eigen::Matrix3d::Identity();
    for (std::size_t k = 0; k < binding.vertices.size(); ++k) {
      const int vertex = binding.vertices[k];
      Eigen::Vector3d shift = Eigen::Vector3d::Zero();
      if (objects_[index].is_frame) {
        const Eigen::Vector3d x = to_model * positions.row(vertex).transpose().homogeneous();
        shift = turn * x + pose.frame.col(3);
      } else {
        for (int e = binding.offsets[k]; e < binding.offsets[k + 1]; ++e)
          shift += static_cast<double>(binding.coefficients[e]) *
                   pose.displacements.row(binding.controls[e]).transpose();
      }
      sums.row(vertex) += static_cast<double>(binding.weights[k]) * shift.transpose();
      moved[static_cast<std::size_t>(vertex)] = 1;
    }
  }
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
    if (moved[static_cast<std::size_t>(v)])
      positions.row(v) += (to_part_[part] * sums.row(v).transpose()).transpose();
}

}  // namespace mien
