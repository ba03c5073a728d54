#include "command.h"

namespace mien::cli {

void add_sample(CLI::App& app, Common& common) {
  (void)common;
  app.add_subcommand("sample", "");
}

}  // namespace mien::cli
