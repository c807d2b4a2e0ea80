/// Where an output is written: a file, with symbolic links resolved, or a pipe or a device. Private
/// to core/.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// Where an output is written, and what exists there.
struct OutputTarget {
  std::filesystem::path path;  ///< with symbolic links resolved
  bool exists = false;
  bool is_stream = false;  ///< a terminal, a pipe or another device: written directly
  struct stat status {};
};

/// Looks up an output. Errors (input): it is a directory, a read-only file or a file with a second
/// hard link; its symbolic links form a loop; it cannot be looked up.
Result<OutputTarget> output_target(const std::filesystem::path& path);

/// Writes to a pipe or device. Waits up to kPipeWait_s until a program reads the pipe. Errors
/// (input): no program reads the pipe; writing fails.
Status write_stream(const std::filesystem::path& path, std::string_view bytes);

/// Error for an output that cannot be written, with the reason `why` or, without it, the text of
/// errno.
tl::unexpected<Error> write_error(const std::filesystem::path& path, const std::string& why);
tl::unexpected<Error> write_error(const std::filesystem::path& path);

}  // namespace awmr
