#pragma once
/// Loops over all cores whose results do not depend on the number of threads.

#include <cstddef>
#include <functional>

namespace mien {

/// Calls `body(begin, end)` on disjoint ranges that together cover [0, count). Ranges run in any order and at
/// the same time: a body writes only to slots of its own range. Sums over all indices are the caller's to do
/// in index order afterwards, so that the same input gives the same bytes at any thread count.
///   grain   the most indices in one range; the ranges depend on `count` and `grain` alone
///   throws  what a body throws, after all ranges have run: of several failures the one of the lowest range,
///           so that the same input fails with the same words
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Runs the independent tasks side by side.
void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second);

/// Limits all of mien's loops to this many threads; 0 restores all cores. Not to be called while a loop runs.
void set_thread_count(int threads);
int thread_count();

}  // namespace mien
