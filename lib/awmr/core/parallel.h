/// Loops over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// Number of threads for the option `threads`: 0 means every core. At least 1.
std::size_t thread_count(int threads);

/// Calls body(i) for i = 0 ... count - 1 on up to `threads` threads (0: every core), including the
/// caller's. If body(i) writes only to data of item i, the result does not depend on the number of
/// threads. After an exception no further item starts. Once all threads have ended, the exception
/// of the smallest i is rethrown.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// Cancellation and progress callbacks of a long loop.
struct LoopControl {
  /// Called before each item: true ends the loop; started items are finished.
  std::function<bool()> stop = {};
  /// Called on the caller's thread after each item processed there.
  std::function<void()> progress = {};
};
/// As above, with cancellation and progress.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body,
                  const LoopControl& control);

}  // namespace awmr
