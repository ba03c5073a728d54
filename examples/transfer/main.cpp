// Puts the rig of one face on another: transfer SOURCE TARGET OUT.glb

#include <cstdio>

#include "mien/core/error.h"
#include "mien/io/load.h"
#include "mien/transfer/transfer.h"

namespace {

void carry_rig(const char* source_file, const char* target_file, const char* out_file) {
  const mien::Character source = mien::load(source_file);
  const mien::Character target = mien::load(target_file);

  mien::TransferOptions options;
  options.max_influences = 4;  // what game engines read
  const mien::TransferResult result = mien::transfer(source, target, options);

  for (const mien::TransferWarning& warning : result.report.warnings)
    std::printf("warning: %s; %s\n", warning.what.c_str(), warning.remedy.c_str());
  mien::save(result.character, out_file);
  std::printf("%s: %zu shapes, %zu clips, by %zu landmarks\n", out_file, result.character.shapes.size(),
              result.character.clips.size(), result.report.pairs.names.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: transfer SOURCE TARGET OUT.glb\n");
    return 2;
  }
  try {
    carry_rig(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const mien::Error& error) {
    std::fprintf(stderr, "transfer: %s\n", error.what());
    return 1;
  }
}
