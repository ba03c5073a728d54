#include "mien/picture/render.h"

#include <string>

#include "mien/core/error.h"
#include "mien/picture/detail/lens.h"
#include "mien/picture/detail/overlay.h"
#include "mien/picture/detail/ray_scene.h"
#include "mien/picture/detail/trace.h"

namespace mien {

struct Renderer::State {
  Character character;
  detail::Soup soup;
};

namespace {

void check_sizes(const Character& character, const std::vector<Points>& posed) {
  if (posed.size() != character.parts.size())
    throw invalid_input("picture", "is given " + std::to_string(posed.size()) + " parts",
                        std::to_string(character.parts.size()) + ", one a part of the character");
  for (std::size_t p = 0; p < posed.size(); ++p) {
    const Part& part = character.parts[p];
    if (posed[p].rows() != part.mesh.positions.rows())
      throw invalid_input("part " + part.name, "is given " + std::to_string(posed[p].rows()) + " positions",
                          std::to_string(part.mesh.positions.rows()) + ", one a vertex");
    if (!posed[p].allFinite())
      throw invalid_input("part " + part.name, "has a position that is not finite", "finite positions");
  }
}

void check_map(const Character& character, const VertexMap& map) {
  for (std::size_t p = 0; p < map.values.size(); ++p) {
    if (map.values[p].size() == 0) continue;
    if (p >= character.parts.size() || map.values[p].size() != character.parts[p].mesh.positions.rows())
      throw invalid_input(
          "vertex map",
          "has " + std::to_string(map.values[p].size()) + " values for part " + std::to_string(p),
          "one a vertex, or none");
  }
}

Points corners_of(const Box& box) {
  Points corners(8, 3);
  for (int c = 0; c < 8; ++c)
    for (int k = 0; k < 3; ++k) corners(c, k) = static_cast<float>(c >> k & 1 ? box.high[k] : box.low[k]);
  return corners;
}

Camera camera_of(const Character& character, const std::vector<Points>& posed, const RenderOptions& options) {
  if (options.camera) return *options.camera;
  FrameOptions frame;
  frame.view = options.view;
  frame.aspect = static_cast<double>(options.width) / options.height;
  frame.facing = options.facing;
  if (options.zoom) return frame_points(corners_of(*options.zoom), frame);
  return frame_head(character, posed, frame);
}

}  // namespace

Renderer::Renderer(const Character& character, Surfaces surfaces) : state_(std::make_unique<State>()) {
  state_->character = character;
  state_->soup = detail::make_soup(character, surfaces == Surfaces::painted);
}

const std::vector<std::string>& Renderer::warnings() const {
  return state_->soup.paint.warnings;
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Picture Renderer::render(const std::vector<Points>& posed, const RenderOptions& options) const {
  check_sizes(state_->character, posed);
  if (options.map) check_map(state_->character, *options.map);
  Picture picture = blank_picture(options.width, options.height);
  const VertexMap* map = options.map ? &*options.map : nullptr;
  const detail::RayScene scene(state_->soup, posed, map);
  const Camera camera = camera_of(state_->character, posed, options);
  const detail::Lens lens = detail::make_lens(camera, scene, options.width, options.height);
  picture = detail::trace(scene, state_->soup, lens, {options.wireframe, map, options.background});
  detail::draw_overlay(scene, lens, options, picture);
  return picture;
}

Picture render(const Character& character, const std::vector<Points>& posed, const RenderOptions& options) {
  return Renderer(character).render(posed, options);
}

}  // namespace mien
