#include "command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>

namespace mien::cli {
namespace {

std::atomic<bool> interrupted{false};

void on_interrupt(int) {
  interrupted = true;
}

}  // namespace

Progress progress_bar(const Common& common) {
  std::signal(SIGINT, on_interrupt);
  const bool visible = isatty(STDERR_FILENO) && !common.quiet && !common.json;
  return [visible](std::string_view step, double fraction) {
    if (visible) {
      const int filled = static_cast<int>(fraction * 30);
      fmt::print(stderr, "\r[{:-<30}] {:<30}", std::string(filled, '#'), step);
      if (fraction >= 1) fmt::print(stderr, "\r{:64}\r", "");
      std::fflush(stderr);
    }
    return !interrupted.load();
  };
}

void print_result(const Common& common, const std::string& text, const nlohmann::json& result) {
  if (common.json)
    fmt::print("{}\n", result.dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
  else if (!common.quiet)
    fmt::print("{}", text);
}

}  // namespace mien::cli
