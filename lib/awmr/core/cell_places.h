/// Where the cells of a table stand that was read without noting it. Private to the library.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "awmr/core/input_bytes.h"

namespace awmr {

/// Every line feed from the first row on ends a line, and every row is one line.
class CellPlaces {
 public:
  /// The first row begins at byte `first_row`, in line `first_line`.
  CellPlaces(std::shared_ptr<const InputBytes> bytes, std::size_t first_row, int first_line,
             char delimiter)
      : bytes_(std::move(bytes)),
        first_row_(first_row),
        first_line_(first_line),
        delimiter_(delimiter) {}

  /// The place in its line, from 1, of a cell, from 0; reads the file again up to there. 1 where it
  /// is no longer what it was.
  int character(int line, std::size_t cell) const;

 private:
  std::shared_ptr<const InputBytes> bytes_;
  std::size_t first_row_;
  int first_line_;
  char delimiter_;
};

}  // namespace awmr
