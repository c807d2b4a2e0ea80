/// Processes items on several threads and collects the results in order. Private to the library.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

#include "awmr/core/result.h"

namespace awmr {

class InOrder {
 public:
  /// Waits for the earlier items and calls `taking`. False if no further item is needed. Items
  /// start in order, and each started item must call this.
  template <class Taking>
  bool take(std::size_t item, const Taking& taking) {
    std::unique_lock lock(mutex_);
    turn_.wait(lock, [&] { return has_ended_ || next_ == item; });
    if (has_ended_) return false;
    taking();
    ++next_;
    turn_.notify_all();
    return !has_ended_;
  }
  /// Calls `work`, which starts items. If it throws, threads that wait for these items are
  /// released.
  template <class Work>
  void guard(const Work& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      has_ended_ = true;
      turn_.notify_all();
      throw;
    }
  }
  /// Call within `taking`: no further item is needed.
  void end() { has_ended_ = true; }
  /// As end(), with an error.
  void fail(Error error) {
    error_ = std::move(error);
    has_ended_ = true;
  }
  /// Call after all threads have finished: true if every item was collected. Errors: that of
  /// fail().
  Result<bool> outcome() {
    if (error_) return tl::unexpected(std::move(*error_));
    return !has_ended_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable turn_;
  std::size_t next_ = 0;
  bool has_ended_ = false;
  std::optional<Error> error_ = {};
};

}  // namespace awmr
