/// Items that are worked on by several threads at once and taken one after the other. Private to the
/// library.
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
  /// Waits for the items before this one and calls `taking`. False where no further item counts. Items
  /// are begun in their order, and each that is begun comes here.
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
  /// Calls `work`, which begins items; where it throws, no thread waits for what it had begun.
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
  /// Within `taking`: no further item counts.
  void end() { has_ended_ = true; }
  /// The same, for a reason.
  void fail(Error error) {
    error_ = std::move(error);
    has_ended_ = true;
  }
  /// Once all threads are done: whether every item was taken. Errors: that of fail().
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
