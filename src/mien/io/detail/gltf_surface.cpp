#include <fmt/format.h>

#include "mien/core/error.h"
#include "mien/io/detail/gltf_read.h"
#include "mien/io/detail/gltf_write.h"

// What a part's vertices control, in the mesh's MIEN_character extension: other programs see the control grid or cage.

namespace mien::detail {

void write_surface(const Part& part, Json& vendor) {
  if (part.subdivision == Subdivision::catmull_clark) vendor["subdivision"] = "catmull-clark";
  if (part.subdivision == Subdivision::loop) vendor["subdivision"] = "loop";
  if (!part.surface) return;
  const NurbsSurface& surface = *part.surface;
  vendor["surface"] = {{"degree", {surface.degree_u, surface.degree_v}},
                       {"count", {surface.count_u, surface.count_v}},
                       {"knotsU", surface.knots_u},
                       {"knotsV", surface.knots_v}};
  if (!surface.weights.empty()) vendor["surface"]["weights"] = surface.weights;
}

void read_surface(const JsonObject& vendor, Part& part) {
  if (vendor.has("subdivision")) {
    const std::string scheme = vendor.text("subdivision");
    if (scheme != "catmull-clark" && scheme != "loop")
      throw io_error(vendor.place_of("subdivision"), fmt::format("is \"{}\"", scheme.substr(0, 40)),
                     "give catmull-clark or loop");
    part.subdivision = scheme == "loop" ? Subdivision::loop : Subdivision::catmull_clark;
  }
  if (!vendor.has("surface")) return;
  const JsonObject source = vendor.object("surface");
  const std::vector<double> degree = source.numbers("degree", 2), count = source.numbers("count", 2);
  if (degree.size() != 2 || count.size() != 2)
    throw io_error(source.place(), "has no \"degree\" or \"count\"", "give two numbers each, along u and v");
  NurbsSurface surface;
  const double most = static_cast<double>(part.mesh.vertex_count());
  for (const double number : {degree[0], degree[1], count[0], count[1]})
    if (!(number >= 0) || number > most)
      throw io_error(source.place(), fmt::format("has {}", number), "give counts of control vertices");
  surface.degree_u = static_cast<int>(degree[0]);
  surface.degree_v = static_cast<int>(degree[1]);
  surface.count_u = static_cast<int>(count[0]);
  surface.count_v = static_cast<int>(count[1]);
  surface.knots_u = source.numbers("knotsU");
  surface.knots_v = source.numbers("knotsV");
  surface.weights = source.numbers("weights");
  part.surface = std::move(surface);
}

}  // namespace mien::detail
