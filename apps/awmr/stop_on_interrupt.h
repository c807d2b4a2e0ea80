/// Stops a long computation by Ctrl-C (SIGINT), so that its finished part can be written.
#pragma once

#include <atomic>
#include <string>

namespace awmr::cli {

/// Handles SIGINT during its lifetime. The first signal requests a stop; a second one ends the
/// program at once, as without this object.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  /// Set by the first signal. Runs in progress finish, no new run starts.
  static std::atomic<bool>& requested();
};

/// Prints the notice (not with --json), then ends the program by SIGINT, so that the caller sees
/// the exit status of a program that Ctrl-C has ended.
void end_interrupted(const std::string& notice);

}  // namespace awmr::cli
