#include "awmr/core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstring>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "awmr/core/files/descriptor.h"
#include "awmr/core/files/temporary_file.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

/// Error for an output that cannot be written, with the reason `why` or, without it, the text of
/// errno.
tl::unexpected<Error> write_error(const fs::path& path, const std::string& why) {
  return input_error(ErrorCode::kCannotWrite, path.string(), "cannot write the file: " + why);
}

tl::unexpected<Error> write_error(const fs::path& path) {
  return write_error(path, std::strerror(errno));
}

/// Where an output is written: a file, with symbolic links resolved, or a pipe or a device.
struct OutputTarget {
  fs::path path;  ///< with symbolic links resolved
  bool exists = false;
  bool is_stream = false;  ///< a terminal, a pipe or another device: written directly
  struct stat status {};
};

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

/// Looks up an output. Errors (input): it is a directory, a read-only file or a file with a second
/// hard link; its symbolic links form a loop; it cannot be looked up.
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

/// Writes to a pipe or device. Errors (input): no program reads the pipe; writing fails.
Status write_stream(const fs::path& path, std::string_view bytes) {
  AWMR_ASSIGN_OR_RETURN(const Descriptor file, open_stream(path));
  if (!write_all(file.number(), bytes)) return write_error(path);
  return {};
}

/// Checks an output with `read_back` before it is written. Rejected bytes are an internal error
/// (kFault), because the program itself has made a wrong file.
Status check_read_back(const fs::path& path, std::string_view bytes, const ReadBack& read_back) {
  if (!read_back) return {};
  const Status read = read_back(bytes, path.string());
  if (read) return {};
  const Fault& first = read.error().faults.front();
  return program_fault(fmt::format(
      "{} was not written, because awmr could not read it again ({}: {}). An existing file is "
      "unchanged; please report this with the inputs",
      path.string(), first.place, first.message));
}

Result<fs::file_status> status_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::status_known(status)) return status;
  return input_error(ErrorCode::kCannotRead, path.string(),
                     "cannot look up this path: " + error.message());
}

/// The umask of this process, read only once: reading changes it for a moment, which would disturb
/// other threads.
mode_t creation_mask() {
  static const mode_t kMask = [] {
    const mode_t current = ::umask(077);
    ::umask(current);
    return current;
  }();
  return kMask;
}

fs::path directory_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Flushes a directory, so that a rename in it survives a power failure. Failures are ignored.
void flush_directory(const fs::path& path) {
  const Descriptor directory(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number() >= 0) ::fsync(directory.number());
}

/// An output whose bytes are in a temporary file that is not yet renamed.
struct Staged {
  fs::path path;  ///< as the user gave it
  std::string_view bytes;
  OutputTarget target;
  std::optional<TemporaryFile> temporary;  ///< none if the output is a pipe or a device
};

Result<Staged> stage(const fs::path& path, std::string_view bytes, const ReadBack& read_back) {
  AWMR_RETURN_IF_ERROR(check_read_back(path, bytes, read_back));
  AWMR_ASSIGN_OR_RETURN(OutputTarget target, output_target(path));
  if (target.is_stream) return Staged{path, bytes, std::move(target), std::nullopt};
  const fs::path directory = directory_of(target.path);
  remove_stale_temporaries(directory);
  auto temporary = TemporaryFile::in(directory);
  if (!temporary) return write_error(path);
  const mode_t mode = target.exists ? target.status.st_mode & 07777U : 0666U & ~creation_mask();
  if (!temporary->write(bytes, mode)) return write_error(path);
  return Staged{path, bytes, std::move(target), std::move(temporary)};
}

/// Renames all temporary files to their final names, and writes to pipes and devices.
Status finish(std::vector<Staged> files) {
  for (Staged& file : files) {
    if (!file.temporary) {
      AWMR_RETURN_IF_ERROR(write_stream(file.path, file.bytes));
    } else if (!file.temporary->rename_to(file.target.path)) {
      return write_error(file.path);
    }
  }
  std::set<fs::path> directories;
  for (const Staged& file : files) {
    if (file.temporary) directories.insert(directory_of(file.target.path));
  }
  for (const fs::path& directory : directories) flush_directory(directory);
  return {};
}

}  // namespace

Status write_file(const fs::path& path, std::string_view bytes, const ReadBack& read_back) {
  AWMR_ASSIGN_OR_RETURN(Staged file, stage(path, bytes, read_back));
  std::vector<Staged> files;
  files.push_back(std::move(file));
  return finish(std::move(files));
}

Status write_files(std::span<const OutputFile> files) {
  std::vector<Staged> all;
  for (const OutputFile& file : files) {
    AWMR_RETURN_IF_ERROR(check_regular_file(file.path));
    AWMR_ASSIGN_OR_RETURN(Staged staged, stage(file.path, file.bytes, file.read_back));
    all.push_back(std::move(staged));
  }
  return finish(std::move(all));
}

Status check_output(const fs::path& path, std::span<const fs::path> inputs) {
  AWMR_ASSIGN_OR_RETURN(const OutputTarget target, output_target(path));
  if (target.is_stream) return {};
  for (const fs::path& input : inputs) {
    struct stat status {};
    if (!target.exists || ::stat(input.c_str(), &status) != 0) continue;
    if (status.st_dev == target.status.st_dev && status.st_ino == target.status.st_ino) {
      return write_error(path,
                         fmt::format("it is the input {}; give another name", input.string()));
    }
  }
  const fs::path directory = directory_of(target.path);
  if (::access(directory.c_str(), W_OK | X_OK) != 0) {
    return write_error(path,
                       fmt::format("directory {}: {}", directory.string(), std::strerror(errno)));
  }
  return {};
}

Result<bool> path_exists(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const fs::file_status status, status_of(path));
  return fs::exists(status);
}

Result<bool> directory_exists(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const fs::file_status status, status_of(path));
  return fs::is_directory(status);
}

Result<bool> regular_file_exists(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const fs::file_status status, status_of(path));
  if (!fs::exists(status) || fs::is_regular_file(status)) return fs::exists(status);
  return input_error(ErrorCode::kWrongFile, path.string(),
                     fs::is_directory(status)
                         ? "this is a directory, but a file is expected; move it away"
                         : "this is a pipe or a device, but a file is expected; move it away");
}

Status check_regular_file(const fs::path& path) {
  AWMR_RETURN_IF_ERROR(regular_file_exists(path));
  return {};
}

Status check_output_directory(const fs::path& path) {
  fs::path there = path;
  for (;;) {
    AWMR_ASSIGN_OR_RETURN(const bool exists, path_exists(there));
    if (exists || there == directory_of(there)) break;
    if (there.filename().native().size() > NAME_MAX) {
      return input_error(ErrorCode::kBadName, path.string(),
                         fmt::format("a name of {} bytes is too long; the limit is {}. Give a "
                                     "shorter name",
                                     there.filename().native().size(), NAME_MAX));
    }
    there = directory_of(there);
  }
  AWMR_ASSIGN_OR_RETURN(const bool is_a_directory, directory_exists(there));
  if (!is_a_directory) {
    return input_error(ErrorCode::kWrongFile, there.string(),
                       "this is a file, but a directory is needed; give another name");
  }
  if (::access(there.c_str(), W_OK | X_OK) != 0) {
    return input_error(ErrorCode::kCannotWrite, path.string(),
                       fmt::format("no file can be made in {}: {}; give another name",
                                   there.string(), std::strerror(errno)));
  }
  return {};
}

Status make_directory(const fs::path& path) {
  AWMR_RETURN_IF_ERROR(check_output_directory(path));
  std::error_code error;
  fs::create_directories(path, error);
  if (error) {
    return input_error(ErrorCode::kCannotWrite, path.string(),
                       "cannot make the directory: " + error.message());
  }
  return {};
}

Result<std::vector<fs::path>> list_directory(const fs::path& path) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    entries.push_back(it->path());
  }
  if (error) {
    return input_error(ErrorCode::kCannotRead, path.string(),
                       "cannot read the directory: " + error.message());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace awmr
