#include "mien/core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "mien/core/error.h"

namespace mien {
namespace {

using Ranges = std::vector<std::pair<std::size_t, std::size_t>>;

Ranges ranges_of(std::size_t count, std::size_t grain) {
  Ranges ranges;
  std::mutex mutex;
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    ranges.emplace_back(begin, end);
  });
  std::sort(ranges.begin(), ranges.end());
  return ranges;
}

TEST(parallel_for, what_a_body_throws_arrives) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t begin, std::size_t) {
                              if (begin == 42) throw invalid_input("index 42", "is the wrong answer");
                            }),
               Error);
}

TEST(parallel_for, of_several_failures_the_lowest_arrives) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    try {
      parallel_for(100, 1, [](std::size_t begin, std::size_t) {
        if (begin % 7 == 3) throw invalid_input("index " + std::to_string(begin), "fails");
      });
      FAIL() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "index 3: fails");
    }
  }
}

TEST(parallel_for, nothing_to_do_calls_nothing) {
  EXPECT_TRUE(ranges_of(0, 8).empty());
}

TEST(parallel_for, ranges_cover_all_once) {
  EXPECT_EQ(ranges_of(10, 4), (Ranges{{0, 4}, {4, 8}, {8, 10}}));
  EXPECT_EQ(ranges_of(3, 100), (Ranges{{0, 3}}));
  EXPECT_EQ(ranges_of(2, 0), (Ranges{{0, 1}, {1, 2}})) << "a grain of 0 counts as 1";
}

TEST(parallel_for, ranges_do_not_depend_on_the_thread_count) {
  set_thread_count(1);
  const Ranges one = ranges_of(1000, 7);
  set_thread_count(2);
  const Ranges two = ranges_of(1000, 7);
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

TEST(parallel_for, bodies_write_side_by_side) {
  std::vector<int> slots(10000, 0);
  parallel_for(slots.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) slots[i] = static_cast<int>(i);
  });
  for (std::size_t i = 0; i < slots.size(); ++i) ASSERT_EQ(slots[i], static_cast<int>(i));
}

TEST(parallel_for, may_be_nested) {
  std::vector<int> slots(64, 0);
  parallel_for(8, 1, [&](std::size_t row, std::size_t) {
    parallel_for(8, 1, [&](std::size_t column, std::size_t) { slots[row * 8 + column] += 1; });
  });
  EXPECT_EQ(std::count(slots.begin(), slots.end(), 1), 64);
}

TEST(parallel_invoke, runs_both) {
  int first = 0, second = 0;
  parallel_invoke([&] { first = 1; }, [&] { second = 2; });
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 2);
}

TEST(set_thread_count, limits_and_restores) {
  const int all = thread_count();
  EXPECT_GE(all, 1);
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  set_thread_count(0);
  EXPECT_EQ(thread_count(), all);
}

}  // namespace
}  // namespace mien
