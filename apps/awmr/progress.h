/// A progress bar with the time left, on a terminal only and for work over a second.
#pragma once

#include <chrono>
#include <string>

namespace awmr::cli {

class Progress {
 public:
  Progress(std::string title, int total);
  /// Redraws at most ten times a second. Calls must not overlap.
  void at(int done);
  /// Clears the bar.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string title_;
  int total_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point begin_;
  Clock::time_point last_;
};

}  // namespace awmr::cli
