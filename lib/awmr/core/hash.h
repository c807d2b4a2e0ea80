/// SHA-256 hashes, by which output files identify the input files that they were made from.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace awmr {

/// Computes the hash of bytes that arrive in pieces.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// The hash of all bytes added, as 64 hexadecimal digits. May be called once.
  std::string hex();

 private:
  std::shared_ptr<void> context_;
};

/// The hash of the bytes as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace awmr
