#include "awmr/core/opened_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "awmr/core/file.h"

namespace awmr {
namespace {

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

}  // namespace

Result<OpenedFile> OpenedFile::open(const std::filesystem::path& path) {
  OpenedFile file(path.string(),
                  Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)));
  if (file.descriptor() < 0) {
    return input_error(ErrorCode::kCannotRead, file.name_,
                       std::string("cannot open the file: ") + std::strerror(errno));
  }
  if (::fstat(file.descriptor(), &file.status_) != 0) {
    return input_error(ErrorCode::kCannotRead, file.name_,
                       std::string("cannot read the file: ") + std::strerror(errno));
  }
  if (S_ISDIR(file.status_.st_mode)) {
    return input_error(ErrorCode::kWrongFile, file.name_, "this is a directory; give a file");
  }
  if (S_ISFIFO(file.status_.st_mode) && !has_writer(file.descriptor())) {
    return input_error(ErrorCode::kCannotRead, file.name_,
                       fmt::format("no program writes to this pipe after {:g} s; start the writer "
                                   "first, or give a file",
                                   kPipeWait_s));
  }
  ::fcntl(file.descriptor(), F_SETFL, ::fcntl(file.descriptor(), F_GETFL) & ~O_NONBLOCK);
  return file;
}

std::size_t OpenedFile::size() const {
  return S_ISREG(status_.st_mode) ? static_cast<std::size_t>(status_.st_size) : 0;
}

Status OpenedFile::check_unchanged() const {
  struct stat now {};
  if (::fstat(descriptor(), &now) != 0) {
    return input_error(ErrorCode::kCannotRead, name_,
                       std::string("cannot read the file: ") + std::strerror(errno));
  }
  if (size() == 0) return {};
  if (now.st_size < status_.st_size) return became_shorter_error(name_);
  const bool same = now.st_size == status_.st_size &&
                    now.st_mtim.tv_sec == status_.st_mtim.tv_sec &&
                    now.st_mtim.tv_nsec == status_.st_mtim.tv_nsec;
  if (same) return {};
  return input_error(ErrorCode::kCannotRead, name_,
                     "the file changed while it was read; wait until it is complete");
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

}  // namespace awmr
