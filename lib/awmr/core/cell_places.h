/// Finds the position of a table's cells that was not stored when it was read. Private to the
/// library.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "awmr/core/input_bytes.h"

namespace awmr {

/// Assumes that every line feed from the first row on ends a line and that every row is one line.
class CellPlaces {
 public:
  /// The first row begins at byte `first_row`, on line `first_line`.
  CellPlaces(std::shared_ptr<const InputBytes> bytes, std::size_t first_row, int first_line,
             char delimiter)
      : bytes_(std::move(bytes)),
        first_row_(first_row),
        first_line_(first_line),
        delimiter_(delimiter) {}

  /// Column of a cell (counted from 0) in its line, from 1. Reads the file again up to there.
  /// Returns 1 if the file has changed.
  int character(int line, std::size_t cell) const;

 private:
  std::shared_ptr<const InputBytes> bytes_;
  std::size_t first_row_;
  int first_line_;
  char delimiter_;
};

}  // namespace awmr
