/// The lines that begin in a block of a file, read whole. Private to the library.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "awmr/core/input_bytes.h"

namespace awmr {

class LineBlock {
 public:
  /// A longer line is none of a table of numbers.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20U;
  /// Readable bytes behind lines().
  static constexpr std::size_t kPadding = 8;

  /// Reads the bytes [begin, end) of a file whose first line of interest begins at `first`. Errors: as
  /// InputBytes::read().
  Status read(const InputBytes& file, std::size_t first, std::size_t begin, std::size_t end);

  /// The bytes themselves.
  std::string_view bytes() const { return bytes_; }
  /// The lines that begin among them, each with its LF; the file's last one may have got it here.
  std::string_view lines() const { return lines_; }
  /// A line is longer than kLongestLine; lines() is empty.
  bool is_too_long() const { return is_too_long_; }

 private:
  std::vector<char> buffer_ = {};
  std::string_view bytes_ = {};
  std::string_view lines_ = {};
  bool is_too_long_ = false;
};

}  // namespace awmr
