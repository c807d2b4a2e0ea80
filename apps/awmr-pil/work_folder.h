// Private temporary folder for one run, and its removal.
#pragma once

#include <filesystem>
#include <memory>

#include "awmr/core/result.h"

namespace awmr::pil {

/// Folder in TMPDIR that only this user can enter. It is removed with the object, or at a signal
/// that ends the program (see clean_up_at_signals). If the program could not clean up, the next run
/// removes it: its name identifies the process, whose lock ends with it.
class WorkFolder {
 public:
  /// Removes the folders of finished runs, then creates this run's folder. Only one may exist at a
  /// time. Errors (input): TMPDIR is missing, not a directory or not writable.
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
/// compiler and removes the work folder. The program then ends by that signal. Call once, before
/// any other thread exists. Ignored signals stay ignored (nohup).
void clean_up_at_signals();

/// Does not return if a signal is about to end the program: errors that it caused are not reported.
void end_if_told_to();

}  // namespace awmr::pil
