#include <fmt/format.h>

#include <map>
#include <memory>

#include "command.h"
#include "mien/core/error.h"
#include "mien/io/load.h"
#include "mien/symmetry/find_mirror_plane.h"
#include "mien/symmetry/mirror_shapes.h"

namespace mien::cli {
namespace {

struct Request {
  std::string character, output;
  std::vector<std::string> shapes;
  double width = 0.02;
  Side from = Side::left;
  bool replace = false;
};

std::string plane_text(const FoundPlane& found) {
  const Eigen::Vector3d& n = found.plane.normal;
  return fmt::format("mirror plane ({:.4f}, {:.4f}, {:.4f}), asymmetry {:.2f} % of the box\n", n.x(), n.y(),
                     n.z(), 100 * found.asymmetry);
}

nlohmann::json plane_json(const FoundPlane& found) {
  const Eigen::Vector3d& n = found.plane.normal;
  return {{"normal", {n.x(), n.y(), n.z()}}, {"offset", found.plane.offset}, {"asymmetry", found.asymmetry}};
}

void run_split(const Request& request, const Common& common) {
  const Character character = load(request.character);
  try {
    const FoundPlane found = find_mirror_plane(character);
    save(split_shapes(character, request.shapes, found.plane, request.width), request.output);
    print_result(
        common,
        fmt::format("{}: {} shapes split\n", request.output, request.shapes.size()) + plane_text(found),
        {{"output", request.output}, {"split", request.shapes}, {"plane", plane_json(found)}});
  } catch (const Error& error) {
    throw error.in_file(request.character);
  }
}

void run_mirror(const Request& request, const Common& common) {
  const Character character = load(request.character);
  try {
    const FoundPlane found = find_mirror_plane(character);
    const MirroredShapes mirrored = mirror_shapes(character, request.from, found.plane, request.replace);
    save(mirrored.character, request.output);
    print_result(common,
                 fmt::format("{}: {} shapes made, {} replaced\n", request.output, mirrored.made.size(),
                             mirrored.replaced.size()) +
                     plane_text(found),
                 {{"output", request.output},
                  {"made", mirrored.made},
                  {"replaced", mirrored.replaced},
                  {"plane", plane_json(found)}});
  } catch (const Error& error) {
    throw error.in_file(request.character);
  }
}

}  // namespace

void add_split(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("split", "Split shapes into their left and right halves");
  auto request = std::make_shared<Request>();
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  command->add_option("--shape", request->shapes, "A shape to split, as often as needed")->required();
  command->add_option("--width", request->width, "Half the width of the passage, of the box's diagonal")
      ->capture_default_str();
  command->add_option("-o,--output", request->output, "The character with the halves (.glb, .gltf)")
      ->required();
  command->footer("Example: mien split face.glb --shape mouthSmile -o sides.glb");
  command->callback([request, &common] { run_split(*request, common); });
}

void add_mirror(CLI::App& app, Common& common) {
  CLI::App* command = app.add_subcommand("mirror", "Make one side's shapes from the other's");
  auto request = std::make_shared<Request>();
  command->add_option("character", request->character, "A character (.glb, .gltf)")->required();
  const std::map<std::string, Side> sides{{"left", Side::left}, {"right", Side::right}};
  command->add_option("--from", request->from, "The side that is kept: left or right")
      ->transform(CLI::CheckedTransformer(sides).description(""))
      ->type_name("SIDE")
      ->default_str("left");
  command->add_flag("--replace", request->replace, "Replace shapes that the other side has");
  command->add_option("-o,--output", request->output, "The character with both sides (.glb, .gltf)")
      ->required();
  command->footer("Example: mien mirror face.glb --from left -o both.glb");
  command->callback([request, &common] { run_mirror(*request, common); });
}

}  // namespace mien::cli
