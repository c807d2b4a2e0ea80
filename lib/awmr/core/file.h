/// Files: memory-mapped input and output that appears whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// A file's bytes, mapped read-only for as long as the object lives. An empty file has an empty
/// view.
class MappedFile {
 public:
  /// Errors: the file is missing, a directory, or unreadable.
  static Result<MappedFile> open(const std::filesystem::path& path);
  std::string_view bytes() const { return bytes_; }

 private:
  std::shared_ptr<void> region_;
  std::string_view bytes_;
};

Result<std::string> read_file(const std::filesystem::path& path);

/// Writes beside `path`, flushes and renames, so that a reader sees the old file or the new one,
/// never part of either. A pipe or a terminal is written to as it is. Makes no directory.
/// Errors: the directory is missing or not writable; `path` is a directory.
Status write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes `path` and its parents where they are missing.
Status make_directory(const std::filesystem::path& path);

}  // namespace awmr
