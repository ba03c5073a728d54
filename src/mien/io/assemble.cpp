#include "mien/io/assemble.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <map>
#include <string>

#include "mien/character/sliders.h"
#include "mien/character/whole_faces.h"
#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "mien/io/load.h"

namespace mien {
namespace {

/// The file's one part.
Mesh whole_face(const std::filesystem::path& path) {
  Character character = load(path);
  if (character.parts.size() != 1)
    throw invalid_input("file", fmt::format("has {} parts", character.parts.size()),
                        "give whole faces of one part")
        .in_file(path.string());
  return std::move(character.parts[0].mesh);
}

void check_same_order(const PointsD& displacement, double diagonal, const std::filesystem::path& path) {
  const Eigen::Index far = (displacement.rowwise().norm().array() > 0.25 * diagonal).count();
  if (2 * far > displacement.rows())
    throw invalid_input(
        "vertices", fmt::format("{} of {} move by more than a quarter of the face", far, displacement.rows()),
        "give a file with the neutral's vertex order and place")
        .in_file(path.string());
}

Shape shape_of(const Mesh& neutral, const std::filesystem::path& path, double threshold) {
  const Mesh face = whole_face(path);
  if (face.vertex_count() != neutral.vertex_count())
    throw invalid_input("vertices", fmt::format("are {}", face.vertex_count()),
                        fmt::format("the neutral has {}", neutral.vertex_count()))
        .in_file(path.string());
  const PointsD displacement = face.positions.cast<double>() - neutral.positions.cast<double>();
  const double diagonal = bounding_box(neutral.positions).diagonal();
  check_same_order(displacement, diagonal, path);
  Shape shape;
  shape.name = path.stem().string();
  shape.parts.push_back(delta_of(0, neutral.positions, face.positions, threshold * diagonal));
  return shape;
}

void check_names(std::span<const std::filesystem::path> shapes) {
  std::map<std::string, std::filesystem::path> seen;
  for (const std::filesystem::path& path : shapes) {
    const auto [known, is_new] = seen.emplace(path.stem().string(), path);
    if (!is_new)
      throw invalid_input("shape " + known->first,
                          fmt::format("is also made from {}", known->second.string()),
                          "give each shape's file its own name")
          .in_file(path.string());
  }
}

}  // namespace

Character assemble(const std::filesystem::path& neutral, std::span<const std::filesystem::path> shapes,
                   const AssembleOptions& options) {
  if (!(options.threshold >= 0) || options.threshold >= 1)
    throw invalid_input("threshold", fmt::format("is {}", options.threshold), "give 0 or more, below 1");
  check_names(shapes);
  Character character = load(neutral);
  if (character.parts.size() != 1)
    throw invalid_input("file", fmt::format("has {} parts", character.parts.size()),
                        "give a neutral of one part")
        .in_file(neutral.string());
  character.shapes.assign(shapes.size(), Shape{});
  // Files at a time: enough for all cores, few enough to tell how far it is.
  constexpr std::size_t batch = 8;
  for (std::size_t first = 0; first < shapes.size(); first += batch) {
    report_progress(options.progress, "read shapes",
                    static_cast<double>(first) / static_cast<double>(shapes.size()));
    parallel_for(std::min(batch, shapes.size() - first), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = first + begin; s < first + end; ++s)
        character.shapes[s] = shape_of(character.parts[0].mesh, shapes[s], options.threshold);
    });
  }
  report_progress(options.progress, "read shapes", 1);
  complete_sliders(character);
  return character;
}

}  // namespace mien
