/// A bar with the time left, on a terminal and only for work over a second.
#pragma once

#include <chrono>
#include <cstddef>

namespace awmr::cli {

class ProgressBar {
 public:
  explicit ProgressBar(bool shown = true);
  ~ProgressBar();  ///< clears the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Redraws at most ten times a second. Calls must not overlap.
  void operator()(std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_at_ = start_;
};

}  // namespace awmr::cli
