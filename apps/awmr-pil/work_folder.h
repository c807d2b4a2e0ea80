// Private temporary folder for one run. It is removed however the run ends.
#pragma once

#include <filesystem>
#include <memory>

#include "awmr/core/result.h"

namespace awmr::pil {

/// Folder in TMPDIR that only this user can enter. The destructor removes the folder, and so does a
/// signal that ends the program (clean_up_at_signals()). If the program is killed (SIGKILL), the
/// folder remains, but its lock ends with the process. The next run removes such unlocked folders.
class WorkFolder {
 public:
  /// Removes the folders that killed runs left, then creates this run's folder. A process may have
  /// only one. Errors (input): TMPDIR is not an absolute path, or no folder can be created there.
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

/// After this call, a signal that ends the program (SIGINT, SIGTERM, SIGHUP, ...) first ends the
/// compiler and removes the work folder. Then it ends the program. Call once, before any other
/// thread exists. Signals that were ignored (nohup) stay ignored.
void clean_up_at_signals();

/// Returns at once if no signal is about to end the program. Otherwise never returns, so that the
/// program does not report errors which the signal caused.
void exit_if_interrupted();

}  // namespace awmr::pil
