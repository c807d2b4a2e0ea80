/// Line number in the file of each row of a table. To save memory, rows on consecutive lines are
/// stored as one entry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace awmr {

class RowLines {
 public:
  std::size_t size() const { return rows_; }
  bool empty() const { return rows_ == 0; }
  /// Line in the file, from 1. Precondition: row < size().
  int operator[](std::size_t row) const {
    const auto next = std::upper_bound(runs_.begin(), runs_.end(), row,
                                       [](std::size_t r, const Run& run) { return r < run.row; });
    const Run& run = *(next - 1);
    return run.line + static_cast<int>(row - run.row);
  }
  void push_back(int line) { append(line, 1); }
  /// Adds `rows` rows on consecutive lines.
  void append(int first_line, std::size_t rows) {
    if (rows == 0) return;
    const bool goes_on =
        !runs_.empty() &&
        first_line == runs_.back().line + static_cast<int>(rows_ - runs_.back().row);
    if (!goes_on) runs_.push_back({rows_, first_line});
    rows_ += rows;
  }

 private:
  /// Rows on consecutive lines.
  struct Run {
    std::size_t row;  ///< first row
    int line;         ///< its line
  };
  std::vector<Run> runs_ = {};
  std::size_t rows_ = 0;
};

}  // namespace awmr
