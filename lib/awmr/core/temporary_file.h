/// Files under a temporary name, which is how an output appears whole. Used by file.cpp; the programs
/// call remove_temporaries_on_signals().
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "awmr/core/descriptor.h"

namespace awmr {

/// False where writing fails; errno says why.
bool write_all(int descriptor, std::string_view bytes);

/// `DIRECTORY/.awmr-PID-XXXXXX`, short enough for any file system, whatever the output's name. Goes
/// away with the object unless it was renamed.
class TemporaryFile {
 public:
  /// Nothing where it cannot be made; errno says why.
  static std::optional<TemporaryFile> in(const std::filesystem::path& directory);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  /// Writes and flushes; false where that fails.
  bool write(std::string_view bytes, mode_t mode);
  bool rename_to(const std::filesystem::path& target);

 private:
  explicit TemporaryFile(std::filesystem::path path);
  void unregister_path();
  std::filesystem::path path_;  ///< empty: nothing to remove
  int slot_ = -1;               ///< where a signal handler finds the path; -1: nowhere
  Descriptor file_;
};

/// Removes the temporary files of this process before a signal that ends it does (SIGINT, SIGTERM,
/// SIGHUP, ...). A signal that is ignored, as under nohup, stays ignored. For the start of a program.
void remove_temporaries_on_signals();

/// Removes the temporary files in `directory` whose program is gone: no process has their number,
/// and nobody holds their lock (on another machine, where numbers mean other processes).
void remove_stale_temporaries(const std::filesystem::path& directory);

}  // namespace awmr
