#include "mien/report/detail/portrait.h"

#include <algorithm>

#include "mien/report/detail/face_box.h"
#include "mien/report/detail/poses.h"

namespace mien::detail {
namespace {

/// Of the landmarks' box: forehead and sides of the face.
constexpr double around = 0.13;
/// Where an exaggerated shape may take a landmark before it is cut off.
constexpr double most_around = 0.4;
/// Landmarks this many times as far from the middle as the median one are the crown's or the neck's, not the face's.
constexpr double outlying = 1.8;

/// A character larger than this many landmark boxes has a body: only what is around its face is shown.
constexpr double most_boxes = 4, around_head = 0.9;

/// The vertices that make the head.
Points head_of(const std::vector<Points>& rest, const std::vector<LandmarkPoint>& landmarks) {
  PointsD marks(static_cast<Eigen::Index>(landmarks.size()), 3);
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    marks.row(static_cast<Eigen::Index>(i)) = landmarks[i].position.transpose();
  Eigen::Index count = 0;
  for (const Points& part : rest) count += part.rows();
  Points all(count, 3);
  count = 0;
  for (const Points& part : rest) {
    all.middleRows(count, part.rows()) = part;
    count += part.rows();
  }
  if (bounding_box(all).diagonal() <= most_boxes * grown_box(marks, 0).diagonal()) return all;
  const Box box = grown_box(marks, around_head);
  std::vector<Eigen::Index> inside;
  for (Eigen::Index v = 0; v < all.rows(); ++v) {
    const Eigen::Array3d x = all.row(v).transpose().cast<double>().array();
    if ((x >= box.low.array()).all() && (x <= box.high.array()).all()) inside.push_back(v);
  }
  return inside.empty() ? all : Points(all(inside, Eigen::all));
}

/// The landmarks of the face proper.
std::vector<LandmarkPoint> inner_landmarks(const std::vector<LandmarkPoint>& landmarks) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const LandmarkPoint& landmark : landmarks)
    middle += landmark.position / static_cast<double>(landmarks.size());
  std::vector<double> distances;
  for (const LandmarkPoint& landmark : landmarks) distances.push_back((landmark.position - middle).norm());
  std::vector<double> sorted = distances;
  std::sort(sorted.begin(), sorted.end());
  std::vector<LandmarkPoint> inner;
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (distances[i] <= outlying * sorted[sorted.size() / 2]) inner.push_back(landmarks[i]);
  return inner;
}

PointsD places(const Character& character, const std::vector<Points>& posed,
               const std::vector<LandmarkPoint>& landmarks) {
  PointsD points(static_cast<Eigen::Index>(landmarks.size()), 3);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const auto part = static_cast<std::size_t>(landmarks[i].at.part);
    points.row(static_cast<Eigen::Index>(i)) =
        position_of(character.parts[part].mesh, posed[part], landmarks[i].at).transpose();
  }
  return points;
}

/// The landmarks' box in the frame of `facing`, with room for where shapes take them; its corners in model space.
Points corners_of_face(const Character& character, const std::vector<Points>& rest,
                       const std::vector<LandmarkPoint>& landmarks, const Eigen::Matrix3d& facing) {
  const auto seen = [&](const std::vector<Points>& posed) {
    return PointsD(places(character, posed, landmarks) * facing.transpose());
  };
  const PointsD neutral = seen(rest);
  const Box limit = grown_box(neutral, most_around), tight = grown_box(neutral, 0);
  Box box = grown_box(neutral, around);
  const double room = 0.4 * around * tight.diagonal();
  for (std::size_t s = 0; s < character.shapes.size(); ++s) {
    const Box reached = grown_box(seen(in_shape(character, s)), 0);
    box.low = box.low.cwiseMin((reached.low.array() - room).matrix()).cwiseMax(limit.low);
    box.high = box.high.cwiseMax((reached.high.array() + room).matrix()).cwiseMin(limit.high);
  }
  // The picture's plane goes through the middle of the face: its depth takes no room.
  box.low.z() = box.high.z() = tight.centre().z();
  Points corners(8, 3);
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3d corner(c & 1 ? box.high.x() : box.low.x(), c & 2 ? box.high.y() : box.low.y(),
                                 c & 4 ? box.high.z() : box.low.z());
    corners.row(c) = (facing.transpose() * corner).transpose().cast<float>();
  }
  return corners;
}

FrameOptions frame_of(const RenderOptions& options, View view, const Eigen::Matrix3d& facing) {
  FrameOptions frame;
  frame.view = view;
  frame.aspect = static_cast<double>(options.width) / options.height;
  frame.facing = facing;
  return frame;
}

}  // namespace

Portrait::Portrait(const Character& character, const std::vector<LandmarkPoint>& landmarks,
                   const Eigen::Matrix3d& facing)
    : facing_(facing), rest_(at_rest(character)), renderer_(character), head_(head_of(rest_, landmarks)) {
  face_corners_ = corners_of_face(character, rest_, inner_landmarks(landmarks), facing);
}

Picture Portrait::head(const Renderer& renderer, const std::vector<Points>& posed, View view,
                       RenderOptions options) const {
  options.camera = frame_points(head_, frame_of(options, view, facing_));
  return renderer.render(posed, options);
}

Picture Portrait::face(const std::vector<Points>& posed, RenderOptions options) const {
  FrameOptions frame = frame_of(options, View::front, facing_);
  frame.margin = 0;
  options.camera = frame_points(face_corners_, frame);
  return renderer_.render(posed, options);
}

}  // namespace mien::detail
