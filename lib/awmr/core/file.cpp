#include "awmr/core/file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace awmr {
namespace {

/// Closes a descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

std::string reason() { return std::strerror(errno); }

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool read_all(int descriptor, std::string& bytes) {
  std::array<char, 65536> block;
  while (true) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count == 0;
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
}

/// What umask() takes from a new file's mode. It can only be read by setting it, so once.
mode_t creation_mask() {
  static const mode_t mask = [] {
    const mode_t current = ::umask(077);
    ::umask(current);
    return current;
  }();
  return mask;
}

/// Makes the renaming last; where the system cannot, the new file still stands whole.
void flush_directory(const std::filesystem::path& path) {
  const Descriptor directory(
      ::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number() >= 0) ::fsync(directory.number());
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  const std::string name = path.string();
  const Descriptor file(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) return input_error(name, "cannot open the file: " + reason());
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) {
    return input_error(name, "cannot read the file: " + reason());
  }
  if (S_ISDIR(status.st_mode)) return input_error(name, "this is a directory; give a file");
  MappedFile mapped;
  if (!S_ISREG(status.st_mode)) {
    const auto bytes = std::make_shared<std::string>();
    if (!read_all(file.number(), *bytes)) {
      return input_error(name, "cannot read the file: " + reason());
    }
    mapped.bytes_ = *bytes;
    mapped.region_ = bytes;
    return mapped;
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return mapped;
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number(), 0);
  if (address == MAP_FAILED) return input_error(name, "cannot read the file: " + reason());
  mapped.region_ = std::shared_ptr<void>(address, [size](void* at) { ::munmap(at, size); });
  mapped.bytes_ = {static_cast<const char*>(address), size};
  return mapped;
}

Result<std::string> read_file(const std::filesystem::path& path) {
  const auto mapped = MappedFile::open(path);
  if (!mapped) return tl::unexpected(mapped.error());
  return std::string(mapped->bytes());
}

Status write_file(const std::filesystem::path& path, std::string_view bytes) {
  const auto failed = [&](const std::string& why) {
    return input_error(path.string(), "cannot write the file: " + why);
  };
  struct stat old {};
  const bool exists = ::stat(path.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) return failed("this is a directory; give a file");
  if (exists && !S_ISREG(old.st_mode)) {  // a terminal or a pipe cannot be replaced
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.number() < 0 || !write_all(file.number(), bytes)) return failed(reason());
    return {};
  }
  // Through a symbolic link, the file it points to is replaced, not the link.
  std::error_code error;
  const auto target = exists ? std::filesystem::canonical(path, error) : path;
  if (error) return failed(error.message());
  std::string temporary = target.string() + ".XXXXXX";
  const Descriptor file(::mkstemp(temporary.data()));
  if (file.number() < 0) return failed(reason());
  const mode_t mode = exists ? old.st_mode & 07777U : 0666U & ~creation_mask();
  if (!write_all(file.number(), bytes) || ::fchmod(file.number(), mode) != 0 ||
      ::fsync(file.number()) != 0 || ::rename(temporary.c_str(), target.c_str()) != 0) {
    const std::string why = reason();
    ::unlink(temporary.c_str());
    return failed(why);
  }
  flush_directory(target.parent_path());
  return {};
}

Status make_directory(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) {
    return input_error(path.string(), "cannot make the directory: " + error.message());
  }
  return {};
}

}  // namespace awmr
