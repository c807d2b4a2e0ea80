#include "awmr/core/output_target.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>

#include "awmr/core/descriptor.h"
#include "awmr/core/file.h"
#include "awmr/core/temporary_file.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;  ///< maximum chain of symbolic links, as in Linux

/// Resolves symbolic links. The last link may point to a missing file. Empty for a loop of links.
std::optional<fs::path> resolved(fs::path path) {
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path next = fs::read_symlink(path, error);
    if (error) return std::nullopt;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  if (fs::is_symlink(fs::symlink_status(path, error))) return std::nullopt;
  return path;
}

/// Opens a pipe or device for writing. Waits up to kPipeWait_s until a program reads the pipe.
Result<Descriptor> open_stream(const fs::path& path) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPipeWait_s);
  while (true) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() >= 0) {
      ::fcntl(file.number(), F_SETFL, ::fcntl(file.number(), F_GETFL) & ~O_NONBLOCK);
      return file;
    }
    if (errno != ENXIO) return write_error(path);
    if (std::chrono::steady_clock::now() > end) {
      return write_error(path, fmt::format("no program reads this pipe after {:g} s; start the "
                                           "reader first, or give a file",
                                           kPipeWait_s));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace

Result<OutputTarget> output_target(const fs::path& path) {
  OutputTarget target{.path = path};
  target.exists = ::stat(path.c_str(), &target.status) == 0;
  if (!target.exists && errno != ENOENT) return write_error(path);
  if (target.exists && S_ISDIR(target.status.st_mode)) {
    return write_error(path, "this is a directory; give a file");
  }
  target.is_stream = target.exists && !S_ISREG(target.status.st_mode);
  if (target.is_stream) return target;
  const auto file = resolved(path);
  if (!file) return write_error(path, "its symbolic links form a loop; give another name");
  target.path = *file;
  if (!target.exists) return target;
  const bool is_writable =
      (target.status.st_mode & 0222U) != 0 && ::access(path.c_str(), W_OK) == 0;
  if (!is_writable) {
    return write_error(path, "it is read-only; make it writable or give another name");
  }
  if (target.status.st_nlink > 1) {
    return write_error(path,
                       "the file has a second name (hard link), under which the old content would "
                       "remain; remove one of the two or give another name");
  }
  return target;
}

Status write_stream(const fs::path& path, std::string_view bytes) {
  AWMR_ASSIGN_OR_RETURN(const Descriptor file, open_stream(path));
  if (!write_all(file.number(), bytes)) return write_error(path);
  return {};
}

tl::unexpected<Error> write_error(const fs::path& path, const std::string& why) {
  return input_error(ErrorCode::kCannotWrite, path.string(), "cannot write the file: " + why);
}

tl::unexpected<Error> write_error(const fs::path& path) {
  return write_error(path, std::strerror(errno));
}

}  // namespace awmr
