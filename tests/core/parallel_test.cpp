/// Parallel loops: every item once, nested, from several threads, with the first exception.
#include "awmr/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace awmr::testing {
namespace {

/// Number of calls for each item.
std::vector<int> calls(std::size_t count, int threads) {
  std::vector<int> times(count, 0);
  parallel_for(count, threads, [&](std::size_t i) { ++times[i]; });
  return times;
}

TEST(ParallelFor, CallsEveryItemOnceWhateverTheThreads) {
  for (const int threads : {0, 1, 2, 3, 8}) {
    for (const std::size_t count : {0U, 1U, 2U, 7U, 1000U}) {
      EXPECT_EQ(calls(count, threads), std::vector<int>(count, 1)) << count << ", " << threads;
    }
  }
}

TEST(ParallelFor, TakesNoMoreThreadsThanItIsGivenFromLoopToLoop) {
  std::mutex mutex;
  std::set<std::thread::id> all;
  for (int loop = 0; loop < 300; ++loop) {
    std::set<std::thread::id> here;
    parallel_for(6, 3, [&](std::size_t) {
      const std::lock_guard lock(mutex);
      here.insert(std::this_thread::get_id());
    });
    EXPECT_LE(here.size(), 3U);
    all.insert(here.begin(), here.end());
  }
  // Loops use the caller's thread and reuse threads of earlier loops: a few in all, not two new
  // ones for each loop.
  EXPECT_LE(all.size(), 8U);
}

TEST(ParallelFor, EndsWithinItself) {
  std::atomic<int> leaves = 0;
  parallel_for(5, 3, [&](std::size_t) {
    parallel_for(7, 4, [&](std::size_t) { parallel_for(3, 2, [&](std::size_t) { ++leaves; }); });
  });
  EXPECT_EQ(leaves, 5 * 7 * 3);
}

TEST(ParallelFor, ServesSeveralCallersAtOnce) {
  std::atomic<int> items = 0;
  {
    std::vector<std::jthread> callers;
    for (int caller = 0; caller < 4; ++caller) {
      callers.emplace_back([&] {
        for (int loop = 0; loop < 50; ++loop) parallel_for(20, 3, [&](std::size_t) { ++items; });
      });
    }
  }
  EXPECT_EQ(items, 4 * 50 * 20);
}

TEST(ParallelFor, ThrowsTheExceptionOfTheSmallestItemAndGoesOnAfterwards) {
  for (int again = 0; again < 20; ++again) {
    try {
      parallel_for(2, 2, [](std::size_t i) { throw std::runtime_error(i == 0 ? "0" : "1"); });
      FAIL();
    } catch (const std::runtime_error& error) {
      // Item 0 begins before item 1 and throws after it.
      EXPECT_STREQ(error.what(), "0");
    }
    EXPECT_EQ(calls(10, 2), std::vector<int>(10, 1));
  }
}

TEST(ParallelFor, StopsBeforeTheNextItemAndReportsOnTheCallersThread) {
  std::atomic<int> begun = 0;
  int reported = 0;
  const std::thread::id caller = std::this_thread::get_id();
  LoopControl control;
  control.stop = [&] { return begun >= 5; };
  control.progress = [&] {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    ++reported;
  };
  parallel_for(
      1000, 2, [&](std::size_t) { ++begun; }, control);
  EXPECT_GE(begun, 5);
  EXPECT_LE(begun, 6);  // both threads may have fetched an item before the fifth
  EXPECT_LE(reported, begun);
}

}  // namespace
}  // namespace awmr::testing
