#include "mien/io/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "mien/character/validate.h"
#include "mien/core/error.h"
#include "mien/io/gltf.h"
#include "mien/io/obj.h"

namespace mien {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Error unknown_format(const std::filesystem::path& path) {
  return io_error("format", fmt::format("\"{}\" is not known", path.extension().string()),
                  "name a .glb, .gltf or .obj")
      .in_file(path.string());
}

}  // namespace

Character load(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string extension = lower_extension(path);
  Character character;
  if (extension == ".glb" || extension == ".gltf" || extension == ".vrm")
    character = read_gltf(path);
  else if (extension == ".obj")
    character = read_obj(path);
  else
    throw unknown_format(path);
  try {
    if (options.validate) require_valid(character);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
  return character;
}

void save(const Character& character, const std::filesystem::path& path, const SaveOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension == ".glb" || extension == ".gltf")
    write_gltf(character, path, options);
  else if (extension == ".obj")
    write_obj(character, path);
  else
    throw unknown_format(path);
}

}  // namespace mien
