/// Temporary files that are renamed to their final name, for atomic output (file.cpp). A program
/// should call remove_temporaries_on_signals() at its start.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "awmr/core/files/descriptor.h"

namespace awmr {

/// Writes all bytes. False if writing fails; errno has the reason.
bool write_all(int descriptor, std::string_view bytes);

/// The temporary file `DIRECTORY/.awmr-PID-XXXXXX`. The name is short, so that any file system
/// accepts it. The destructor removes the file unless it was renamed.
class TemporaryFile {
 public:
  /// Makes a file in the directory; empty if that fails, and errno has the reason.
  static std::optional<TemporaryFile> in(const std::filesystem::path& directory);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  /// Writes all bytes, sets the permissions `mode` and flushes; false on failure.
  bool write(std::string_view bytes, mode_t mode);
  /// Renames the file to its final name, replacing an existing file; false on failure, and errno
  /// has the reason.
  bool rename_to(const std::filesystem::path& target);

 private:
  explicit TemporaryFile(std::filesystem::path path);
  void unregister_path();
  std::filesystem::path path_;  ///< empty: nothing to remove
  int slot_ = -1;               ///< index in the list of paths for the signal handler; -1: none
  Descriptor file_;
};

/// Installs handlers for signals that end this process (SIGINT, SIGTERM, SIGHUP, ...), which remove
/// its temporary files first. A signal that was set to be ignored, as with nohup, stays ignored.
void remove_temporaries_on_signals();

/// Removes from `directory` the temporary files that ended programs left behind: those for which no
/// process has the id in the name, and no process holds the lock. (Process ids alone are not
/// enough: in a directory that several machines share, each machine has its own ids.)
void remove_stale_temporaries(const std::filesystem::path& directory);

}  // namespace awmr
