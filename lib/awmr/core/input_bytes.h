/// The bytes of an input by position: of a file they are read in blocks, so that it need not fit into
/// memory; what can be read only once, such as a pipe, is read whole.
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
  /// Of a text that is in memory; `name` stands for it in errors.
  InputBytes(std::string name, std::string text)
      : name_(std::move(name)), text_(std::make_shared<const std::string>(std::move(text))) {}

  const std::string& name() const { return name_; }
  std::size_t size() const { return file_ ? file_->size() : text_->size(); }
  /// It is read in blocks: its hash is not known before the last one, see note_input().
  bool is_file() const { return file_.has_value(); }

  /// Fills `bytes` with what begins at `offset`. Precondition: it ends within size(). Errors: the file
  /// cannot be read or became shorter.
  Status read(std::size_t offset, std::span<char> bytes) const;
  /// Errors: the file was written to since it was opened.
  Status check_unchanged() const;
  /// All of it, its hash noted as by read_input(). Errors: as read() and check_unchanged().
  Result<std::shared_ptr<const std::string>> whole() const;

 private:
  explicit InputBytes(OpenedFile file) : name_(file.name()), file_(std::move(file)) {}

  std::string name_;
  std::optional<OpenedFile> file_ = {};
  std::shared_ptr<const std::string> text_ = {};
};

}  // namespace awmr
