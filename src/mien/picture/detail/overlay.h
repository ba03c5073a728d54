#pragma once
/// Markers, lines and the legend on top of a traced picture.

#include "mien/picture/detail/lens.h"
#include "mien/picture/detail/ray_scene.h"
#include "mien/picture/render.h"

namespace mien::detail {

void draw_overlay(const RayScene& scene, const Lens& lens, const RenderOptions& options, Picture& picture);

}  // namespace mien::detail
