#include "awmr/core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include "awmr/core/opened_file.h"
#include "awmr/core/output_target.h"
#include "awmr/core/temporary_file.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

/// Maximum number of bytes requested in one call of read().
constexpr std::size_t kBlock = std::size_t{1} << 18U;

/// Appends the rest of a file to `bytes`. Stops as soon as there are more than `max_bytes`, which
/// the caller reports. False if reading fails.
bool read_all(int descriptor, std::size_t max_bytes, std::string& bytes) {
  while (bytes.size() <= max_bytes) {
    const std::size_t before = bytes.size();
    bytes.resize(before + std::min(kBlock, max_bytes + 1 - before));
    const ssize_t count = ::read(descriptor, bytes.data() + before, bytes.size() - before);
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count == 0;
  }
  return true;
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

enum class PathKind { kNothing, kFile, kDirectory, kOther };

Result<PathKind> kind_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return PathKind::kNothing;
    return input_error(ErrorCode::kCannotRead, path.string(),
                       std::string("cannot look up this path: ") + std::strerror(errno));
  }
  if (S_ISREG(status.st_mode)) return PathKind::kFile;
  return S_ISDIR(status.st_mode) ? PathKind::kDirectory : PathKind::kOther;
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

Result<std::string> read_file(const fs::path& path, std::size_t max_bytes) {
  AWMR_ASSIGN_OR_RETURN(const OpenedFile file, OpenedFile::open(path));
  std::string bytes;
  bytes.reserve(std::min(file.size(), max_bytes) + kBlock);
  if (file.size() <= max_bytes && !read_all(file.descriptor(), max_bytes, bytes)) {
    return input_error(ErrorCode::kCannotRead, file.name(),
                       std::string("cannot read the file: ") + std::strerror(errno));
  }
  if (std::max(file.size(), bytes.size()) > max_bytes) {
    return too_long_error(file.name(), max_bytes);
  }
  AWMR_RETURN_IF_ERROR(file.check_unchanged());
  if (bytes.size() < file.size()) return became_shorter_error(file.name());
  return bytes;
}

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
  AWMR_ASSIGN_OR_RETURN(const PathKind kind, kind_of(path));
  return kind != PathKind::kNothing;
}

Result<bool> directory_exists(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const PathKind kind, kind_of(path));
  return kind == PathKind::kDirectory;
}

Result<bool> regular_file_exists(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const PathKind kind, kind_of(path));
  if (kind == PathKind::kNothing || kind == PathKind::kFile) return kind == PathKind::kFile;
  return input_error(ErrorCode::kWrongFile, path.string(),
                     kind == PathKind::kDirectory
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
