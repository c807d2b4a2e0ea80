/// Rows of one block of a CSV file, with a fast path for ordinary rows. Private to the library.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/core/csv_columns.h"

namespace awmr {

/// Format common to all rows of the file.
struct CsvShape {
  char delimiter = ',';
  std::size_t cells = 0;                     ///< per row
  std::span<const CsvUsedColumn> used = {};  ///< columns that are read
};

/// Rows of consecutive lines.
class CsvBlock {
 public:
  /// Readable bytes required behind the lines; their values do not matter.
  static constexpr std::size_t kPadding = 8;

  /// Reads whole lines and replaces those read before. Each line ends with LF, and kPadding bytes
  /// behind them are readable. False if a line is not by itself a row, a comment or blank: a quoted
  /// cell continues in the next line, a carriage return alone ends it, or a cell is invalid.
  bool read(std::string_view lines, const CsvShape& shape);

  std::size_t rows() const { return rows_; }
  std::size_t lines() const { return lines_; }
  /// By row, for one of the columns that are read.
  std::span<const double> values(std::size_t place) const {
    return {values_.get() + place * capacity_, rows_};
  }
  /// True if a permitted cell is empty.
  bool has_empty() const { return has_empty_; }
  /// Indices, from 0, of the lines without a row.
  std::span<const std::size_t> without_row() const { return without_row_; }

 private:
  /// Destination for the values of one cell of each row.
  struct Slot {
    const CsvUsedColumn* column = nullptr;  ///< null: it is not read
    double* values = nullptr;
  };

  void make_room(std::size_t bytes, const CsvShape& shape);
  const char* read_row(const char* text, char delimiter);
  const char* read_cell(const char* text, char delimiter, const Slot& slot);
  bool read_odd_line(std::string_view line, char delimiter);
  bool put(std::string_view text, const Slot& slot);

  std::unique_ptr<double[]> values_ = {};  ///< one column after the other, each `capacity_` long
  std::size_t size_ = 0;                   ///< of `values_`
  std::size_t capacity_ = 0;
  std::vector<Slot> slots_ = {};  ///< as in the header
  bool has_empty_ = false;
  std::size_t rows_ = 0;
  std::size_t lines_ = 0;
  std::vector<std::size_t> without_row_ = {};
};

}  // namespace awmr
