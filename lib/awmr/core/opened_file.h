/// An open input file that can be checked for modification while it is read. Private to the
/// library.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "awmr/core/descriptor.h"
#include "awmr/core/result.h"

namespace awmr {

class OpenedFile {
 public:
  /// Opens a file for reading. Errors: the file is missing, a directory or unreadable; a pipe that
  /// no program opens for writing within kPipeWait_s (file.h).
  static Result<OpenedFile> open(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  int descriptor() const { return descriptor_.number(); }
  /// Size of the file when it was opened, bytes; 0 if unknown, as for a pipe.
  std::size_t size() const;
  /// Checks, by size and modification time, that the file was not modified since it was opened. A
  /// file of unknown size is not checked. Errors: the file was modified.
  Status check_unchanged() const;

 private:
  OpenedFile(std::string name, Descriptor descriptor)
      : name_(std::move(name)), descriptor_(std::move(descriptor)) {}

  std::string name_;
  Descriptor descriptor_;
  struct stat status_ {};
};

/// Error for a file that became shorter while it was read.
tl::unexpected<Error> became_shorter_error(const std::string& name);
/// Error for a file that is longer than `max_bytes`.
tl::unexpected<Error> too_long_error(const std::string& name, std::size_t max_bytes);

}  // namespace awmr
