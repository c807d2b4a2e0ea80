/// Lets Ctrl-C (SIGINT) stop a long computation so that its finished part can still be written.
#pragma once

#include <atomic>
#include <string>

namespace awmr::cli {

/// Handles SIGINT as long as the object exists. The first signal requests a stop; a second signal
/// ends the program at once.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  /// True after the first signal. The computation then finishes its runs in progress and starts no
  /// new run.
  static std::atomic<bool>& requested();
};

/// Prints the notice (not with --json). Then ends the program by the signal SIGINT itself. The
/// calling program or shell then sees that Ctrl-C ended it.
void end_interrupted(const std::string& notice);

}  // namespace awmr::cli
