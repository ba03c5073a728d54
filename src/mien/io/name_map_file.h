#pragma once
/// A map of names: {"map": {"FROM": "TO", "FROM2": {"to": "TO2", "gain": 0.8}, ...}}.

#include <filesystem>
#include <string>
#include <vector>

namespace mien {

struct MappedName {
  std::string from, to;
  double gain = 1;
};

///   throws  Error naming the file: not JSON, another form, a gain that is not finite
std::vector<MappedName> read_name_map(const std::filesystem::path& path);

}  // namespace mien
