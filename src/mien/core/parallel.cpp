#include "mien/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <memory>

namespace mien {
namespace {
std::unique_ptr<tbb::global_control> limit;
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (count == 0) return;
  if (grain == 0) grain = 1;
  // The ranges are cut here, not by the scheduler: what a body sees never depends on the thread count.
  const std::size_t ranges = (count + grain - 1) / grain;
  tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t r) {
    const std::size_t begin = r * grain;
    body(begin, begin + grain < count ? begin + grain : count);
  });
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
  tbb::parallel_invoke(first, second);
}

void set_thread_count(int threads) {
  limit.reset();
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace mien
