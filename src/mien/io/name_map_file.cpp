#include "mien/io/name_map_file.h"

#include "mien/core/error.h"
#include "mien/io/detail/json.h"
#include "mien/io/file.h"

namespace mien {

std::vector<MappedName> read_name_map(const std::filesystem::path& path) {
  try {
    const std::vector<std::uint8_t> bytes = read_file(path);
    const detail::Json json =
        detail::parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "JSON");
    const detail::JsonObject root(json, "");
    if (!root.has("map")) throw io_error("file", "has no \"map\"", R"(give {"map": {FROM: TO}})");
    const detail::JsonObject map = root.object("map");
    std::vector<MappedName> names;
    for (const auto& [from, value] : map.json().items()) {
      if (value.is_string()) {
        names.push_back({from, value.get<std::string>()});
        continue;
      }
      const detail::JsonObject entry = map.object(from.c_str());
      names.push_back({from, entry.text("to"), entry.number_or("gain", 1)});
    }
    return names;
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
