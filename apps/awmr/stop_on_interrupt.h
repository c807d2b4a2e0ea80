/// Lets Ctrl-C (SIGINT) stop a long computation in such a way that the finished part of the results
/// can be written.
#pragma once

#include <atomic>
#include <string>

namespace awmr::cli {

/// Handles SIGINT as long as the object exists. The first signal requests a stop. A second one ends
/// the program at once, as it would without this object.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  /// True after the first signal. Runs in progress are then finished, but no new run is started.
  static std::atomic<bool>& requested();
};

/// Prints the notice (not with --json). Then ends the program by the signal SIGINT itself, so that
/// the calling program or shell sees that Ctrl-C ended it.
void end_interrupted(const std::string& notice);

}  // namespace awmr::cli
