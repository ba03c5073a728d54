#pragma once
/// One character in front of fixed cameras, so that its pictures can be compared.

#include <string>
#include <vector>

#include "mien/character/landmark_points.h"
#include "mien/picture/render.h"

namespace mien::detail {

inline RenderOptions sized(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  return options;
}

class Portrait {
 public:
  ///   landmarks  what counts as the face; facing: model space to a space where it looks along +Z with +Y up
  Portrait(const Character& character, const std::vector<LandmarkPoint>& landmarks,
           const Eigen::Matrix3d& facing);

  const std::vector<Points>& rest() const { return rest_; }

  /// The whole head. `options` are size, markers and map; the camera is this portrait's, whatever is posed.
  Picture head(const Renderer& renderer, const std::vector<Points>& posed, View view,
               RenderOptions options) const;
  Picture head(const std::vector<Points>& posed, View view, RenderOptions options) const {
    return head(renderer_, posed, view, std::move(options));
  }
  /// The landmarks' part of the head with room for every shape.
  Picture face(const std::vector<Points>& posed, RenderOptions options) const;

  const Renderer& renderer() const { return renderer_; }

 private:
  Eigen::Matrix3d facing_;
  std::vector<Points> rest_;
  Renderer renderer_;
  Points head_;          // what `head` holds
  Points face_corners_;  // of the box that `face` holds
};

}  // namespace mien::detail
