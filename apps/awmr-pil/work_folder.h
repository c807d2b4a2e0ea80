// A private folder for one run, and how it goes away.
#pragma once

#include <filesystem>
#include <memory>

#include "awmr/core/result.h"

namespace awmr::pil {

/// A folder in TMPDIR that only this user can enter. It goes away with the object, at a signal that
/// ends the program (see clean_up_at_signals), or, where the program had no time to clean up, at
/// the next run's start: its name says whose it was, and a lock on it lasts as long as the process.
class WorkFolder {
 public:
  /// Removes the folders of runs that are over, then makes this one's. There is one at a time.
  /// Errors (input): TMPDIR is missing, no folder, or cannot be written to.
  static Result<std::unique_ptr<WorkFolder>> make();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  WorkFolder() = default;
  std::filesystem::path path_;
  int lock_ = -1;
};

/// From here on a signal that ends the program (SIGINT, SIGTERM, SIGHUP, ...) first ends the
/// compiler and removes the work folder; the program then ends by that signal. To be called once,
/// before there is another thread. A signal that is ignored stays so (nohup).
void clean_up_at_signals();

/// Does not return if the program is about to end by a signal: what it did to the run is no fault
/// to be reported.
void end_if_told_to();

}  // namespace awmr::pil
