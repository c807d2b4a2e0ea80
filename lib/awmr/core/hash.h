/// SHA-256, used to identify inputs in outputs.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// Hash of bytes that arrive in pieces.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// As sha256_hex(), of all bytes added. Call once.
  std::string hex();

 private:
  std::shared_ptr<void> context_;
};

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);
Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace awmr
