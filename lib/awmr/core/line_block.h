/// Reads the lines that begin in one block of a file, completely. Private to the library.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "awmr/core/input_bytes.h"

namespace awmr {

class LineBlock {
 public:
  /// Numeric tables have no longer lines.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20U;
  /// Readable bytes behind lines().
  static constexpr std::size_t kPadding = 8;

  /// Reads the lines that begin in bytes [begin, end). The first line of interest begins at
  /// `first`. Errors: as InputBytes::read().
  Status read(const InputBytes& file, std::size_t first, std::size_t begin, std::size_t end);

  /// The bytes of the block.
  std::string_view bytes() const { return bytes_; }
  /// The lines that begin in the block, each with its LF; a missing LF at the end of the file is
  /// added.
  std::string_view lines() const { return lines_; }
  /// True if a line is longer than kLongestLine; lines() is empty then.
  bool is_too_long() const { return is_too_long_; }

 private:
  std::vector<char> buffer_ = {};
  std::string_view bytes_ = {};
  std::string_view lines_ = {};
  bool is_too_long_ = false;
};

}  // namespace awmr
