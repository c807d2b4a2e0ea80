/// An open input that detects later modification. Private to the library.
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
  /// Errors: the file is missing, a directory or unreadable; a pipe that no program opens for
  /// writing within kPipeWait_s (file.h).
  static Result<OpenedFile> open(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  int descriptor() const { return descriptor_.number(); }
  /// Size in bytes when it was opened; 0: unknown, as for a pipe.
  std::size_t size() const;
  /// Errors: it was modified after it was opened.
  Status check_unchanged() const;

 private:
  OpenedFile(std::string name, Descriptor descriptor)
      : name_(std::move(name)), descriptor_(std::move(descriptor)) {}

  std::string name_;
  Descriptor descriptor_;
  struct stat status_ {};
};

tl::unexpected<Error> became_shorter_error(const std::string& name);
/// "it is longer than 1024 MiB ..."
tl::unexpected<Error> too_long_error(const std::string& name, std::size_t max_bytes);

}  // namespace awmr
