#include "awmr/core/input_bytes.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "awmr/core/hash.h"
#include "awmr/core/input_file.h"

namespace awmr {

Result<std::shared_ptr<const InputBytes>> InputBytes::open(const std::filesystem::path& path) {
  std::error_code error;
  // A pipe cannot be opened twice; some system files have bytes but report size 0.
  if (!std::filesystem::is_regular_file(path, error) ||
      std::filesystem::file_size(path, error) == 0) {
    AWMR_ASSIGN_OR_RETURN(std::string text, read_input(path));
    return std::make_shared<const InputBytes>(path.string(), std::move(text));
  }
  AWMR_ASSIGN_OR_RETURN(OpenedFile file, OpenedFile::open(path));
  if (file.size() > kMaxFileBytes) return too_long_error(file.name(), kMaxFileBytes);
  return std::shared_ptr<const InputBytes>(new InputBytes(std::move(file)));
}

Status InputBytes::read(std::size_t offset, std::span<char> bytes) const {
  if (!file_) {
    text_->copy(bytes.data(), bytes.size(), offset);
    return {};
  }
  while (!bytes.empty()) {
    const ssize_t count =
        ::pread(file_->descriptor(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return input_error(name_, std::string("cannot read the file: ") + std::strerror(errno));
    }
    if (count == 0) return became_shorter_error(name_);
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

Status InputBytes::check_unchanged() const { return file_ ? file_->check_unchanged() : Status(); }

Result<std::shared_ptr<const std::string>> InputBytes::whole() const {
  if (text_) return text_;
  std::string bytes(size(), '\0');
  AWMR_RETURN_IF_ERROR(read(0, bytes));
  AWMR_RETURN_IF_ERROR(check_unchanged());
  note_input(name_, sha256_hex(bytes));
  return std::make_shared<const std::string>(std::move(bytes));
}

}  // namespace awmr
