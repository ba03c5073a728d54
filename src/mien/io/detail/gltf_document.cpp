#include "mien/io/detail/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "mien/core/error.h"
#include "mien/io/detail/uri.h"
#include "mien/io/file.h"

namespace mien::detail {
namespace {

constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + offset, 4);
  return value;
}

bool is_understood(const std::string& extension) {
  if (extension == "KHR_mesh_quantization" || extension == "EXT_meshopt_compression" ||
      extension == vendor_extension)
    return true;
  // These change how a surface looks, not where it is; they are carried.
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
                             "EXT_lights_", "VRM", "KHR_xmp", "ADOBE_materials_"})
    if (extension.starts_with(prefix)) return true;
  return false;
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& path) : folder_(path.parent_path()) {
  if (folder_.empty()) folder_ = ".";
  const std::vector<std::uint8_t> file = read_file(path);
  if (file.empty()) throw io_error("file", "is empty", "give a glTF 2.0 file");
  budget_ = (std::size_t{64} << 20) + 100 * file.size();
  binary_ = file.size() >= 4 && word(file, 0) == magic;
  if (binary_) {
    parse_container(file);
  } else {
    std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.find_first_not_of(" \t\r\n") == text.npos || text[text.find_first_not_of(" \t\r\n")] != '{')
      throw io_error("header", "is not that of a glTF file", "a .glb starts with glTF, a .gltf with {");
    json_ = parse_json(text, "JSON");
  }
  check_version_and_extensions();
}

void GltfDocument::parse_container(std::span<const std::uint8_t> file) {
  if (file.size() < 20)
    throw io_error("header", fmt::format("ends after {} bytes", file.size()), "the file is cut off");
  if (word(file, 4) != 2)
    throw io_error("header", fmt::format("is glTF version {}", word(file, 4)), "mien reads version 2");
  if (word(file, 8) > file.size())
    throw io_error("header", fmt::format("says {} bytes but there are {}", word(file, 8), file.size()),
                   "the file is cut off");
  file = file.first(std::max<std::size_t>(word(file, 8), 20));
  bool has_json = false;
  for (std::size_t at = 12; at + 8 <= file.size();) {
    const std::size_t size = word(file, at), kind = word(file, at + 4);
    if (size > file.size() - at - 8)
      throw io_error(fmt::format("chunk at byte {}", at), fmt::format("says {} bytes", size),
                     "it must end in the file");
    const auto content = file.subspan(at + 8, size);
    if (kind == json_chunk && !has_json) {
      json_ = parse_json({reinterpret_cast<const char*>(content.data()), content.size()}, "JSON chunk");
      has_json = true;
    } else if (kind == binary_chunk && chunk_.empty()) {
      chunk_.assign(content.begin(), content.end());
    }
    at += 8 + size;
  }
  if (!has_json) throw io_error("container", "has no JSON chunk", "give a complete .glb");
}

void GltfDocument::check_version_and_extensions() const {
  const std::string version = root().object("asset").text("version");
  if (!version.starts_with("2."))
    throw io_error("asset.version", fmt::format("is \"{}\"", version), "mien reads version 2");
  for (const std::string& extension : root().texts("extensionsRequired")) {
    if (extension.find("draco") != extension.npos)
      throw io_error("extensionsRequired", fmt::format("asks for {}, which mien does not read", extension),
                     "export without Draco compression, or with EXT_meshopt_compression");
    if (!is_understood(extension))
      throw io_error("extensionsRequired", fmt::format("asks for {}, which mien does not read", extension),
                     "export without it");
  }
}

std::size_t GltfDocument::count(const char* collection) const {
  const auto found = json_.find(collection);
  if (found == json_.end()) return 0;
  if (!found->is_array())
    throw io_error(collection, fmt::format("is a {}", found->type_name()), "give an array");
  return found->size();
}

JsonObject GltfDocument::element(const char* collection, int index) const {
  return JsonObject(json_.at(collection).at(index), fmt::format("{}[{}]", collection, index));
}

std::vector<std::uint8_t> GltfDocument::bytes_of_uri(const std::string& uri, const std::string& place) const {
  return read_uri(uri, folder_, place);
}

bool GltfDocument::has_uri_file(const std::string& uri) const {
  return uri_exists(uri, folder_);
}

const std::vector<std::uint8_t>& GltfDocument::buffer(int index) {
  const auto known = buffers_.find(index);
  if (known != buffers_.end()) return known->second;
  const JsonObject description = element("buffers", index);
  const auto size = static_cast<std::size_t>(description.integer("byteLength", 1, std::int64_t{1} << 40));
  std::vector<std::uint8_t> bytes;
  if (description.has("uri")) {
    bytes = bytes_of_uri(description.text("uri"), description.place() + ".uri");
    budget_ += 100 * bytes.size();
  } else if (binary_ && index == 0) {
    bytes = chunk_;
  } else {
    throw io_error(description.place(), "has no bytes", "give it a uri");
  }
  if (bytes.size() < size)
    throw io_error(description.place() + ".byteLength",
                   fmt::format("is {} but there are {} bytes", size, bytes.size()), "the file is cut off");
  bytes.resize(size);
  return buffers_[index] = std::move(bytes);
}

void GltfDocument::spend(std::size_t bytes, const std::string& place) {
  if (bytes > budget_)
    throw io_error(place, "asks for far more memory than the file has bytes",
                   "give counts that the data backs");
  budget_ -= bytes;
}

std::span<const std::uint8_t> GltfDocument::sub_range(const JsonObject& view, const char* buffer_key) {
  const std::vector<std::uint8_t>& bytes = buffer(view.index(buffer_key, count("buffers")));
  const auto offset = static_cast<std::size_t>(view.integer_or("byteOffset", 0, 0, std::int64_t{1} << 40));
  const auto length = static_cast<std::size_t>(view.integer("byteLength", 1, std::int64_t{1} << 40));
  if (offset > bytes.size() || length > bytes.size() - offset)
    throw io_error(view.place(), fmt::format("spans bytes {} to {}", offset, offset + length),
                   fmt::format("its buffer has {}", bytes.size()));
  return std::span(bytes).subspan(offset, length);
}

std::span<const std::uint8_t> GltfDocument::view(int index) {
  const JsonObject description = element("bufferViews", index);
  if (description.has("extensions") && description.object("extensions").has("EXT_meshopt_compression")) {
    const auto known = decompressed_.find(index);
    if (known != decompressed_.end()) return known->second;
    return decompressed_[index] =
               decompress(description, description.object("extensions").object("EXT_meshopt_compression"));
  }
  return sub_range(description, "buffer");
}

}  // namespace mien::detail
