#pragma once
/// A camera in scene space, ready to make rays and to project points.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mien/picture/camera.h"
#include "mien/picture/detail/ray_scene.h"

namespace mien::detail {

struct Lens {
  Eigen::Vector3f eye, right, up, back;
  float slope = 1;  ///< tangent of half the vertical field of view
  int width = 1, height = 1;

  /// Unit direction through pixel coordinates (0, 0: upper left corner of the picture).
  Eigen::Vector3f ray(float x, float y) const {
    const float u = (2 * x / static_cast<float>(width) - 1) * slope * static_cast<float>(width) /
                    static_cast<float>(height);
    const float v = (1 - 2 * y / static_cast<float>(height)) * slope;
    return (u * right + v * up - back).normalized();
  }
  /// Pixel coordinates of a point in front of the eye, and its depth.
  Eigen::Vector3f project(const Eigen::Vector3f& point) const {
    const Eigen::Vector3f q = point - eye;
    const float depth = -q.dot(back);
    const float scale = static_cast<float>(height) / (2 * slope * depth);
    return {static_cast<float>(width) / 2 + q.dot(right) * scale,
            static_cast<float>(height) / 2 - q.dot(up) * scale, depth};
  }
  /// The size of a pixel at this depth.
  float pixel(float depth) const { return 2 * slope * depth / static_cast<float>(height); }
};

inline Lens make_lens(const Camera& camera, const RayScene& scene, int width, int height) {
  const Eigen::Vector3d back = (camera.eye - camera.target).normalized();
  const Eigen::Vector3d right = camera.up.cross(back).normalized();
  Lens lens;
  lens.eye = ((camera.eye - scene.centre) / scene.size).cast<float>();
  lens.back = back.cast<float>();
  lens.right = right.cast<float>();
  lens.up = back.cross(right).cast<float>();
  lens.slope = static_cast<float>(std::tan(camera.field_of_view * std::numbers::pi / 360));
  lens.width = width;
  lens.height = height;
  return lens;
}

}  // namespace mien::detail
