/// Loops over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// The number of threads that `threads` asks for: 0 means every core. At least 1.
std::size_t thread_count(int threads);

/// Calls body(i) for i = 0 ... count - 1, on up to `threads` threads (0: every core), the caller's
/// among them. Where body(i) writes only to what belongs to i, the result does not depend on the
/// number of threads. After an exception no further item begins, and once all threads have ended
/// the exception is thrown again, that of the smallest i where there are several.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// What a long loop tells and is told while it runs.
struct LoopControl {
  /// Asked before each item: true ends the loop, items that have begun are finished.
  std::function<bool()> stop = {};
  /// Called on the caller's thread after each item that it has worked on.
  std::function<void()> progress = {};
};
/// The same, with a way to end it early and to follow it.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body,
                  const LoopControl& control);

}  // namespace awmr
