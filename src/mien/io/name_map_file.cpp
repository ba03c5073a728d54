#include "mien/io/name_map_file.h"

#include "mien/core/error.h"
#include "mien/io/detail/json_file.h"

namespace mien {

std::vector<MappedName> read_name_map(const std::filesystem::path& path) {
  return detail::read_json_file(path, [&](const detail::JsonObject& root) {
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
  });
}

}  // namespace mien
