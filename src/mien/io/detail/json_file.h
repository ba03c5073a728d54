#pragma once
/// The frame of every small JSON file's reader.

#include <filesystem>

#include "mien/core/error.h"
#include "mien/io/detail/json.h"
#include "mien/io/file.h"

namespace mien::detail {

/// What `read` makes of the file's root object.
///   throws  Error naming the file: it cannot be read, is no JSON object, or what `read` complains of
template <typename Function>
auto read_json_file(const std::filesystem::path& path, const Function& read) {
  try {
    const std::vector<std::uint8_t> bytes = read_file(path);
    const Json json = parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "JSON");
    return read(JsonObject(json, ""));
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien::detail
