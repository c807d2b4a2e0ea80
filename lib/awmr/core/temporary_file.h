/// Temporary files for atomic output. Used by file.cpp; the programs call
/// remove_temporaries_on_signals().
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "awmr/core/descriptor.h"

namespace awmr {

/// False if writing fails; errno has the reason.
bool write_all(int descriptor, std::string_view bytes);

/// `DIRECTORY/.awmr-PID-XXXXXX`, short enough for any file system, whatever the output's name.
/// Removed by the destructor unless it was renamed.
class TemporaryFile {
 public:
  /// Nothing if it cannot be made; errno has the reason.
  static std::optional<TemporaryFile> in(const std::filesystem::path& directory);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  /// Writes and flushes; false on failure.
  bool write(std::string_view bytes, mode_t mode);
  bool rename_to(const std::filesystem::path& target);

 private:
  explicit TemporaryFile(std::filesystem::path path);
  void unregister_path();
  std::filesystem::path path_;  ///< empty: nothing to remove
  int slot_ = -1;               ///< slot in which a signal handler finds the path; -1: none
  Descriptor file_;
};

/// Makes signals that end this process (SIGINT, SIGTERM, SIGHUP, ...) remove its temporary files
/// first. An ignored signal, as under nohup, stays ignored. Call at program start.
void remove_temporaries_on_signals();

/// Removes temporary files in `directory` of programs that have ended: no process has their id, and
/// no process holds their lock (on another machine, ids mean other processes).
void remove_stale_temporaries(const std::filesystem::path& directory);

}  // namespace awmr
