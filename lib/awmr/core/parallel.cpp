#include "awmr/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace awmr {
namespace {

/// The exception of the smallest item, if any.
class FirstException {
 public:
  void keep(std::size_t item, std::exception_ptr exception) {
    const std::lock_guard lock(mutex_);
    if (exception_ && item_ < item) return;
    item_ = item;
    exception_ = std::move(exception);
  }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::size_t item_ = 0;
  std::exception_ptr exception_;
};

}  // namespace

std::size_t thread_count(int threads) {
  if (threads > 0) return static_cast<std::size_t>(threads);
  return std::max(1U, std::thread::hardware_concurrency());
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  parallel_for(count, threads, body, {});
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body,
                  const LoopControl& control) {
  std::atomic<std::size_t> next = 0;
  FirstException thrown;
  const auto work = [&](const std::function<void()>& progress) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        if (control.stop && control.stop()) return;
        body(i);
        if (progress) progress();
      } catch (...) {
        thrown.keep(i, std::current_exception());
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t t = 1; t < std::min(thread_count(threads), count); ++t) {
      helpers.emplace_back([&work] { work({}); });
    }
    work(control.progress);
  }
  thrown.rethrow();
}

}  // namespace awmr
