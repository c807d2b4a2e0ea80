#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/files/descriptor.h"

namespace awmr {
namespace {

/// Maximum number of bytes requested in one call of read().
constexpr std::size_t kBlock = std::size_t{1} << 18U;

/// An open input file, which can be checked for modification while it is read.
struct OpenedFile {
  std::string name;
  Descriptor descriptor;
  struct stat status {};  ///< when the file was opened
};

/// Waits up to kPipeWait_s until a program has opened the pipe for writing, or has left bytes in
/// it. Returns false if no program does. Uses tee(), which consumes no bytes and returns 0 for an
/// empty pipe without a writer.
bool has_writer(int pipe) {
  int copy[2] = {-1, -1};
  if (::pipe2(copy, O_CLOEXEC) != 0) return true;  // cannot check: reading will block for data
  const Descriptor copy_out(copy[0]);
  const Descriptor copy_in(copy[1]);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPipeWait_s);
  while (::tee(pipe, copy_in.number(), 1, SPLICE_F_NONBLOCK) == 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// Error for a file that cannot be read, with the text of errno.
tl::unexpected<Error> read_error(const std::string& name) {
  return input_error(ErrorCode::kCannotRead, name,
                     std::string("cannot read the file: ") + std::strerror(errno));
}

tl::unexpected<Error> became_shorter_error(const std::string& name) {
  return input_error(ErrorCode::kCannotRead, name,
                     "the file became shorter while it was read; wait until it is complete");
}

tl::unexpected<Error> too_long_error(const std::string& name, std::size_t max_bytes) {
  constexpr std::size_t kMebibyte = std::size_t{1} << 20U;
  const std::string most = max_bytes < kMebibyte ? fmt::format("{} bytes", max_bytes)
                                                 : fmt::format("{} MiB", max_bytes / kMebibyte);
  return input_error(ErrorCode::kTooLarge, name,
                     fmt::format("the file is longer than {}, the limit for such a file; check "
                                 "that it is the right one",
                                 most));
}

/// Opens a file for reading. Errors: the file is missing, a directory or unreadable; a pipe that no
/// program opens for writing within kPipeWait_s.
Result<OpenedFile> open_file(const std::filesystem::path& path) {
  OpenedFile file{path.string(),
                  Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK))};
  const int descriptor = file.descriptor.number();
  if (descriptor < 0) {
    return input_error(ErrorCode::kCannotRead, file.name,
                       std::string("cannot open the file: ") + std::strerror(errno));
  }
  if (::fstat(descriptor, &file.status) != 0) return read_error(file.name);
  if (S_ISDIR(file.status.st_mode)) {
    return input_error(ErrorCode::kWrongFile, file.name, "this is a directory; give a file");
  }
  if (S_ISFIFO(file.status.st_mode) && !has_writer(descriptor)) {
    return input_error(ErrorCode::kCannotRead, file.name,
                       fmt::format("no program writes to this pipe after {:g} s; start the writer "
                                   "first, or give a file",
                                   kPipeWait_s));
  }
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return file;
}

/// Size of the file when it was opened, bytes; 0 if unknown, as for a pipe.
std::size_t size_of(const OpenedFile& file) {
  return S_ISREG(file.status.st_mode) ? static_cast<std::size_t>(file.status.st_size) : 0;
}

/// Checks, by size and modification time, that the file was not modified since it was opened. A
/// file of unknown size is not checked. Errors: the file was modified.
Status check_unchanged(const OpenedFile& file) {
  struct stat now {};
  if (::fstat(file.descriptor.number(), &now) != 0) return read_error(file.name);
  if (size_of(file) == 0) return {};
  if (now.st_size < file.status.st_size) return became_shorter_error(file.name);
  const bool same = now.st_size == file.status.st_size &&
                    now.st_mtim.tv_sec == file.status.st_mtim.tv_sec &&
                    now.st_mtim.tv_nsec == file.status.st_mtim.tv_nsec;
  if (same) return {};
  return input_error(ErrorCode::kCannotRead, file.name,
                     "the file changed while it was read; wait until it is complete");
}

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

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  AWMR_ASSIGN_OR_RETURN(const OpenedFile file, open_file(path));
  const std::size_t size = size_of(file);
  std::string bytes;
  bytes.reserve(std::min(size, max_bytes) + kBlock);
  if (size <= max_bytes && !read_all(file.descriptor.number(), max_bytes, bytes)) {
    return read_error(file.name);
  }
  if (std::max(size, bytes.size()) > max_bytes) return too_long_error(file.name, max_bytes);
  AWMR_RETURN_IF_ERROR(check_unchanged(file));
  if (bytes.size() < size) return became_shorter_error(file.name);
  return bytes;
}

}  // namespace awmr
