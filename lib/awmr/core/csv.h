/// CSV input: header row, unit in the column name; comma, semicolon or tab (detected), `#` comment
/// lines, CRLF, a BOM and quoted fields. Columns are found by name, extra ones ignored.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/column_mapping.h"
#include "awmr/core/result.h"
#include "awmr/core/row_lines.h"

namespace awmr {

/// Meaning of an empty cell in a table whose columns have different sample times.
enum class EmptyCells {
  kFault,   ///< a fault: every row needs a value
  kHeld,    ///< a command: the previous value still holds
  kAbsent,  ///< a measurement: there was none in this row
  /// For tables with one row per run: this run has no value. Any number of rows can be empty; no
  /// value is carried over from the row before, and no row is dropped. If all are empty, the column
  /// is absent, even if it is required.
  kOptional,
};

struct CsvColumn {
  std::string name;
  bool required = true;
  EmptyCells empty = EmptyCells::kFault;
};

/// Note on how a file was interpreted. Always reported, never a fault.
struct CsvNote {
  int line = 0;  ///< 0: the file as a whole
  std::string code;
  std::string message;
};

/// The requested numeric columns, and the position of each cell.
class CsvTable {
 public:
  struct Column {
    std::vector<double> values;
    std::vector<int> character;      ///< column in the file, from 1, by row; empty: unknown
    std::vector<bool> present = {};  ///< by row: has its own value; empty: all have
  };
  struct Parts {
    std::string file;
    int header_line = 1;
    RowLines lines = {};
    std::map<std::string, Column, std::less<>> columns = {};
    std::vector<CsvNote> notes = {};
    std::vector<std::size_t> mapped = {};
    double clock_s = 0.0;
  };
  /// Precondition: every column has a value for every line.
  explicit CsvTable(Parts parts) : parts_(std::move(parts)) {}

  const std::string& file() const { return parts_.file; }
  std::size_t rows() const { return parts_.lines.size(); }
  bool has(std::string_view column) const;
  /// Values by row. Precondition: has(column).
  std::span<const double> column(std::string_view column) const;
  /// As column(), moved out of the table, which leaves the column empty. Precondition: has(column).
  std::vector<double> take(std::string_view column);
  /// By row: the value was in the file, not carried over from an earlier row. Empty: all were.
  /// Precondition: has(column).
  const std::vector<bool>& present(std::string_view column) const;
  /// Line in the file, from 1.
  int line(std::size_t row) const { return parts_.lines[row]; }
  /// `FILE:LINE:COLUMN` of a cell; `FILE:LINE:1` if the column is absent or its place unknown.
  std::string place(std::size_t row, std::string_view column) const;
  /// `FILE:LINE:1` of the header.
  std::string header_place() const;
  const std::vector<CsvNote>& notes() const { return parts_.notes; }
  /// Clock time subtracted so that t_s counts from the first row, s.
  double clock_s() const { return parts_.clock_s; }
  /// Mappings that gave a column: indices into those that the table was read with.
  const std::vector<std::size_t>& mapped() const { return parts_.mapped; }

 private:
  Parts parts_;
};

/// Reads the requested columns. If at least one kHeld or kAbsent column is empty in a quarter of
/// its rows or more, the file is sparse: it holds signals of different rates. Empty cells of
/// columns that permit them then have the meaning in EmptyCells, and rows without any value are
/// dropped.
/// Reports all faults of the file at once: missing required or duplicate columns, ragged rows,
/// cells that are empty, not numbers, NaN or infinite, an unterminated quote, no rows, a formula
/// whose value is infinite or NaN.
Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings = {});

/// CSV output: numbers in the shortest form that reads back to the same value.
std::string format_number(double value);

}  // namespace awmr
