/// The rows of a piece of a CSV file, fast where they are ordinary. Private to the library.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/core/csv_columns.h"

namespace awmr {

/// What every row of the file looks like.
struct CsvShape {
  char delimiter = ',';
  std::size_t cells = 0;                     ///< of a row
  std::span<const CsvUsedColumn> used = {};  ///< those that are read
};

/// Rows of some lines that follow each other.
class CsvBlock {
 public:
  /// Bytes behind the lines that are looked at, whatever they are.
  static constexpr std::size_t kPadding = 8;

  /// Reads whole lines in place of what was read before; each ends with LF, and kPadding bytes behind
  /// them are readable. False where some line is not a row, a comment or blank by itself: a quoted
  /// cell goes on in the next line, a carriage return alone ends it, or a cell is wrong.
  bool read(std::string_view lines, const CsvShape& shape);

  std::size_t rows() const { return rows_; }
  std::size_t lines() const { return lines_; }
  /// By row, of one of the columns that are read.
  std::span<const double> values(std::size_t place) const {
    return {values_.get() + place * capacity_, rows_};
  }
  /// Some cell that may be empty is.
  bool has_empty() const { return has_empty_; }
  /// The lines, from 0, without a row.
  std::span<const std::size_t> without_row() const { return without_row_; }

 private:
  /// Where the values of a cell of each row go.
  struct Slot {
    const CsvUsedColumn* column = nullptr;  ///< null: it is not read
    double* values = nullptr;
  };

  void make_room(std::size_t bytes, const CsvShape& shape);
  const char* read_row(const char* text, char delimiter);
  const char* read_cell(const char* text, char delimiter, const Slot& slot);
  bool read_odd_line(std::string_view line, char delimiter);
  bool put(std::string_view text, const Slot& slot);

  std::unique_ptr<double[]> values_ = {};  ///< one column after the other, `capacity_` of each
  std::size_t size_ = 0;                   ///< of `values_`
  std::size_t capacity_ = 0;
  std::vector<Slot> slots_ = {};  ///< as in the header
  bool has_empty_ = false;
  std::size_t rows_ = 0;
  std::size_t lines_ = 0;
  std::vector<std::size_t> without_row_ = {};
};

}  // namespace awmr
