/// Random access to the bytes of an input. Files are read in blocks and need not fit into memory.
/// Inputs that can be read only once, such as pipes, are read whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "awmr/core/opened_file.h"
#include "awmr/core/result.h"

namespace awmr {

class InputBytes {
 public:
  /// Errors: as read_file().
  static Result<std::shared_ptr<const InputBytes>> open(const std::filesystem::path& path);
  /// From text in memory; `name` names it in errors.
  InputBytes(std::string name, std::string text)
      : name_(std::move(name)), text_(std::make_shared<const std::string>(std::move(text))) {}

  const std::string& name() const { return name_; }
  std::size_t size() const { return file_ ? file_->size() : text_->size(); }
  /// Read in blocks: the hash is unknown until the last one, see note_input().
  bool is_file() const { return file_.has_value(); }

  /// Fills `bytes` from `offset` on. Precondition: the range ends within size(). Errors: the file
  /// cannot be read or has become shorter.
  Status read(std::size_t offset, std::span<char> bytes) const;
  /// Errors: the file was modified after it was opened.
  Status check_unchanged() const;
  /// All bytes; records their hash like read_input(). Errors: as read() and check_unchanged().
  Result<std::shared_ptr<const std::string>> whole() const;

 private:
  explicit InputBytes(OpenedFile file) : name_(file.name()), file_(std::move(file)) {}

  std::string name_;
  std::optional<OpenedFile> file_ = {};
  std::shared_ptr<const std::string> text_ = {};
};

}  // namespace awmr
