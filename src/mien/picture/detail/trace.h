#pragma once
/// From rays to pixels.

#include "mien/picture/detail/lens.h"
#include "mien/picture/detail/ray_scene.h"
#include "mien/picture/picture.h"

namespace mien::detail {

struct TraceOptions {
  bool wireframe = false;
  const VertexMap* map = nullptr;
  Color background;
};

Picture trace(const RayScene& scene, const Soup& soup, const Lens& lens, const TraceOptions& options);

}  // namespace mien::detail
