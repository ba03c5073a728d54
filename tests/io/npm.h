#pragma once
/// Programs from the npm registry that check files: installed once into the build folder.

#include <cstdlib>
#include <filesystem>
#include <string>

namespace mien::test {

inline bool runs(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

inline bool has_node() {
  return runs("node --version") && runs("npm --version");
}

/// The folder that holds node_modules with `packages` ("name@version ..."), of which `witness` is one; empty when they cannot be
/// installed.
inline std::filesystem::path npm_packages(const std::string& witness, const std::string& packages) {
  const std::filesystem::path folder =
      std::filesystem::path(MIEN_PROGRAM).parent_path() / "tests" / std::filesystem::path(witness).filename();
  if (std::filesystem::exists(folder / "node_modules" / witness / "package.json")) return folder;
  std::filesystem::create_directories(folder);
  const bool installed = runs("cd '" + folder.string() +
                              "' && timeout 120 npm install --no-audit --no-fund --prefix . " + packages);
  return installed ? folder : std::filesystem::path();
}

}  // namespace mien::test
