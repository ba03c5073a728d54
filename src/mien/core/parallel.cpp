#include "mien/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace mien {
namespace {

std::unique_ptr<tbb::global_control> limit;

#if defined(__SANITIZE_THREAD__)
// ThreadSanitizer does not see how a TBB that was built without it synchronises, and would report every loop.
// Under it alone, plain threads do the work; `next` is relaxed so that it orders nothing between ranges that
// race.
void run(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) body(i);
  };
  std::vector<std::jthread> threads;
  for (int t = 1; t < thread_count(); ++t) threads.emplace_back(work);
  work();
}
#else
void run(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, body);
}
#endif

/// `body` for 0 ... count - 1; of several failures the one of the lowest number arrives, whatever ran first.
void run_all(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::mutex mutex;
  std::exception_ptr failure;
  std::size_t failed = count;
  run(count, [&](std::size_t i) {
    try {
      body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (i < failed) {
        failed = i;
        failure = std::current_exception();
      }
    }
  });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (count == 0) return;
  if (grain == 0) grain = 1;
  // The ranges are cut here, not by the scheduler: what a body sees never depends on the thread count.
  const std::size_t ranges = (count + grain - 1) / grain;
  run_all(ranges, [&](std::size_t r) {
    const std::size_t begin = r * grain;
    body(begin, begin + grain < count ? begin + grain : count);
  });
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
  run_all(2, [&](std::size_t i) { i == 0 ? first() : second(); });
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
