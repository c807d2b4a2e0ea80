#include "awmr/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace awmr {
namespace {

/// Keeps the exception of the item with the smallest index, so that the result does not depend on
/// the order in which the threads run.
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

/// Worker threads that are kept between loops, because a search runs thousands of loops, and
/// starting a thread takes about as long as one loop. A loop waits only for the threads that work
/// on it, so nested loops cannot block each other.
class Helpers {
 public:
  ~Helpers() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    offered_.notify_all();
  }

  /// Calls `own_work` on this thread, and `work` on up to `most` other threads as they become free.
  /// Returns when all calls have returned.
  void share(std::size_t most, const std::function<void()>& own_work,
             const std::function<void()>& work) {
    Loop loop{&work, most, 0};
    {
      const std::lock_guard lock(mutex_);
      grow_to(most);
      loops_.push_back(&loop);
    }
    offered_.notify_all();
    own_work();
    std::unique_lock lock(mutex_);
    std::erase(loops_, &loop);
    left_.wait(lock, [&] { return loop.running == 0; });
  }

 private:
  struct Loop {
    const std::function<void()>* work;
    std::size_t wanted;   ///< number of further threads that may join
    std::size_t running;  ///< number of worker threads now in `work`
  };

  /// Starts threads until there are `count`, or as many as the system permits. Results do not
  /// depend on their number.
  void grow_to(std::size_t count) {
    try {
      while (threads_.size() < count) threads_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {
    }
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (true) {
      offered_.wait(lock, [&] { return ended_ || !loops_.empty(); });
      if (ended_) return;
      Loop& loop = *loops_.front();
      if (--loop.wanted == 0) loops_.erase(loops_.begin());
      ++loop.running;
      lock.unlock();
      (*loop.work)();
      lock.lock();
      --loop.running;
      // A thread ends its work on a loop only if no item is left, so no other thread needs to join.
      std::erase(loops_, &loop);
      left_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable offered_, left_;
  std::vector<Loop*> loops_;  ///< loops that need threads, the oldest first
  bool ended_ = false;
  /// Must be the last member: it is destroyed first, while the members that its threads use still
  /// exist.
  std::vector<std::jthread> threads_;
};

Helpers& helpers() {
  static Helpers all;
  return all;
}

}  // namespace

std::size_t thread_count(int threads) {
  if (threads > 0) return static_cast<std::size_t>(threads);
  return std::max(1U, std::thread::hardware_concurrency());
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
  const std::size_t used = std::min(thread_count(threads), count);
  if (used > 1) {
    helpers().share(
        used - 1, [&] { work(control.progress); }, [&] { work({}); });
  } else {
    work(control.progress);
  }
  thrown.rethrow();
}

}  // namespace awmr
