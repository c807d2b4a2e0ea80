/// Runs a loop over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// Number of threads for the option `threads`, where 0 means one per core. The result is at least
/// 1.
std::size_t thread_count(int threads);

/// Cancellation and progress callbacks of a long loop.
struct LoopControl {
  /// Called before each item, on the thread that would process the item. Several threads may call
  /// it at once. If it returns true, no further item is started.
  std::function<bool()> stop = {};
  /// Called after each item that the caller's thread has processed, on that thread.
  std::function<void()> progress = {};
};

/// Calls body(i) for i = 0 ... count - 1 on up to `threads` threads (0: one per core), including
/// the caller's. If body(i) writes only to data of item i, the result does not depend on the number
/// of threads. After an exception, no further item is started. When all started items have ended,
/// the exception of the smallest i is rethrown.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body,
                  const LoopControl& control = {});

}  // namespace awmr
