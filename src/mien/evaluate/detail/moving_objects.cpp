#include "mien/evaluate/detail/moving_objects.h"

#include <algorithm>
#include <string>

#include "mien/core/error.h"
#include "mien/deform/influence.h"
#include "mien/evaluate/constraints.h"
#include "mien/evaluate/detail/kernel.h"
#include "mien/evaluate/evaluate.h"

namespace mien::detail {

struct MovingObjects::Prepared {
  Prepared(const Character& c, const std::vector<std::vector<int>>& v)
      : character(c), vertices(v), field(c, posed_matrices(c, rest_pose(c))) {}
  Character character;
  std::vector<std::vector<int>> vertices;
  InfluenceField field;
};

MovingObjects::MovingObjects(const Character& character, const std::vector<std::vector<int>>& vertices) {
  if (!character.objects.empty()) prepared_ = std::make_shared<const Prepared>(character, vertices);
}

bool MovingObjects::move(const Pose& pose) const {
  if (!prepared_ && !pose.objects.empty())
    throw invalid_input("pose", "moves object " + std::to_string(pose.objects.front().object),
                        "the character has none");
  if (!prepared_) return false;
  const Character& character = prepared_->character;
  for (const PartShapeWeight& exception : pose.part_shape_weights)
    if (exception.shape >= 0 && exception.shape < static_cast<int>(character.shapes.size()) &&
        !character.shapes[static_cast<std::size_t>(exception.shape)].objects.empty())
      return true;
  const std::vector<ObjectPose> poses =
      prepared_->field.pose(posed_matrices(character, pose), pose.shape_weights, pose.objects);
  return std::any_of(poses.begin(), poses.end(), [](const ObjectPose& object) { return object.moves; });
}

void MovingObjects::evaluate(const Pose& pose, std::span<const std::int32_t> lane_rows, float* blocks,
                             float* rows) const {
  const std::vector<Points> posed = mien::evaluate(prepared_->character, pose);
  std::vector<float> all;
  const auto add = [&](const Points& part, Eigen::Index vertex) {
    for (int axis = 0; axis < 3; ++axis) all.push_back(part(vertex, axis));
  };
  for (std::size_t p = 0; p < posed.size(); ++p) {
    if (prepared_->vertices.empty())
      for (Eigen::Index v = 0; v < posed[p].rows(); ++v) add(posed[p], v);
    else
      for (const int vertex : prepared_->vertices[p]) add(posed[p], vertex);
  }
  if (rows) std::copy(all.begin(), all.end(), rows);
  for (std::size_t lane = 0; blocks && lane < lane_rows.size(); ++lane)
    for (std::size_t axis = 0; axis < 3; ++axis)
      blocks[block_floats * (lane / lane_count) + lane_count * axis + lane % lane_count] =
          lane_rows[lane] < 0 ? 0.f : all[3 * static_cast<std::size_t>(lane_rows[lane]) + axis];
}

}  // namespace mien::detail
